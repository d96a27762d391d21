#!/usr/bin/env bash
# tests/campaigns/ask_kills.sh [KILLS] [VLAPROBE] [F]: kills `ask` KILLS times (100), at random moments, over 5,616 questions, and
# compares its rows with those of an undisturbed call. When all is answered before the kills are spent, the rest fall on
# calls that find everything there.
# Exit 0: every question has its one answer, the same as without kills.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
kills=${1:-100}
vlaprobe=${2:-$here/build/vlaprobe}
plan=${3:-$here/suite/questions.probe}
python=/usr/bin/python3
dir=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-ask-kills-XXXXXX")
server=
client=
stop() {
  [ -n "$client" ] && kill -9 "$client" 2>/dev/null
  [ -n "$server" ] && kill -9 "$server" 2>/dev/null && { wait "$server" 2>/dev/null || true; }
  rm -rf "$dir"
}
trap stop EXIT
RANDOM=20

"$python" "$here/tests/servers/chat_server.py" words_only delay=0.1 >"$dir/port" 2>"$dir/server.log" &
server=$!
for _ in {1..200}; do
  grep -q port "$dir/port" && break
  sleep 0.05
done
port=$(awk '{print $2}' "$dir/port")

ask() { # FOLDER JOBS: 5,616 questions take 4 jobs over two minutes
  exec "$vlaprobe" ask "$plan" ${ASK_WORDS:---questions understanding.source} --jobs "$2" \
    --model "openai://127.0.0.1:$port?model=words_only&size=64x48" -o "$1" >>"$dir/client.log" 2>&1
}
rows() { # FOLDER: everything that does not measure time
  "$vlaprobe" results "$1" --json |
    "$python" -c '
import json, sys
for row in json.load(sys.stdin):
    row.pop("latency_s")
    print(json.dumps(row, sort_keys=True))'
}

(ask "$dir/calm" 32) || { tail -n 5 "$dir/client.log"; exit 1; }
rows "$dir/calm" >"$dir/calm.rows"
killed=0 idle=0
for ((kill = 1; kill <= kills; ++kill)); do
  (ask "$dir/killed" 4) &
  client=$!
  at=$((200 + RANDOM % 1800))
  sleep "$(printf "%d.%03d" $((at / 1000)) $((at % 1000)))"
  if kill -9 "$client" 2>/dev/null; then killed=$((killed + 1)); else idle=$((idle + 1)); fi
  wait "$client" 2>/dev/null || true
  client=
done
(ask "$dir/killed" 4) || { tail -n 5 "$dir/client.log"; exit 1; }

rows "$dir/killed" >"$dir/killed.rows"
count=$(wc -l <"$dir/killed.rows")
distinct=$("$python" -c '
import json, sys
print(len({tuple(json.loads(line)[key] for key in
                 ("question_id", "start_id", "rotation", "arm", "episode", "seed"))
           for line in open(sys.argv[1])}))' "$dir/killed.rows")
echo "$killed kills, $idle fell on a call that had ended; $count answers, $distinct distinct"
[ "$count" = "$distinct" ] && cmp "$dir/calm.rows" "$dir/killed.rows" &&
  ! grep -q '"invalid": "' "$dir/killed.rows" && echo "equal to the undisturbed call"
