# Sourced by .ci/install, .ci/build and tests/run.sh: says on stderr how far a long command is. On a terminal one line
# that is redrawn; elsewhere a line at once and then one every ten seconds.

progress_every=10
progress_said=-$progress_every  # when the last line was printed, in seconds of this shell
progress_redraws=0
if [ -t 2 ] && [ "${TERM:-dumb}" != dumb ]; then progress_redraws=1; fi

progress_duration() {
  local seconds=$1
  if [ "$seconds" -lt 100 ]; then echo "$seconds s"; else echo "$((seconds / 60)) min $((seconds % 60)) s"; fi
}

# progress_draw LABEL SECONDS DONE TOTAL WORDS: one line, with a bar where it is redrawn and the total is known.
progress_draw() {
  local label=$1 time=$2 done=$3 total=$4 words=$5 line bar full columns
  line=$label
  if [ "$total" -gt 0 ]; then line="$line: $done of $total"; fi
  line="$line, $(progress_duration "$time")${words:+, $words}"
  if [ $progress_redraws -eq 0 ]; then echo "$line" >&2; return; fi
  if [ "$total" -gt 0 ]; then
    full=$((30 * done / total))
    bar=$(printf '%*s' "$full" '' | tr ' ' '=')
    line="[$(printf '%-30s' "$bar")] $line"
  fi
  columns=$(tput cols 2>/dev/null || echo 80)
  printf '\r\033[K%s' "${line:0:columns-1}" >&2
}

progress_clear() { if [ $progress_redraws -eq 1 ]; then printf '\r\033[K' >&2; fi; }

# In the background, while the shell that began it is there.
progress_watch() {
  local label=$1 reader=$2 log=$3 begun=$SECONDS at
  while kill -0 $$ 2>/dev/null; do
    if [ $progress_redraws -eq 1 ] || [ $((SECONDS - progress_said)) -ge $progress_every ]; then
      read -r -a at < <("$reader" "$log") || true
      progress_draw "$label" $((SECONDS - begun)) "${at[0]:-0}" "${at[1]:-0}" "${at[*]:2}"
      progress_said=$SECONDS
    fi
    sleep 0.5
  done
}

# with_progress LABEL READER LOG COMMAND...: runs the command with its output in LOG; returns its status. READER is a
# function that is given LOG and prints "DONE TOTAL WORDS", or nothing when it does not know yet.
with_progress() {
  local label=$1 reader=$2 log=$3 watcher status=0
  shift 3
  : >"$log"
  progress_watch "$label" "$reader" "$log" &
  watcher=$!
  "$@" >"$log" 2>&1 || status=$?
  kill $watcher 2>/dev/null || true
  wait $watcher 2>/dev/null || true
  progress_clear
  return $status
}

# Readers.
progress_unknown() { :; }
progress_ninja() { tail -n 5 "$1" | sed -n 's/^\[\([0-9]*\)\/\([0-9]*\)\].*/\1 \2/p' | tail -n 1; }
progress_apt() {
  tail -n 50 "$1" | sed -n 's/^\(dl\|pm\)status:[^:]*:\([0-9]*\)[.0-9]*:\(.*\)/\2 100 \3/p' | tail -n 1
}
