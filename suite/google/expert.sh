#!/usr/bin/env bash
# suite/google/expert.sh [FOLDER]: what the environments, the variants, the probing questions and google_clean give the expert, written
# to suite/google/expert.csv, a line a suite and family of tasks: how many trials there are, how many were played and solved. What was
# not, with its reason, is in FOLDER/SUITE.txt. Without pictures, at which the expert does not look. Where suites differ from *_places
# in looks and words alone, one start of each task is played, which must end in a state of *_places, to the bit. Rows a start stay in
# FOLDER; a suite that is complete there is not played again. JOBS: worlds in parallel.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/families.sh"
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
  root=$("$build/vlaprobe" build "$here/$file" --suite "$suite" -o "$folder/$suite.plan" >/dev/null
    "$build/vlaprobe" verify "$folder/$suite.plan" --json | sed -n 's/^ *"root": "\([0-9a-f]*\)".*/\1/p')
  grep -q " of .*\.probe$" "$folder/$suite.txt" 2>/dev/null && head -1 "$folder/$suite.csv" | grep -q "plans $root$" ||
  "$build/tests/starts" "$here/$file" --suite "$suite" --starts "$starts" --assets "$here/../../assets" --jobs "${JOBS:-$(nproc)}" \
    -o "$folder/$suite.csv" >"$folder/$suite.txt"
  local name=google/$file
  echo "# plan $root ${name/google\/..\//} $suite" >>"$table"  # its file as seen from suite/
  "$build/vlaprobe" list "$here/$file" --suite "$suite" --json | awk -F'[":, ]+' '
    $2 == "task" { task = $3 } $2 == "episodes" { print task "," $3 }' >"$folder/$suite.tasks"
  awk -F, -v suite="$suite" "$family"'
    NR == FNR { f = family($1); if (!(f in trials)) order[++families] = f; trials[f] += $2; member[$1] = 1; next }
    /^#/ || $1 == "task" || !($1 in member) { next }
    { f = family($1); ++played[f]; success[f] += $3 == "success" }
    END { for (i = 1; i <= families; ++i) { f = order[i]
      printf "%s,%s,%d,%d,%d\n", suite, f, trials[f], played[f], success[f] } }' "$folder/$suite.tasks" "$folder/$suite.csv" >>"$rows"
}
same() { # PLACES SUITE
  awk -F, -v suite="$2" '
    /^#/ || $1 == "task" { next }
    NR == FNR { known[$8] = 1; next }
    !($8 in known) { print suite ": " $1 ", start " $2 ", ends otherwise than any task that it is a variant of"; found = 1 }
    END { exit found }' "$folder/$1.csv" "$folder/$2.csv" >&2
}
one ../google.probe google
one places.probe google_variants_places
one variants.probe google_variants_run 0
same google_variants_places google_variants_run
one ../google_clean.probe google_clean
one probing_places.probe google_probing_places
one ../google_probing.probe google_probing 0
same google_probing_places google_probing
cat "$rows" >>"$table"
mv "$table" "$here/expert.csv"
