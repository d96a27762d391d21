#!/usr/bin/env bash
# tests/campaigns/verb_kills.sh [KILLS] [VLAPROBE]: kills `run`, `sweep`, `merge` and `export` (a table, a dataset) in turn
# at random moments, KILLS times (200). What a kill leaves is looked at, then the same command runs to its end:
#   run, sweep, merge   the folder is read, or no run is there yet; in the end the rows of a calm one and no half files
#   export              the file is not there or whole; a dataset's folder is said to be half, or whole; in the end equal bytes
# Exit 0: nothing else was seen.
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
kills=${1:-200}
vlaprobe=$(realpath "$(command -v "${2:-$here/build/vlaprobe}")")  # it is called from other folders
dir=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-verbs-XXXXXX")
trap 'rm -rf "$dir"' EXIT
RANDOM=21
cd "$dir"

. "$here/tests/campaigns/verbs.sh"
verbs=(run sweep merge table dataset)  # ask_kills.sh is of the other
wrong() { # VERB WHAT
  echo "kill $kill of $1: $2"
  tail -n 5 "$dir/log" "$dir/look"
  exit 1
}
look() { # VERB OUTPUT: what a kill left is read
  local folder
  case $1 in
    run | merge | sweep)
      for folder in "$2" "$2"/0.*; do
        [ -e "$folder/results.sqlite" ] || continue
        "$vlaprobe" results "$folder" >look 2>&1 || grep -q 'no run here\|no episodes' look || wrong "$1" "its folder is not read"
      done
      ;;
    table) [ ! -e "$2.h5" ] || cmp -s "$2.h5" calm.table.h5 || wrong "$1" "a half file has its name" ;;
    dataset) [ ! -e "$2/meta/info.json" ] || "$vlaprobe" export --check "$2" calm.run --no-redraw >look 2>&1 ||
      wrong "$1" "what looks like a dataset does not hold" ;;
  esac
}
wait_up_to() { # MILLISECONDS: a moment of them, drawn in this shell: others are seeded anew
  local at=$((RANDOM % $1))
  sleep "$(printf "%d.%03d" $((at / 1000)) $((at % 1000)))"
}

verbs_begin
declare -A takes
kill=0
for verb in "${verbs[@]}"; do
  rm -rf "calm.$verb"  # calm.run is there
  begun=$(date +%s%N)
  (start "$verb" "calm.$verb") >log 2>&1 || wrong "$verb" "it does not end well when nobody disturbs it"
  takes[$verb]=$(((($(date +%s%N) - begun) / 1000000) * 11 / 10 + 1))
  content "$verb" "calm.$verb" >"$verb.content"
done

killed=0
for ((kill = 1; kill <= kills; ++kill)); do
  verb=${verbs[kill % ${#verbs[@]}]}
  (start "$verb" out) >log 2>&1 &
  victim=$!
  wait_up_to "${takes[$verb]}"
  if kill -9 "$victim" 2>/dev/null; then killed=$((killed + 1)); fi
  wait "$victim" 2>/dev/null || true
  look "$verb" out
  if [ "$verb" = dataset ] && [ -e out ]; then  # half or whole, a folder that is there is not written into
    (start dataset out) >log 2>&1 && wrong dataset "it went on in a folder that was there"
    rm -rf out
  fi
  (start "$verb" out) >log 2>&1 || wrong "$verb" "the same command does not end well"
  content "$verb" out >content || wrong "$verb" "its output is not read"
  cmp -s content "$verb.content" || wrong "$verb" "its output is not that of a calm one"
  left=$(find out -name '*.tmp' 2>/dev/null | head -n 1)
  [ -z "$left" ] || wrong "$verb" "it left $left"
  rm -rf out out.h5*  # beside a file what was begun of it stays: nothing can tell whose it is
done
echo "$killed of $kills kills met $(printf '%s ' "${verbs[@]}")at work; every output is that of a calm one"
