#!/usr/bin/env bash
# Installs what is missing, builds, runs every test, saying how far it is. The last line is "N passed, N failed".
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/.ci/progress.sh"
"$root/.ci/install"
"$root/.ci/build"

passed=0 failed=0 ran=0 programs=0
progress_said=$SECONDS
# Of with_progress: the programs that are done, of all.
progress_programs() { echo "$ran $programs ${passed:+$passed cases passed, $failed failed}"; }
# run_program PROGRAM NAME: in its own folder; its log beside it is shown if anything failed.
run_program() {
  local program=$1 name=$2 folder status=0
  folder=$(dirname "$program")
  with_progress "testing, $name" progress_programs "$folder/$(basename "$program").log" env -C "$folder" "$program" || status=$?
  count_program "$program" "$name" "$status"
}
# count_program PROGRAM NAME STATUS: of one that ran, by its log.
count_program() {
  local program=$1 name=$2 status=$3 log=$1.log summary p f
  ran=$((ran + 1)) progress_said=$SECONDS
  # doctest's summary: "[doctest] test cases: 7 | 7 passed | 0 failed | 0 skipped"
  summary=$(grep -a 'test cases:' "$log" | tail -n 1 | sed 's/\x1b\[[0-9;]*m//g' || true)
  p=$(sed -n 's/.* \([0-9]*\) passed.*/\1/p' <<<"$summary")
  f=$(sed -n 's/.* \([0-9]*\) failed.*/\1/p' <<<"$summary")
  if [ -z "$p" ] || [ -z "$f" ] || { [ "$status" != 0 ] && [ "$f" -eq 0 ]; }; then
    p=${p:-0} f=$(( ${f:-0} + 1 ))
    echo "$name ended with status $status and without a clean summary" >>"$log"
  fi
  passed=$((passed + p)) failed=$((failed + f))
  printf '%-28s %4d passed %4d failed\n' "$name" "$p" "$f"
  grep -a 'SKIPPED' "$log" | sed 's/^/    /' | sort -u || true
  if [ "$f" -ne 0 ]; then cat "$log"; fi
}
programs=$(find "$root/build/tests" -maxdepth 1 -name 'test_*' -type f -executable | wc -l)
# Those that drive a browser or time-outs of servers are alone with the machine, the others share it, as many as it has cores.
alone=" test_runtime_lsp test_runtime_report test_runtime_servers test_runtime_servers_protocols test_runtime_studio "
together=()
for program in "$root"/build/tests/test_*; do
  [ -x "$program" ] && [ -f "$program" ] || continue
  [[ "$alone" == *" $(basename "$program") "* ]] || together+=("$program")
done
rm -f "$root"/build/tests/test_*.status
progress_together() { echo "$(find "$root/build/tests" -maxdepth 1 -name 'test_*.status' | wc -l) ${#together[@]}"; }
# shellcheck disable=SC2016
with_progress "testing, programs" progress_together "$root/build/tests/together.log" \
  xargs -0 -n 1 -P "$(nproc)" bash -c 'cd "$(dirname "$1")" && status=0; "$1" >"$1.log" 2>&1 || status=$?; echo $status >"$1.status"' run \
  < <(printf '%s\0' "${together[@]}") || true
for program in "${together[@]}"; do
  count_program "$program" "$(basename "$program")" "$(cat "$program.status" 2>/dev/null || echo none)"
done
for name in $alone; do
  [ -x "$root/build/tests/$name" ] && run_program "$root/build/tests/$name" "$name"
done

# The physics once more with the optimised Simbody, where it was built before; VLAPROBE_SIMBODY=source builds it now.
if [ "${VLAPROBE_SIMBODY:-}" = source ] || "$root/.ci/simbody_source" --where >/dev/null 2>&1; then
  fast=$root/build/simbody-source
  log=$root/build/simbody-source.log
  if with_progress "configuring with the fast Simbody, which may be built first" progress_unknown "$log" \
      cmake -S "$root" -B "$fast" -G Ninja -DVLAPROBE_SIMBODY=source &&
    with_progress "building with the fast Simbody" progress_ninja "$log" \
      cmake --build "$fast" --target test_runtime_world; then
    run_program "$fast/tests/test_runtime_world" "test_runtime_world, fast"
  else
    cat "$log"; failed=$((failed + 1))
  fi
fi

# Fuzzing: a minute each over parser and checker, plan reader and judge, trace reader. VLAPROBE_FUZZ_SECONDS=0 skips.
seconds=${VLAPROBE_FUZZ_SECONDS:-60}
if [ "$seconds" -gt 0 ]; then
  log=$root/build/fuzz.log
  with_progress "fuzzing, $seconds s a target after building them" progress_unknown "$log" \
    "$root/tests/fuzz/run.sh" "$seconds" || true
  fuzz=$(cat "$log")
  echo "$fuzz"
  t=$(sed -n 's/^\([0-9]*\) targets, [0-9]* failed$/\1/p' <<<"$fuzz")
  f=$(sed -n 's/^[0-9]* targets, \([0-9]*\) failed$/\1/p' <<<"$fuzz")
  passed=$((passed + ${t:-0} - ${f:-0})) failed=$((failed + ${f:-1}))
fi

# The folder that runs elsewhere: made, installed, held against the build.
log=$root/build/bundle.log
with_progress "testing, the bundle" progress_unknown "$log" "$root/tests/bundle.sh" || true
p=$(sed -n 's/^\([0-9]*\) passed, [0-9]* failed$/\1/p' "$log")
f=$(sed -n 's/^[0-9]* passed, \([0-9]*\) failed$/\1/p' "$log")
[ -n "$p" ] && [ -n "$f" ] || f=1
passed=$((passed + ${p:-0})) failed=$((failed + f))
printf '%-28s %4d passed %4d failed\n' bundle "${p:-0}" "$f"
if [ "$f" -ne 0 ]; then cat "$log"; fi

[ $((passed + failed)) -gt 0 ] || { echo "no test ran" >&2; failed=1; }
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
