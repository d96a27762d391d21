#!/usr/bin/env bash
# The whole story: demonstrations, two datasets, two policies, checkpoints compared, the suite, a report.
#   examples/learn/run.sh [OUTPUT_DIR]      default: runs/learn in this checkout
# MINUTES of processor time for each policy (12), JOBS worlds side by side (8), VLAPROBE and PYTHON programs.
# Needs python3-torch and python3-h5py. Begun again it goes on with the first step that has not ended.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
out=$(realpath -m "${1:-$root/runs/learn}")
vlaprobe=${VLAPROBE:-$root/build/vlaprobe}
python=${PYTHON:-/usr/bin/python3}
jobs=${JOBS:-8}
"$python" -c 'import torch, h5py' || { echo "apt-get install python3-torch python3-h5py" >&2; exit 2; }
mkdir -p "$out"
cd "$root"

# ---- what it is shown: the expert's demonstrations, each told in up to eight wordings ---------------------------------
if [ ! -e "$out/data" ]; then
  "$vlaprobe" demos examples/learn/tasks.probe --suite learn --jobs 2 -o "$out/demos"
  [ -e "$out/words.jsonl" ] || "$vlaprobe" rephrase examples/learn/tasks.probe --suite learn \
    --not-in suite/intact.probe --drop-leaks -o "$out/words.jsonl"
  "$vlaprobe" export "$out/demos" --format robomimic --size 128x96 --jobs 2 -o "$out/data" \
    --rephrase "$out/words.jsonl" --wordings 8
fi

# ---- two policies: all is the same but the words ---------------------------------------------------------------------
learn() { # NAME WORDS
  [ -e "$out/policies/$1/part_3.pt" ] ||
    "$python" "$here/train.py" "$out/data" -o "$out/policies/$1" --words "$2" --minutes "${MINUTES:-12}"
}
learn plain instruction
learn rephrased lang

# ---- served: the four canonical tasks with each checkpoint, the whole suite with the best -----------------------------
for kind in plain rephrased; do
  "$python" "$here/serve.py" "$out/policies/$kind" --port 0 > "$out/$kind.port" 2> "$out/$kind.log" &
  server=$!
  trap 'kill $server 2>/dev/null || true' EXIT
  until grep -q port "$out/$kind.port"; do kill -0 $server; sleep 0.2; done
  at="ws://127.0.0.1:$(cut -d' ' -f2 "$out/$kind.port")"
  "$vlaprobe" sweep suite/intact.probe --seeds 42 --jobs "$jobs" --name "$kind {}" -o "$out/$kind" \
    --policy "$at/{}?profile=examples/learn/learnt.profile&batch=$jobs" --checkpoints part_1,part_2,part_3
  kill $server
done

best() { "$python" -c 'import json, sys; print(json.load(open(sys.argv[1]))["best"])' "$out/$1/sweep.json"; }
runs=("$out/plain/$(best plain)" "$out/rephrased/$(best rephrased)")
"$vlaprobe" compare "${runs[@]}" | tee "$out/compare.txt"
"$vlaprobe" report "${runs[@]}" --floors suite/floors.csv -o "$out/report.html"
echo "report    $out/report.html"
