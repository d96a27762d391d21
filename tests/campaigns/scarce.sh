#!/usr/bin/env bash
# tests/campaigns/scarce.sh [ROUNDS [VLAPROBE]]: ROUNDS (20) times each, a run where something is scarce at random: file handles,
# memory, the largest file, room on the disk, names on the disk, a disk that is read-only, a clock that jumps, a second
# writer in the folder; verbs that read a run with few handles and little memory; and in each round two of the other verbs that write
# (verbs.sh). What happens may be refused, by a sentence, but not by a signal and not after more than a minute; and the same command
# without the scarcity has to come to the rows or bytes of one that lacked nothing. What needs root or faketime is skipped where that is not there, saying so. Exit 0: nothing found.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
rounds=${1:-20} vlaprobe=$(realpath "$(command -v "${2:-$here/build/vlaprobe}")")  # it is called from other folders
work=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-scarce-XXXXXX")
mounted=$work/disk
stop() {
  mountpoint -q "$mounted" && umount -l "$mounted"
  rm -rf "$work"
}
trap stop EXIT
RANDOM=24
export VLAPROBE_CACHE=$work/cache
"$vlaprobe" build "$here/suite/intact.probe" -o "$work/suite.plan" >/dev/null 2>&1
asked=("$work/suite.plan" --suite intact --tasks carrot_on_plate --episodes 0-2 --policy noisy:0.01 --seeds 1 --jobs 2)
rows() { "$vlaprobe" results "$1" --json | grep -v '"trace":'; } # FOLDER
"$vlaprobe" run "${asked[@]}" -o "$work/calm" >"$work/log" 2>&1 || { cat "$work/log"; exit 2; }
rows "$work/calm" >"$work/calm.rows"
"$vlaprobe" run "${asked[@]}" --shard 1/2 -o "$work/half-1" >>"$work/log" 2>&1
"$vlaprobe" run "${asked[@]}" --shard 2/2 -o "$work/half-2" >>"$work/log" 2>&1

. "$here/tests/campaigns/verbs.sh"
writers=(merge sweep ask table dataset)
mkdir "$work/verbs"
cd "$work/verbs"
verbs_begin
for verb in "${writers[@]}"; do
  (start "$verb" "calm.$verb") >log 2>&1 || { cat log; exit 2; }
  content "$verb" "calm.$verb" >"$verb.content"
done

calls=0 refused=0 found=0
finding() { # WHAT
  found=$((found + 1))
  echo "FOUND: $1"
  tail -n 4 "$work/said"
}
# suffers NAME COMMAND...: it may be refused by a sentence.
suffers() {
  local name=$1 status=0
  shift
  timeout -k 5 60 "$@" >"$work/said" 2>&1 || status=$?
  calls=$((calls + 1))
  [ "$status" = 0 ] && return
  refused=$((refused + 1))
  # The loader's own sentence, before there is a program.
  [ "$status" = 127 ] && grep -q 'error while loading shared libraries' "$work/said" && return
  if [ "$status" -ge 124 ]; then finding "$name ended with status $status"; return; fi
  # A record or the disk may be what is full, the terminal is not.
  grep -q '^vlaprobe: \|^note: \|invalid' "$work/said" || finding "$name ended with status $status and no sentence"
}
# recovers NAME FOLDER: without the scarcity.
recovers() {
  local name=$1 folder=$2
  if ! "$vlaprobe" run "${asked[@]}" -o "$folder" >"$work/said" 2>&1; then finding "$name: the same command does not go on"; return; fi
  rows "$folder" >"$work/rows"
  cmp -s "$work/calm.rows" "$work/rows" || { diff "$work/calm.rows" "$work/rows" >"$work/said" || true; finding "$name: other rows than without it"; }
  [ -z "$(find "$folder" -name '*.tmp')" ] || finding "$name: unfinished files stay"
}
# between NAME LOW HIGH: draws it. What is drawn within $(...) is none of the seed's draws.
between() { printf -v "$1" %d $(($2 + RANDOM % ($3 - $2))); }
limited() { # NAME FLAG VALUE: a run under one limit of the shell's
  rm -rf "$work/limited"
  suffers "$1 $3" bash -c "ulimit -$2 $3; exec \"\$@\"" - "$vlaprobe" run "${asked[@]}" -o "$work/limited"
  recovers "$1 $3" "$work/limited"
}
reading() { # NAME FLAG VALUE: verbs that read
  local under=(bash -c "ulimit -$2 $3; exec \"\$@\"" -)
  suffers "results, $1 $3" "${under[@]}" "$vlaprobe" results "$work/calm" --json
  suffers "report, $1 $3" "${under[@]}" "$vlaprobe" report "$work/calm" -o "$work/page.html"
  rm -rf "$work/merged"
  suffers "merge, $1 $3" "${under[@]}" "$vlaprobe" merge "$work/half-1" "$work/half-2" -o "$work/merged"
  recovers "merge, $1 $3" "$work/merged"
  suffers "judge, $1 $3" "${under[@]}" "$vlaprobe" judge "$work/calm"
}
# ends_well NAME VERB OUTPUT: without the scarcity. A dataset's folder that is there is not written into.
ends_well() {
  local name=$1 verb=$2 out=$3
  if ! { [ "$verb" = dataset ] && [ -e "$out" ]; } && ! (start "$verb" "$out") >"$work/said" 2>&1; then
    finding "$name: the same command does not go on"
    return
  fi
  content "$verb" "$out" >"$work/content" 2>"$work/said" || { finding "$name: its output is not read"; return; }
  cmp -s "$verb.content" "$work/content" || { diff "$verb.content" "$work/content" >"$work/said" || true; finding "$name: another output than without it"; }
}
export -f start  # `timeout` starts programs alone
export vlaprobe here
writing() { # VERB NAME FLAG VALUE: under one limit of the shell's
  rm -rf limited limited.h5* limited.partial
  suffers "$1, $2 $4" bash -c "$(declare -p few); ulimit -$3 $4; start \"\$@\"" - "$1" limited
  ends_well "$1, $2 $4" "$1" limited
}
disk() { # OPTIONS: a small disk of its own
  mountpoint -q "$mounted" && umount -l "$mounted"
  mkdir -p "$mounted"
  mount -t tmpfs -o "$1" vlaprobe "$mounted"
}
can_mount=1
disk size=1m 2>/dev/null || { can_mount=; echo "skipped: disks that are full or read-only, which need root"; }
command -v faketime >/dev/null || echo "skipped: clocks that jump, which need faketime"

for ((round = 0; round < rounds; ++round)); do
  between few_handles 8 60
  limited "handles" n "$few_handles"
  reading "handles" n "$few_handles"
  between little 60000 900000 # KiB
  limited "memory" v "$little"
  reading "memory" v "$little"
  between small 1 400
  limited "KiB in a file" f "$small"
  for verb in "${writers[round % 5]}" "${writers[(round + 2) % 5]}"; do
    writing "$verb" "handles" n "$few_handles"
    writing "$verb" "memory" v "$little"
    writing "$verb" "KiB in a file" f "$small"
    [ "$can_mount" ] || continue
    between room_kib 4 400
    disk "size=${room_kib}k"
    suffers "$verb, a disk of ${room_kib} KiB" bash -c "$(declare -p few); start \"\$@\"" - "$verb" "$mounted/out"
    mount -o remount,ro "$mounted"
    suffers "$verb, a disk that is read-only" bash -c "$(declare -p few); start \"\$@\"" - "$verb" "$mounted/out"
    mount -o remount,rw,size=1g "$mounted"
    ends_well "$verb, a disk of ${room_kib} KiB" "$verb" "$mounted/out"
  done
  if [ "$can_mount" ]; then
    between room_kib 40 2000
    between names 3 40
    for room in "size=${room_kib}k" "size=1g,nr_inodes=$names"; do
      disk "$room"
      suffers "a disk of $room" "$vlaprobe" run "${asked[@]}" -o "$mounted/run"
      mount -o remount,size=1g,nr_inodes=100000 "$mounted"
      recovers "a disk of $room" "$mounted/run"
    done
    # Begun, and gone on with where nothing can be written.
    disk size=1g
    "$vlaprobe" run "${asked[@]}" -o "$mounted/run" >/dev/null 2>&1 &
    between moment 300 900 # ms
    sleep "0.$moment"
    kill -9 $! 2>/dev/null || true
    wait $! 2>/dev/null || true
    mount -o remount,ro "$mounted"
    suffers "a disk that is read-only" "$vlaprobe" run "${asked[@]}" -o "$mounted/run"
    mount -o remount,rw "$mounted"
    recovers "a disk that is read-only" "$mounted/run"
  fi
  if command -v faketime >/dev/null; then
    rm -rf "$work/jumped"
    echo "+0" >"$work/clock"
    jumps=() ways=(+ -)
    for _ in 1 2 3 4 5 6; do
      between days 10 99
      between way 0 2
      jumps+=("${ways[way]}${days}d")
    done
    (for jump in "${jumps[@]}"; do sleep 0.15; echo "$jump" >"$work/clock"; done) &
    suffers "a clock that jumps" env FAKETIME_TIMESTAMP_FILE="$work/clock" FAKETIME_NO_CACHE=1 DONT_FAKE_MONOTONIC=1 \
      LD_PRELOAD="$(ls /usr/lib/*/faketime/libfaketimeMT.so.1)" "$vlaprobe" run "${asked[@]}" -o "$work/jumped"
    wait
    recovers "a clock that jumps" "$work/jumped"
  fi
  rm -rf "$work/two"
  "$vlaprobe" run "${asked[@]}" -o "$work/two" >"$work/other" 2>&1 &
  between moment 100 600 # ms
  sleep "0.$moment"
  suffers "a second writer" "$vlaprobe" run "${asked[@]}" -o "$work/two"
  wait $! || { cp "$work/other" "$work/said"; finding "the first of two writers did not end well"; }
  recovers "two writers" "$work/two"
done
echo "$calls calls, $refused refused, $found findings"
[ "$found" = 0 ]
