#!/usr/bin/env bash
# Builds and runs the tests: all of them optimised, then the parts that threads, sockets, files and
# hostile input touch under the sanitizers. The long statistical forms: ctest --preset release -L long
# Fails if any part fails, after running every part. PARTS="release asan tsan" chooses.
set -euo pipefail
cd "$(dirname "$0")"

# Which tests run under which sanitizer: a regular expression of ctest names. The renderer's
# statistical suites are the same code, 5 to 20 times slower: they stay with the release part.
asan_tests=${ASAN_TESTS:-'^(Spectrum|ImageIo|Color|MaterialCube|Mesh|Film)|[Pp]arse|Corpus|Server|Store|Service|Http|Cli'}
tsan_tests=${TSAN_TESTS:-'Thread|Server|Store|Service|Worker|Http'}
parts=${PARTS:-release asan tsan}

began=$SECONDS
bash .ci/install_packages.sh
export CMAKE_CXX_COMPILER_LAUNCHER=ccache
times="packages $((SECONDS - began)) s"
summaries=""
failed=0
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT

part() { # name, further arguments of ctest
  local name=$1 start=$SECONDS built
  shift
  echo "== $name: build"
  if ! cmake --preset "$name" >"$logs/configure" 2>&1; then
    cat "$logs/configure"
    failed=1 summaries="== $name: configuring failed"$'\n'$summaries
    return
  fi
  if ! cmake --build --preset "$name"; then
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

for name in $parts; do
  case $name in
    asan) ASAN_OPTIONS=detect_leaks=1 part asan -LE long -R "$asan_tests" ;;
    tsan) TSAN_OPTIONS=halt_on_error=1 part tsan -LE long -R "$tsan_tests" ;;
    *) part "$name" -LE long ;;
  esac
done

echo
echo "took: $times; in all $((SECONDS - began)) s"
echo "$summaries"
exit "$failed"
