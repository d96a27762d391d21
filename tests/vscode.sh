#!/bin/sh
# The extension in a real VS Code: the workbench and the host of extensions of npm's `code-server`, in a headless Chromium. Types, mends,
# completes, lays out, hovers, renames and runs a lens, and leaves pictures in FOLDER/pictures. No part of the other tests: what it needs is
# large, and it takes two minutes.
#   tests/vscode.sh FOLDER           where FOLDER has no code-server it says so, and nothing else is done
#   tests/vscode.sh FOLDER --fetch   brings it from npm first, some 250 MB
set -eu
[ $# -ge 1 ] || { sed -n '2,6s/^# \{0,1\}//p' "$0"; exit 2; }
folder=$(realpath -m "$1")
shift
cd "$(dirname "$0")/.."
cmake --build build --target vlaprobe vscode_extension report_page/node_modules/.package-lock.json >/dev/null
exec node tests/vscode.mjs build/vscode/probe-language.vsix build/vlaprobe "$folder" "$@"
