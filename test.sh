#!/usr/bin/env bash
# Builds and runs the tests: all of them optimised, then the parts that threads, sockets, files and
# hostile input touch under the sanitizers. The long statistical forms: ctest --preset release -L long
# At the end a short run of the fuzzers; the long one: tests/fuzz/run.sh 600
# Fails if any part fails, after running every part. PARTS="release asan tsan fuzz" chooses.
set -euo pipefail
cd "$(dirname "$0")"

# Left out under the sanitizers: the statistical suites of the light transport. They take 5 to 20
# times longer there, through the same code as the few short renders that stay in.
statistical=${STATISTICAL:-'^(WhiteFurnace|MeanPathLength|Slab|Ball|CameraInside|Variance|RelativeError|Sampling|Limit|FurnaceGrid|Furnace/HardCases?|HardCases?|Pigment|Microsurface|LargeSteps|MeshDistance|Walk|Dipole[A-Za-z]*|ExplorableFilm|LanesOfSeveralAbsorptions|Haze|Clear(Plate|Slab)|ScatteringSlab|StandardErrors|Speed|Jumps|InfinitelyDenseBody|Connections|RoughConnections|MicrosurfaceBatch|Energy|Developed|DenseWhiteSlab|BlackBody|Bits|Colour|SingleScattering|PigmentSlab|Adding|Efficiency|Backdrop|WidePlate|OilFilm|Box)\.'}
parts=${PARTS:-release asan tsan fuzz}

began=$SECONDS
bash .ci/install_packages.sh
export CMAKE_CXX_COMPILER_LAUNCHER=ccache
# What one clone has compiled serves the others.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1
times="packages $((SECONDS - began)) s"
summaries=""
failed=0
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

part() { # name, the targets to build, then further arguments of ctest
  local name=$1 targets=$2 start=$SECONDS built
  shift 2
  echo "== $name: build"
  if ! cmake --preset "$name" >"$logs/configure" 2>&1; then
    cat "$logs/configure"
    failed=1 summaries="== $name: configuring failed"$'\n'$summaries
    return
  fi
  # shellcheck disable=SC2086
  if ! cmake --build --preset "$name" --target $targets; then
    failed=1 summaries="== $name: the build failed"$'\n'$summaries
    return
  fi
  built=$SECONDS
  echo "== $name: tests"
  # Without --no-tests=error a subset that matches nothing would pass.
  ctest --preset "$name" -j2 --no-tests=error "$@" </dev/null 2>&1 | tee "$logs/$name" || failed=1
  times+=", $name build $((built - start)) s, $name tests $((SECONDS - built)) s"
  # Told again at the end, the first part's last.
  summaries="== $name"$'\n'$(sed -n '/tests passed,\|No tests were found/,$p' "$logs/$name")$'\n'$summaries
}

fuzz() {
  local start=$SECONDS
  echo "== fuzz"
  bash .ci/install_packages.sh .ci/fuzz_packages.txt
  tests/fuzz/run.sh 15 2>&1 | tee "$logs/fuzz" || failed=1
  times+=", fuzz $((SECONDS - start)) s"
  summaries="== fuzz"$'\n'$(grep '^Done\|SUMMARY' "$logs/fuzz" || echo failed)$'\n'$summaries
}

tests="renderer_tests api_tests server_tests soak"
for name in $parts; do
  case $name in
    asan) part asan "$tests" -LE long -E "$statistical" ;;
    # Parsing has no threads: its label stays with the other parts.
    tsan) part tsan "$tests" -LE 'long|^api$' -E "$statistical" ;;
    fuzz) fuzz ;;
    *) part "$name" all -LE long ;;
  esac
done

echo
echo "took: $times; in all $((SECONDS - began)) s"
echo "$summaries"
exit "$failed"
