#!/usr/bin/env bash
# tests/reproducible.sh: two clones of this commit in folders of other names and lengths, each built without ccache and bundled by
# .ci/bundle, and held against each other file by file. Takes as long as two builds from nothing (30 minutes on two idle cores), so it
# is no part of the other tests. Exit 0: equal bytes.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-reproducible-XXXXXX")
trap 'rm -rf "$work"' EXIT
commit=$(git -C "$here" rev-parse HEAD)
for copy in a another/place/of/a/longer/name; do
  git clone -q "$here" "$work/$copy"
  git -C "$work/$copy" checkout -q "$commit"
  CCACHE_DISABLE=1 nice -n 10 "$work/$copy/.ci/bundle" >/dev/null
done
made() { (cd "$work/$1/build/bundle" && find vlaprobe-*-linux-*/ install.sh ./*.tar.zst -type f -exec sha256sum {} + | sort -k 2); }
made a >"$work/first"
made another/place/of/a/longer/name >"$work/second"
if ! diff "$work/first" "$work/second"; then
  echo "these files differ between two builds of $commit" >&2
  exit 1
fi
echo "$(wc -l <"$work/first") files of $commit, twice the same"
