#!/usr/bin/env bash
# Builds the fuzzers and runs each for so many seconds: tests/fuzz/run.sh 600 is the long form. What
# is found stays in build/fuzz/findings, the grown corpus in build/fuzz/corpus.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-600}

mkdir -p build
cmake --preset fuzz >build/fuzz-configure.log 2>&1 || { cat build/fuzz-configure.log; exit 1; }
cmake --build --preset fuzz
corpus=build/fuzz/corpus findings=build/fuzz/findings
mkdir -p "$findings"
python3 tests/fuzz/make_corpus.py build/fuzz/seeds
failed=0
for name in render_request sweep_request headers messages mesh light answer; do
  mkdir -p "$corpus/$name"
  echo "== fuzz: $name, $seconds s"
  options=
  [ $name != light ] || options=detect_leaks=0 # OpenImageIO leaks the text of an error
  ASAN_OPTIONS=$options build/fuzz/bin/fuzz_$name "$corpus/$name" "build/fuzz/seeds/$name" \
    -max_total_time="$seconds" -max_len=8192 -timeout=10 -rss_limit_mb=4096 \
    -dict=tests/fuzz/words.dict -artifact_prefix="$findings/$name-" -print_final_stats=1 \
    >"build/fuzz/$name.log" 2>&1 || { failed=1; tail -n 60 "build/fuzz/$name.log"; }
  grep -E "^(Done|stat::number_of_executed_units)" "build/fuzz/$name.log" || true
done
exit "$failed"
