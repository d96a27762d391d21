#!/usr/bin/env bash
# tests/campaigns/determinism.sh [EPISODES [VLAPROBE]]: the first EPISODES (6) starts of two tasks, run again with other numbers of
# worlds, another order, language, time zone, size of the environment, layout of the address space, allocator, stack, functions of the C
# library and BLAS: traces, pictures and verdicts must be those of the first run. What another processor, compiler or library may
# change instead, Embree's choice of instructions among it, is held by a refusal: a run whose record names another one is not continued.
# BLAS and allocators of others are borrowed from Debian's packages, installed nowhere; rows without network say that they are skipped.
# Exit 0: all equal, all refused.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
episodes=${1:-6} vlaprobe=$(realpath "$(command -v "${2:-$here/build/vlaprobe}")")  # it is called from other folders
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
    --jobs "$worlds" "${more[@]}" -o "$out" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 2; }
}
more=()
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
  compare
}
compare() {
  rows "$out"
  if cmp -s "$work/first.rows" "$out.rows"; then same=$((same + 1)); else
    other=$((other + 1))
    echo "DIFFERS: $name"
    diff "$work/first.rows" "$out.rows" | head -n 6
  fi
}
# The second half of the episodes before the first.
in_another_order() {
  local name="another order" out=$work/$((same + other)) half part
  for half in 2 1; do
    more=(--shard "$half/2")
    run "$out-half$half" 1 env
  done
  more=()
  for part in a b; do  # one episode alone leaves a half without any
    "$vlaprobe" merge "$out"-half[12]-$part -o "$out-$part" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 2; }
  done
  compare
}
# borrow PACKAGE FILE: where the file of a Debian package is that is not installed; fails where it cannot be had.
borrow() {
  local folder=$work/borrowed/$1
  if [ ! -d "$folder" ]; then
    mkdir -p "$folder"
    (cd "$folder" && apt-get -qq download "$1" && dpkg-deb -x ./*.deb .) >"$work/log" 2>&1 || return 1
  fi
  find "$folder" -name "$2" | grep .
}
skipped() { echo "skipped: $1: the package cannot be had here"; }
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
as "functions of the C library for processors with AVX2 alone" 1 env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX512BW
as "functions of the C library for processors with SSE4.2 alone" 1 env GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-AVX,-FMA,-ERMS
as "a small stack" 2 bash -c 'ulimit -s 1024; exec "$@"' -
as "the last core alone" 2 taskset -c "$(($(nproc --all) - 1))"
in_another_order
if library=$(borrow libjemalloc2 libjemalloc.so.2); then as "another allocator, jemalloc" 2 env LD_PRELOAD="$library"; else skipped jemalloc; fi
if library=$(borrow libtcmalloc-minimal4 libtcmalloc_minimal.so.4); then as "another allocator, tcmalloc" 2 env LD_PRELOAD="$library"; else skipped tcmalloc; fi
if library=$(borrow libopenblas0-pthread libblas.so.3); then
  for kind in NEHALEM HASWELL SKYLAKEX; do
    as "another BLAS, OpenBLAS for $kind" 1 env LD_LIBRARY_PATH="$(dirname "$library")" OPENBLAS_CORETYPE=$kind
  done
else skipped OpenBLAS; fi
cd / && as "another folder" 1 env
echo "$same of $((same + other)) runs have the first one's traces, pictures and verdicts"

# What is another where it says so in the record: the run is not continued, and the sentence names it.
refused=0 asked=0
for entry in cpu compiler program embree blas lapack libm assimp; do
  asked=$((asked + 1))
  rm -rf "$work/changed-a"
  cp -r "$work/first-a" "$work/changed-a"
  /usr/bin/python3 - "$work/changed-a/results.sqlite" "$entry" <<'PYTHON'
import json, sqlite3, sys
store = sqlite3.connect(sys.argv[1])
record = json.loads(store.execute("select value from run where name = 'record'").fetchone()[0])
fingerprint = json.loads(record["fingerprint"])
if sys.argv[2] not in fingerprint:
    sys.exit("the record has no " + sys.argv[2])
fingerprint[sys.argv[2]] = "another"
record["fingerprint"] = json.dumps(fingerprint, separators=(",", ":"), sort_keys=True)
store.execute("update run set value = ? where name = 'record'", (json.dumps(record, separators=(",", ":")),))
store.commit()
PYTHON
  if "$vlaprobe" run "$work/intact.plan" --suite intact --tasks carrot_on_plate --episodes "0-$episodes" --policy noisy:0.01 --seeds 1 \
    -o "$work/changed-a" >"$work/log" 2>&1 || ! grep -q "was begun by another build or machine.*$entry: recorded another" "$work/log"; then
    echo "CONTINUED: a run of another $entry"
    tail -n 3 "$work/log"
  else refused=$((refused + 1)); fi
done
echo "$refused of $asked runs of another processor, compiler or library are refused"
[ "$other" = 0 ] && [ "$refused" = "$asked" ]
