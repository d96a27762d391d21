#!/usr/bin/env bash
# tests/libero_expert.sh LIBERO ROBOSUITE [FOLDER] [STARTS]: what the expert, and scripted policies that understand
# nothing, make of the starts of LIBERO's four short suites, without pictures: FOLDER/POLICY.csv has a row a start,
# FOLDER/POLICY.txt the table with the failing starts and their reasons. FOLDER/libero is the import, made where it is not
# there. STARTS: "0-4"; all 50 else. POLICIES names others than "expert null reach wrong", VLAPROBE_BUILD another build.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
build=${VLAPROBE_BUILD:-$here/build}
folder=${3:-$here/build/libero_expert}
mkdir -p "$folder"
[ "$build" != "$here/build" ] || "$here/.ci/build" vlaprobe starts
[ -d "$folder/libero" ] || "$build/vlaprobe" libero import "$1" --robosuite "$2" -o "$folder/libero"
for policy in ${POLICIES:-expert null reach wrong}; do
  nice -n 10 "$build/tests/starts" "$folder"/libero/libero_{spatial,object,goal,10}.probe --assets "$folder/libero" \
    --policy "$policy" --starts "${4:-}" --jobs "$(nproc)" -o "$folder/$policy.csv" >"$folder/$policy.txt"
  grep ' of .*\.probe' "$folder/$policy.txt" | sed "s/^/$policy /"
done
