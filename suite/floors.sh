#!/usr/bin/env bash
# suite/floors.sh [FOLDER]: what every task of the suite gives the expert (its ceiling) and policies that understand
# nothing (its floors), written to suite/floors.csv. The runs are kept in FOLDER; called again it continues them.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
vlaprobe=${VLAPROBE:-$here/../build/vlaprobe}
folder=${1:-$here/../build/floors}
mkdir -p "$folder"
table=$folder/floors.csv
: >"$table"
for policy in expert null random reach wrong; do
  # One seed: the starts are the same for all three, and only `random` draws. `wrong` stays still where no distractor is.
  "$vlaprobe" run "$here/intact.probe" --suite intact --policy "$policy" --seeds 42 --jobs "$(nproc)" -o "$folder/$policy"
  if [ "$policy" = expert ]; then
    root=$("$vlaprobe" verify "$folder/expert/suite.plan" --json | sed -n 's/^ *"root": "\([0-9a-f]*\)".*/\1/p')
    printf '# plan %s\ntask,policy,episodes,intention,grasp,success,wrong\n' "$root" >"$table"
  fi
  "$vlaprobe" results "$folder/$policy" --csv | awk -F, -v policy="$policy" '
    NR == 1 { for (i = 1; i <= NF; ++i) column[$i] = i; next }
    $column["invalid"] != "" { next }
    !($1 in episodes) { order[++tasks] = $1 }
    { ++episodes[$1]
      intention[$1] += $column["intention"] == "true"; grasp[$1] += $column["grasp"] == "true"
      success[$1] += $column["success"] == "true"; wrong[$1] += $column["wrong"] == "true" }
    END { for (i = 1; i <= tasks; ++i) { t = order[i]
      printf "%s,%s,%d,%d,%d,%d,%d\n", t, policy, episodes[t], intention[t], grasp[t], success[t], wrong[t] } }' >>"$table"
done
mv "$table" "$here/floors.csv"
