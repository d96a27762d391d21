#!/usr/bin/env bash
# tests/slurm_many.sh [TASKS [EPISODES [NODES [KILLED [VLAPROBE]]]]]: EPISODES (100000) of a task of six steps, seen by a camera of
# 32 x 24, over an array of TASKS (64) in a real Slurm of this machine with NODES (16) nodes of four CPUs, of which KILLED (5) die with all that runs on them
# while the job does. Their tasks are queued again on the others. Merged and reported, the rows have to be those of one run.
# Prints what it took. Needs root; says so and ends with 0 where Slurm cannot start. Not a part of CI at this size: there it runs
# with 6 tasks, 192 episodes, 3 nodes, 1 killed (tests/runtime/cluster/slurm_test.cpp).
set -eu
here=$(cd "$(dirname "$0")/.." && pwd)
tasks=${1:-64} episodes=${2:-100000} nodes=${3:-16} killed=${4:-5}
vlaprobe=${5:-$here/build/vlaprobe}
python=/usr/bin/python3
dir=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-slurm-XXXXXX")
stop() {
  exec 9>&- # the cluster ends with its input
  [ -n "${cluster-}" ] && wait "$cluster" 2>/dev/null
  # Its daemons may still write what they know.
  for _ in {1..100}; do rm -rf "$dir" 2>/dev/null && break; sleep 0.1; done
  return 0
}
trap stop EXIT
mkfifo "$dir/in"
SLURMD_TIMEOUT=10 bash "$here/tests/servers/slurm_cluster.sh" "$dir/cluster" "$nodes" 4 <"$dir/in" >"$dir/said" &
cluster=$!
exec 9>"$dir/in"
for _ in {1..1500}; do [ -s "$dir/said" ] && break; sleep 0.1; done
said=$(head -n 1 "$dir/said")
[ "$said" = ready ] || { echo "skipped: $said"; exit 0; }
export SLURM_CONF=$dir/cluster/slurm.conf

starts=24
seeds=$(seq -s , 1 $(((episodes + starts - 1) / starts)))
cat >"$dir/many.probe" <<PROBE
use "$here/suite/intact.probe"
camera tiny like third_view { image 32 x 24; lens 31.1794px, 31.1794px, 15.5px, 11.5px }
task quick like carrot_on_plate { horizon 6 steps; camera tiny }
suite many trained on bridge_v2 { tasks { quick }; seeds 1 }
PROBE
"$vlaprobe" build "$dir/many.probe" -o "$dir/many.plan" >/dev/null 2>&1
chosen=("$dir/many.plan" --suite many --policy random --seeds "$seeds")
rows() { # FOLDER: everything but the traces' places
  "$vlaprobe" results "$1" --csv | "$python" -c '
import csv, sys
for row in csv.DictReader(sys.stdin):
    row.pop("trace")
    print(sorted(row.items()))'
}

# A machine that loses its power: its daemon first, then all that has its name or holds what has.
lose() { # NODE
  kill -9 "$(cat "$dir/cluster/slurmd-$1.pid")"
  local process all=()
  # Whatever has both in its environment, and whose child it is.
  for process in $(grep -lzxs "SLURMD_NODENAME=$1" /proc/[0-9]*/environ | xargs -r grep -lzxs "SLURM_CONF=$SLURM_CONF" | cut -d/ -f3); do
    all+=("$(awk '/^PPid:/ {print $2}' "/proc/$process/status" 2>/dev/null)" "$process")
  done
  for process in "${all[@]}"; do
    case $(tr '\0' ' ' <"/proc/$process/cmdline") in
      slurmstepd*|"$vlaprobe"*|*slurm_script*) kill -9 "$process" || true ;;
    esac
  done 2>/dev/null
  scontrol update "NodeName=$1" State=DOWN Reason=lost
}
begun=$SECONDS
"$vlaprobe" slurm "${chosen[@]}" --array "$tasks" -o "$dir/run" --submit >"$dir/slurm.log" 2>&1 &
job=$!
pause=0.2
[ "$episodes" -lt 2000 ] || pause=1  # looking for 100,000 files takes part of one
stored() { find "$dir/run/shards" -name '*.trace' 2>/dev/null | wc -l; }
lost=0
while kill -0 "$job" 2>/dev/null; do
  sleep "$pause"
  [ $((SECONDS - begun)) -lt "${SLURM_MANY_LIMIT:-36000}" ] || { echo "not done after $((SECONDS - begun)) s"; tail -n 20 "$dir/slurm.log"; kill "$job"; exit 1; }
  # Each at another part of the work, while something runs on it.
  if [ "$lost" -lt "$killed" ] && [ "$(stored)" -ge $((episodes * (lost + 1) / (killed + 3))) ]; then
    busy=$(squeue --noheader --states=RUNNING --format=%N | sort -u | shuf -n 1 --random-source=<(yes "$lost"))
    [ -n "$busy" ] || continue
    at=$(stored)
    lose "$busy"
    lost=$((lost + 1))
    echo "node $busy lost with $at of $episodes episodes stored"
  fi
  # By itself Slurm lets a requeued task wait for two minutes.
  if [ "$lost" -gt 0 ] && [ -s "$dir/run/slurm/job" ]; then
    for one in $(squeue --noheader --array --states=PENDING --jobs "$(cat "$dir/run/slurm/job")" --format='%i %r' 2>/dev/null | awk '$2 == "BeginTime" {print $1}'); do
      scontrol update "JobId=$one" StartTime=now 2>/dev/null || true
    done
  fi
done
wait "$job" || { tail -n 20 "$dir/slurm.log"; exit 1; }
echo "array of $tasks on $nodes nodes, $lost of them lost: $((SECONDS - begun)) s"
[ "$lost" -eq "$killed" ] || { echo "only $lost nodes were lost: too few episodes for that"; exit 1; }
timed() { # NAME COMMAND...
  local name=$1
  shift
  TIMEFORMAT="$name: %U user and %S system CPU s, %R s"
  { time "$@" >"$dir/log" 2>&1; } 2>&1 || { tail -n 20 "$dir/log"; exit 1; }
}
timed merge "$vlaprobe" merge "$dir"/run/shards/* -o "$dir/merged"
timed report "$vlaprobe" report "$dir/run" -o "$dir/page.html"
# It does not wait for the disk after each row, as one process alone would: nothing of it has to outlast this machine.
printf 'int fsync(int f) { return f < 0; }\nint fdatasync(int f) { return f < 0; }\nint syncfs(int f) { return f < 0; }\n' |
  cc -shared -fPIC -x c - -o "$dir/nosync.so"
timed "one run" env LD_PRELOAD="$dir/nosync.so" "$vlaprobe" run "${chosen[@]}" --jobs 2 -o "$dir/single"
rows "$dir/run" >"$dir/run.rows"
rows "$dir/single" >"$dir/single.rows"
count=$(wc -l <"$dir/run.rows")
cmp "$dir/run.rows" "$dir/single.rows" && [ "$count" -ge "$episodes" ] || { echo "$count rows, and not those of one run"; exit 1; }
echo "$count rows, those of one run"
