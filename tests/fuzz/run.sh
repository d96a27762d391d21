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
  cmake -S "$root" -B "$build" -G Ninja -DVLAPROBE_FUZZ=ON -DVLAPROBE_TESTS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -gline-tables-only" \
    -DCMAKE_C_COMPILER=clang -DCMAKE_CXX_COMPILER=clang++ >"$build/configure.log" 2>&1 ||
    { cat "$build/configure.log" >&2; exit 2; }
fi
cmake --build "$build" --target fuzz >"$build/build.log" 2>&1 ||
  { grep -v '^\[' "$build/build.log" >&2; echo "the fuzz targets do not build: $build/build.log" >&2; exit 2; }

fuzz_one() {
  local name=$1
  local program="$build/tests/$name" corpus="$build/corpus/$name" log="$build/$name.log"
  mkdir -p "$corpus"
  case $name in
    source_fuzz)
      # Two folders may have a file of the same name.
      for seed in "$root"/{suite,examples,dsl/std,tests/golden}/*.probe; do
        cp "$seed" "$corpus/$(basename "$(dirname "$seed")")_$(basename "$seed")"
      done ;;
    *) if [ -d "$root/tests/fuzz/$name" ]; then cp "$root/tests/fuzz/$name"/* "$corpus"; fi ;;
  esac
  if "$program" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=2048 -max_len=40000 \
    -artifact_prefix="$build/findings/$name-" "$corpus" >"$log" 2>&1; then
    printf '%-16s ok      %s\n' "$name" "$(grep -a 'Done ' "$log" | tail -n 1)"
  else
    printf '%-16s FAILED  %s\n' "$name" "$log"
    tail -n 40 "$log"
    return 1
  fi
}
export -f fuzz_one
export build root seconds

# As many at once as there are cores; what one says is told whole, behind the others.
targets=0 failed=0
said=$(mktemp -d)
trap 'rm -rf "$said"' EXIT
names=()
for source in "$root"/tests/fuzz/*_fuzz.cpp; do names+=("$(basename "$source" .cpp)"); done
# shellcheck disable=SC2016
printf '%s\n' "${names[@]}" | xargs -n 1 -P "$(nproc)" bash -c \
  'fuzz_one "$1" >"$0/$1" 2>&1 && touch "$0/$1.ok"; true' "$said"
for name in "${names[@]}"; do
  targets=$((targets + 1))
  cat "$said/$name"
  [ -e "$said/$name.ok" ] || failed=$((failed + 1))
done
echo "$targets targets, $failed failed"
[ "$failed" -eq 0 ]
