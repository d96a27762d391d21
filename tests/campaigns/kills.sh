#!/usr/bin/env bash
# tests/campaigns/kills.sh [KILLS] [VLAPROBE]: kills client and server in turn, at random moments, KILLS times (200)
# over one run of 96 episodes, and compares its rows with those of an undisturbed run. When the run
# is complete before all kills are spent, the rest fall on calls that find everything there.
# Exit 0: 96 rows, no duplicates, equal hashes.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
kills=${1:-200}
vlaprobe=${2:-$here/build/vlaprobe}
python=/usr/bin/python3
dir=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-kills-XXXXXX")
server=
client=
stop() {
  [ -z "$client" ] || kill -9 "$client" 2>/dev/null || true
  [ -z "$server" ] || { kill -9 "$server" && wait "$server"; } 2>/dev/null || true
  rm -rf "$dir"
}
trap stop EXIT
RANDOM=20

start_server() {
  "$python" "$here/tests/servers/openpi_digest_server.py" "$port" >"$dir/port" 2>>"$dir/server.log" &
  server=$!
  for _ in {1..200}; do
    grep -q port "$dir/port" && return
    sleep 0.05
  done
  tail -n 3 "$dir/server.log"
  return 1
}
run() { # FOLDER
  exec "$vlaprobe" run "$dir/suite.plan" --tasks carrot_on_plate --seeds 1,2,3,4 --jobs 3 \
    --policy "openpi://127.0.0.1:$port?timeout.wait_s=20" -o "$1" >>"$dir/client.log" 2>&1
}
rows() { # FOLDER: everything but the traces' places
  "$vlaprobe" results "$1" --json |
    "$python" -c '
import json, sys
for row in json.load(sys.stdin):
    row.pop("trace")
    print(json.dumps(row, sort_keys=True))'
}
pause() { # LOW HIGH, in milliseconds: drawn here, as what is drawn within $(...) is none of the seed's draws
  local at=$(($1 + RANDOM % ($2 - $1)))
  sleep "$(printf "%d.%03d" $((at / 1000)) $((at % 1000)))"
}

"$vlaprobe" build "$here/suite/intact.probe" -o "$dir/suite.plan" >/dev/null
# Not one of the ports that the system gives to connections: a client that tries while nobody listens
# could get the very same one, and the server then could not.
port=$((20000 + $$ % 8000))
while (exec 3<>"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do port=$((port + 1)); done
start_server
(run "$dir/calm") || { tail -n 5 "$dir/client.log"; exit 1; }

killed_client=0 killed_server=0 idle=0
for ((kill = 1; kill <= kills; ++kill)); do
  if [ -z "$client" ] || ! kill -0 "$client" 2>/dev/null; then
    (run "$dir/killed") &
    client=$!
  fi
  if ((kill % 2)); then
    pause 300 2500
    if kill -9 "$client" 2>/dev/null; then killed_client=$((killed_client + 1)); else idle=$((idle + 1)); fi
    wait "$client" 2>/dev/null || true
    client=
  else
    pause 500 1500
    kill -9 "$server"
    wait "$server" 2>/dev/null || true
    killed_server=$((killed_server + 1))
    pause 0 700
    start_server
  fi
done
if [ -n "$client" ]; then wait "$client" || true; client=; fi
(run "$dir/killed") || { tail -n 5 "$dir/client.log"; exit 1; }

rows "$dir/calm" >"$dir/calm.rows"
rows "$dir/killed" >"$dir/killed.rows"
count=$(wc -l <"$dir/killed.rows")
distinct=$(sort -u "$dir/killed.rows" | wc -l)
echo "$killed_client kills of the client, $killed_server of the server," \
  "$idle fell on a client that had ended; $count rows, $distinct distinct"
left=$(find "$dir/killed" -name '*.tmp' | wc -l)
[ "$count" = 96 ] && [ "$distinct" = 96 ] && [ "$left" = 0 ] && cmp "$dir/calm.rows" "$dir/killed.rows" &&
  ! grep -q '"invalid": "' "$dir/killed.rows" && echo "equal to the undisturbed run"
