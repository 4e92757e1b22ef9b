#!/usr/bin/env bash
# Builds and runs the tests: all of them optimised, with the benchmarks built too; then what hostile
# input, files and sockets touch under AddressSanitizer and what has threads under ThreadSanitizer
# (tests/CMakeLists.txt says what that is). The long statistical forms: ctest --preset release -L long
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

part() { # name, then the targets to build
  local name=$1 start=$SECONDS built at_once=2
  shift
  # Sanitized programs wait more than they compute, and nothing of theirs is timed.
  [ "$name" = release ] || at_once=4
  echo "== $name: build"
  if ! cmake --preset "$name" >"$logs/configure" 2>&1; then
    cat "$logs/configure"
    failed=1 summaries="== $name: configuring failed"$'\n'$summaries
    return
  fi
  if ! cmake --build --preset "$name" --target "$@"; then
    failed=1 summaries="== $name: the build failed"$'\n'$summaries
    return
  fi
  built=$SECONDS
  echo "== $name: tests"
  # Without --no-tests=error a subset that matches nothing would pass.
  ctest --preset "$name" -j$at_once --no-tests=error -LE long </dev/null 2>&1 | tee "$logs/$name" || failed=1
  times+=", $name build $((built - start)) s, $name tests $((SECONDS - built)) s"
  # Told again at the end, the first part's last.
  summaries="== $name"$'\n'$(sed -n '/tests passed,\|No tests were found/,$p' "$logs/$name")$'\n'$summaries
}

fuzz() {
  local start=$SECONDS
  echo "== fuzz"
  bash .ci/install_packages.sh .ci/fuzz_packages.txt
  tests/fuzz/run.sh 4 2>&1 | tee "$logs/fuzz" || failed=1
  times+=", fuzz $((SECONDS - start)) s"
  summaries="== fuzz"$'\n'$(grep '^Done\|SUMMARY' "$logs/fuzz" || echo failed)$'\n'$summaries
}

for name in $parts; do
  case $name in
    release) part release all bench ;;
    fuzz) fuzz ;;
    *) part "$name" all ;;
  esac
done

echo
echo "took: $times; in all $((SECONDS - began)) s"
echo "$summaries"
exit "$failed"
