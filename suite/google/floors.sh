#!/usr/bin/env bash
# suite/google/floors.sh [FOLDER [POLICY...]]: what visual matching's 216 trials of one colouring give the expert and
# policies that understand nothing, written to suite/google/floors.csv, a line a family of tasks. The runs are kept in
# FOLDER; called again it continues them.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source "$here/families.sh"
vlaprobe=${VLAPROBE:-$here/../../build/vlaprobe}
folder=${1:-$here/../../build/google_floors}
[ $# -gt 0 ] && shift
policies=${*:-expert null random reach wrong}
suite=google_one_colouring
mkdir -p "$folder"
table=$folder/floors.csv
root=$("$vlaprobe" build "$here/one_colouring.probe" --suite $suite -o "$folder/$suite.plan" >/dev/null
  "$vlaprobe" verify "$folder/$suite.plan" --json | sed -n 's/^ *"root": "\([0-9a-f]*\)".*/\1/p')
printf '# plan %s\nfamily,policy,trials,attempted,success\n' "$root" >"$table"
for policy in $policies; do
  # One seed: the starts are the same for all, and only `random` draws.
  "$vlaprobe" run "$here/one_colouring.probe" --suite $suite --policy "$policy" --seeds 0 --jobs "$(nproc)" -o "$folder/$policy"
  "$vlaprobe" results "$folder/$policy" --csv | awk -F, -v policy="$policy" "$family"'
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    { f = family($1)
      if (!(f in trials)) order[++families] = f
      ++trials[f]; attempted[f] += $column["invalid"] == ""; success[f] += $column["success"] == "true" }
    END { for (i = 1; i <= families; ++i) { f = order[i]
      printf "%s,%s,%d,%d,%d\n", f, policy, trials[f], attempted[f], success[f] } }' >>"$table"
done
# A table of some policies takes nobody's place.
if [ "$policies" = "expert null random reach wrong" ]; then mv "$table" "$here/floors.csv"; else echo "$table"; fi
