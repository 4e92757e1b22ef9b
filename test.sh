#!/usr/bin/env bash
# Builds and runs the tests: all of them optimised, then the parts that threads, sockets, files and
# hostile input touch under the sanitizers, which is all but tests/transport. The long statistical
# forms: ctest --preset release -L long
# At the end a short run of the fuzzers; the long one: tests/fuzz/run.sh 600
# Fails if any part fails, after running every part. PARTS="release asan tsan fuzz" chooses.
set -euo pipefail
cd "$(dirname "$0")"

parts=${PARTS:-release asan tsan fuzz}

began=$SECONDS
bash .ci/install_packages.sh .ci/build_packages.txt .ci/web_packages.txt
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

sanitized="renderer_tests server_tests soak"
for name in $parts; do
  case $name in
    asan) part asan "$sanitized api_tests" -LE 'long|transport' -E _NOT_BUILT ;;
    # Parsing has no threads.
    tsan) part tsan "$sanitized" -LE 'long|transport|api' -E _NOT_BUILT ;;
    fuzz) fuzz ;;
    *) part "$name" all -LE long ;;
  esac
done

echo
echo "took: $times; in all $((SECONDS - began)) s"
echo "$summaries"
exit "$failed"
