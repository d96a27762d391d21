#!/usr/bin/env bash
# suite/kitchen/floors.sh [FOLDER [POLICY...]]: what every task of suite/kitchen.probe gives the expert (its ceiling) and
# policies that understand nothing (its floors), written to suite/kitchen/floors.csv. The runs are kept in FOLDER; called
# again it continues them. JOBS: worlds in parallel.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
vlaprobe=${VLAPROBE:-$here/../../build/vlaprobe}
folder=${1:-$here/../../build/kitchen_floors}
[ $# -gt 0 ] && shift
policies=${*:-expert null random reach wrong}
mkdir -p "$folder"
table=$folder/floors.csv
root=$("$vlaprobe" build "$here/../kitchen.probe" --suite kitchen -o "$folder/kitchen.plan" >/dev/null
  "$vlaprobe" verify "$folder/kitchen.plan" --json | sed -n 's/^ *"root": "\([0-9a-f]*\)".*/\1/p')
printf '# plan %s\ntask,policy,episodes,attempted,intention,success,disturbed\n' "$root" >"$table"
for policy in $policies; do
  # One seed: the starts are the same for all, and only `random` draws.
  "$vlaprobe" run "$here/../kitchen.probe" --suite kitchen --policy "$policy" --seeds 0 --jobs "${JOBS:-$(nproc)}" -o "$folder/$policy"
  "$vlaprobe" results "$folder/$policy" --csv | awk -F, -v policy="$policy" '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    { if (!($1 in episodes)) order[++tasks] = $1
      ++episodes[$1]; attempted[$1] += $column["invalid"] == ""; intention[$1] += $column["intention"] == "true"
      success[$1] += $column["success"] == "true"; disturbed[$1] += $column["disturbed"] == "true" }
    END { for (i = 1; i <= tasks; ++i) { t = order[i]
      printf "%s,%s,%d,%d,%d,%d,%d\n", t, policy, episodes[t], attempted[t], intention[t], success[t], disturbed[t] } }' >>"$table"
done
# A table of some policies takes nobody's place.
if [ "$policies" = "expert null random reach wrong" ]; then mv "$table" "$here/floors.csv"; else echo "$table"; fi
