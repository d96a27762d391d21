#!/usr/bin/env bash
# From a fresh Debian 12 to a judged, recorded, pictured evaluation: installs, builds, runs the suite with the scripted
# expert, and says where everything is. Run it again and it continues where it stopped.
#   examples/quickstart.sh [OUTPUT_DIR]      default: runs/quickstart in this checkout
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/runs/quickstart}
"$root/.ci/install"
"$root/.ci/build" vlaprobe

vlaprobe=$root/build/vlaprobe
"$vlaprobe" check "$root/suite/intact.probe"
"$vlaprobe" run "$root/suite/intact.probe" --tasks carrot_on_plate --policy expert --jobs "$(nproc)" --video all -o "$out"
"$vlaprobe" sheet "$out" -o "$out/contact_sheet.png"
"$vlaprobe" results "$out"

cat <<END

results        $out/results.sqlite  (vlaprobe results $out --json)
contact sheet  $out/contact_sheet.png
a video        $(find "$out/videos" -name '*.mp4' | sort | head -n 1)  (one an episode)
replay one     $vlaprobe replay $out carrot_on_plate 0 --verify
END
