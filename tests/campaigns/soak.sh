#!/usr/bin/env bash
# tests/campaigns/soak.sh [MINUTES [FOLDER [VLAPROBE]]]: one call of `run` that goes on for MINUTES (60; 20s are seconds) with pictures
# over a server, and every ten seconds its memory and its open files, into FOLDER/soak.csv (seconds, KiB resident, files, threads, episodes). What grows is a
# finding: the median of the last fifth more than 5 % and 8 MiB above that of the second fifth, or more than 2 files. A day is `soak.sh
# 1440`. Exit 0: nothing grew and no episode is invalid.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
lasts=${1:-60} folder=${2:-$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-soak-XXXXXX")} vlaprobe=${3:-$here/build/vlaprobe}
case $lasts in *s) lasts=${lasts%s} ;; *) lasts=$((lasts * 60)) ;; esac
mkdir -p "$folder"
python=/usr/bin/python3 server='' client=''
stop() {
  for process in $client $server; do kill -9 "$process" 2>/dev/null || true; done
}
trap stop EXIT
port=$((20000 + $$ % 8000))
while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
"$python" "$here/tests/servers/openpi_digest_server.py" "$port" >"$folder/server.log" 2>&1 &
server=$!
for _ in {1..200}; do grep -q port "$folder/server.log" && break; sleep 0.05; done
# More seeds than there is time for; the call is ended as a scheduler ends it.
"$vlaprobe" run "$here/suite/intact.probe" --suite intact --tasks carrot_on_plate --seeds "$(seq -s , 1 5000)" --jobs 2 \
  --policy "openpi://127.0.0.1:$port?timeout.wait_s=20" -o "$folder/run" >"$folder/said" 2>&1 &
client=$!
echo "seconds,resident_kib,files,threads,episodes" >"$folder/soak.csv"
begun=$SECONDS
while ((SECONDS - begun < lasts)) && kill -0 "$client" 2>/dev/null; do
  sleep "$((lasts > 120 ? 10 : 1))"
  # The program that the first one became or started.
  process=$(pgrep -P "$client" -f vlaprobe-full | head -n 1 || true)
  process=${process:-$client}
  resident=$(awk '/^VmRSS/ {print $2}' "/proc/$process/status" 2>/dev/null || true)
  threads=$(awk '/^Threads/ {print $2}' "/proc/$process/status" 2>/dev/null || true)
  files=$(find "/proc/$process/fd" -mindepth 1 2>/dev/null | wc -l)
  episodes=$(find "$folder/run/traces" -name '*.trace*' ! -name '*.tmp' 2>/dev/null | wc -l)
  [ -z "$resident" ] || echo "$((SECONDS - begun)),$resident,$files,$threads,$episodes" >>"$folder/soak.csv"
done
kill -TERM "$client" 2>/dev/null || { tail -n 3 "$folder/said"; echo "the call ended by itself"; exit 1; }
wait "$client" || true
client=
invalid=$("$vlaprobe" results "$folder/run" --json | grep -c '"invalid": "' || true)
"$python" - "$folder/soak.csv" "$invalid" <<'PYTHON'
import csv, statistics, sys
rows = list(csv.DictReader(open(sys.argv[1])))
fifth = len(rows) // 5
if not fifth:
    sys.exit("too short to tell: %d rows" % len(rows))
def median(part, key):
    return statistics.median(int(row[key]) for row in part)
early, late = rows[fifth:2 * fifth], rows[-fifth:]
memory = [median(part, "resident_kib") for part in (early, late)]
files = [median(part, "files") for part in (early, late)]
print("%s episodes in %s s, %s invalid: %.1f, then %.1f MiB resident, %d, then %d files, %s threads"
      % (rows[-1]["episodes"], rows[-1]["seconds"], sys.argv[2], memory[0] / 1024, memory[1] / 1024, files[0], files[1], rows[-1]["threads"]))
grew = memory[1] > 1.05 * memory[0] and memory[1] > memory[0] + 8192
if grew or files[1] > files[0] + 2:
    sys.exit("FOUND: it grows")
if sys.argv[2] != "0":
    sys.exit("FOUND: invalid episodes")
PYTHON
