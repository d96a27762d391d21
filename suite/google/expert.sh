#!/usr/bin/env bash
# suite/google/expert.sh [FOLDER]: what the variants, the probing questions and google_clean give the expert, written to
# suite/google/expert.csv, a line a suite and family of tasks: how many trials there are, how many were played and solved. What was
# not, with its reason, is in FOLDER/SUITE.txt. Without pictures, at which the expert does not look. Where suites differ from *_places
# in looks and words alone, one start of each task is played. Rows a start stay in FOLDER; a suite that is
# complete there is not played again.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=${VLAPROBE_BUILD:-$here/../../build}
folder=${1:-$build/google_expert}
mkdir -p "$folder"
table=$folder/expert.csv
rows=$folder/expert_rows.csv
: >"$table"
echo 'suite,family,trials,played,success' >"$rows"
one() { # FILE SUITE [STARTS]
  local file=$1 suite=$2 starts=${3:-}
  local root
  root=$("$build/vlaprobe" build "$here/$file" --suite "$suite" -o "$folder/$suite.plan" >/dev/null 2>&1
    "$build/vlaprobe" verify "$folder/$suite.plan" --json 2>/dev/null | sed -n 's/^ *"root": "\([0-9a-f]*\)".*/\1/p')
  grep -q " of .*\.probe$" "$folder/$suite.txt" 2>/dev/null && head -1 "$folder/$suite.csv" | grep -q "plans $root$" ||
  "$build/tests/starts" "$here/$file" --suite "$suite" --starts "$starts" --assets "$here/../../assets" --jobs "$(nproc)" \
    -o "$folder/$suite.csv" >"$folder/$suite.txt"
  local name=google/$file
  echo "# plan $root ${name/google\/..\//} $suite" >>"$table"  # its file as seen from suite/
  "$build/vlaprobe" list "$here/$file" --suite "$suite" --json | awk -F'[":, ]+' '
    $2 == "task" { task = $3 } $2 == "episodes" { print task "," $3 }' >"$folder/$suite.tasks"
  awk -F, -v suite="$suite" '
    function family(task) {
      return task ~ /^pick_horizontal/ ? "can horizontal" : task ~ /^pick_vertical/ ? "can vertical" : task ~ /^pick_standing/ ? "can standing" \
        : task ~ /^pick_/ ? "other things" : task ~ /_near_/ ? "move near" : task ~ /^open_/ ? "open" : task ~ /^close_/ ? "close" : "apple" }
    NR == FNR { f = family($1); if (!(f in trials)) order[++families] = f; trials[f] += $2; member[$1] = 1; next }
    /^#/ || $1 == "task" || !($1 in member) { next }
    { f = family($1); ++played[f]; success[f] += $3 == "success" }
    END { for (i = 1; i <= families; ++i) { f = order[i]
      printf "%s,%s,%d,%d,%d\n", suite, f, trials[f], played[f], success[f] } }' "$folder/$suite.tasks" "$folder/$suite.csv" >>"$rows"
}
one places.probe google_variants_places
one variants.probe google_variants_run 0
one ../google_clean.probe google_clean
one probing_places.probe google_probing_places
one ../google_probing.probe google_probing 0
cat "$rows" >>"$table"
mv "$table" "$here/expert.csv"
