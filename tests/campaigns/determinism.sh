#!/usr/bin/env bash
# tests/campaigns/determinism.sh [EPISODES [VLAPROBE]]: the first EPISODES (6) starts of two tasks, run again with other numbers of
# worlds, another order, language, time zone, size of the environment, layout of the address space, allocator's fill and stack: traces,
# pictures and verdicts must be those of the first run. What the processor itself offers is not changed here: that another kind of it
# continues no run unasked, `run` sees to (runtime/store/fingerprint.h). Exit 0: all equal.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
episodes=${1:-6} vlaprobe=${2:-$here/build/vlaprobe}
work=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-determinism-XXXXXX")
trap 'rm -rf "$work"' EXIT
export VLAPROBE_CACHE=$work/cache
# Two robots, two laws of control, pixels and vertices lit, the expert and one that draws.
"$vlaprobe" build "$here/suite/intact.probe" -o "$work/intact.plan" >/dev/null 2>&1
"$vlaprobe" build "$here/suite/kitchen.probe" -o "$work/kitchen.plan" >/dev/null 2>&1
evaluate() { # FOLDER WORLDS PLAN TASK POLICY COMMAND...
  local out=$1 worlds=$2 plan=$3 task=$4 policy=$5
  shift 5
  "$@" "$vlaprobe" run "$work/$plan.plan" --suite "$plan" --tasks "$task" --episodes "0-$((episodes - 1))" --policy "$policy" --seeds 1 \
    --jobs "$worlds" -o "$out" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 2; }
}
run() { # FOLDER WORLDS COMMAND...
  local out=$1 worlds=$2
  shift 2
  evaluate "$out-a" "$worlds" intact carrot_on_plate noisy:0.01 "$@"
  evaluate "$out-b" "$worlds" kitchen carrot_in_the_drawer expert "$@"
}
rows() { # FOLDER
  for part in a b; do
    "$vlaprobe" results "$1-$part" --json | grep -v '"trace":' >>"$1.rows"
  done
}
run "$work/first" 1 env
rows "$work/first"
[ "$(grep -c trace_sha256 "$work/first.rows")" -ge $((2 * episodes)) ] || { echo "the first run has no traces" >&2; exit 2; }
same=0 other=0
# as NAME WORLDS COMMAND...
as() {
  local name=$1 out=$work/$((same + other))
  shift
  run "$out" "$@"
  rows "$out"
  if cmp -s "$work/first.rows" "$out.rows"; then same=$((same + 1)); else
    other=$((other + 1))
    echo "DIFFERS: $name"
    diff "$work/first.rows" "$out.rows" | head -n 6
  fi
}
many=$(printf 'x%.0s' {1..60000})
as "again" 1 env
as "three worlds at once" 3 env
as "another language" 1 env LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 LC_NUMERIC=de_DE.UTF-8
as "another time zone" 1 env TZ=Pacific/Kiritimati
as "a large environment" 1 env MANY="$many"
as "an empty environment" 1 env -i VLAPROBE_CACHE="$VLAPROBE_CACHE" PATH="$PATH"
as "no randomised addresses" 2 setarch -R
as "memory that is filled, and arenas for each thread" 3 env MALLOC_PERTURB_=165 MALLOC_ARENA_MAX=1
as "memory from the system at once" 2 env MALLOC_MMAP_THRESHOLD_=1024 MALLOC_TOP_PAD_=0
as "functions of the C library for older processors" 1 env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-FMA,-ERMS
as "a small stack" 2 bash -c 'ulimit -s 1024; exec "$@"' -
as "the last core alone" 2 taskset -c "$(($(nproc --all) - 1))"
cd / && as "another folder" 1 env
echo "$same of $((same + other)) runs have the first one's traces, pictures and verdicts"
[ "$other" = 0 ]
