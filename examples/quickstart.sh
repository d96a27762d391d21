#!/usr/bin/env bash
# From a fresh Debian 12 to a judged, recorded, pictured evaluation: installs, builds, runs the suite with the scripted
# expert, and says where everything is. Run it again and it continues where it stopped. In an unpacked bundle, or where
# .ci/bundle made one of this commit, nothing is installed or built.
#   examples/quickstart.sh [OUTPUT_DIR]      default: runs/quickstart in this checkout
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
out=${1:-$root/runs/quickstart}
vlaprobe=$root/bin/vlaprobe
if [ ! -x "$vlaprobe" ]; then
  commit=$(git -C "$root" rev-parse HEAD 2>/dev/null || true)
  made=
  for made_of in "$root"/build/bundle/*/COMMIT; do
    if [ -n "$commit" ] && [ -f "$made_of" ] && [ "$(cat "$made_of")" = "$commit" ]; then made=$made_of; fi
  done
  if [ -n "$made" ]; then
    vlaprobe=$(dirname "$made")/bin/vlaprobe
  else
    "$root/.ci/install"
    "$root/.ci/build" vlaprobe
    vlaprobe=$root/build/vlaprobe
  fi
fi
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
