#!/usr/bin/env bash
# tests/fuzz/run.sh SECONDS: builds every fuzz target with clang into build/fuzz and runs each for so many seconds.
# Seeds of source_fuzz are the suite, the examples, the library and the golden texts; those of another target lie in
# tests/fuzz/TARGET/. What crashes is kept in build/fuzz/findings. The last line is "N targets, N failed".
set -euo pipefail
seconds=${1:-60}
root=$(cd "$(dirname "$0")/../.." && pwd)
build=${VLAPROBE_FUZZ_BUILD:-$root/build/fuzz}
mkdir -p "$build/findings"
if [ ! -f "$build/build.ninja" ]; then
  cmake -S "$root" -B "$build" -G Ninja -DVLAPROBE_FUZZ=ON -DVLAPROBE_TESTS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ >"$build/configure.log" 2>&1 ||
    { cat "$build/configure.log" >&2; exit 2; }
fi
cmake --build "$build" --target fuzz >"$build/build.log" 2>&1 ||
  { grep -v '^\[' "$build/build.log" >&2; echo "the fuzz targets do not build: $build/build.log" >&2; exit 2; }

targets=0 failed=0
for source in "$root"/tests/fuzz/*_fuzz.cpp; do
  name=$(basename "$source" .cpp)
  program="$build/tests/$name"
  corpus="$build/corpus/$name"
  mkdir -p "$corpus"
  case $name in
    source_fuzz)
      # Two folders may have a file of the same name.
      for seed in "$root"/{suite,examples,dsl/std,tests/golden}/*.probe; do
        cp "$seed" "$corpus/$(basename "$(dirname "$seed")")_$(basename "$seed")"
      done ;;
    *) if [ -d "$root/tests/fuzz/$name" ]; then cp "$root/tests/fuzz/$name"/* "$corpus"; fi ;;
  esac
  targets=$((targets + 1))
  log="$build/$name.log"
  if "$program" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=40000 \
    -artifact_prefix="$build/findings/$name-" "$corpus" >"$log" 2>&1; then
    printf '%-16s ok      %s\n' "$name" "$(grep -a 'Done ' "$log" | tail -n 1)"
  else
    failed=$((failed + 1))
    printf '%-16s FAILED  %s\n' "$name" "$log"
    tail -n 40 "$log"
  fi
done
echo "$targets targets, $failed failed"
[ "$failed" -eq 0 ]
