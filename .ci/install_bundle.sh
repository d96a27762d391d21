#!/bin/bash
# install.sh [--prefix DIR]: unpacks @NAME@.tar.zst, which lies beside it, into DIR (default: ~/.local/share) and says
# how it is called. Nothing else is touched. What follows the last line is a program that unpacks.
set -euo pipefail
unset CDPATH
name=@NAME@
prefix=${XDG_DATA_HOME:-${HOME:-}/.local/share}
while [ $# -gt 0 ]; do
  case $1 in
    --prefix) [ $# -ge 2 ] || { echo "--prefix wants a folder" >&2; exit 1; }; prefix=$2; shift 2 ;;
    --prefix=*) prefix=${1#--prefix=}; shift ;;
    *) echo "usage: bash install.sh [--prefix DIR]" >&2; exit 1 ;;
  esac
done
[ -n "$prefix" ] && [ "$prefix" != /.local/share ] || { echo "there is no home folder; say --prefix DIR" >&2; exit 1; }
case $prefix in *[:\;]*) echo "a folder with \`:\` or \`;\` in its name cannot hold it: $prefix" >&2; exit 1 ;; esac
archive=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/$name.tar.zst
machine=${name##*-linux-}
[ "$(uname -s)-$(uname -m)" = "Linux-$machine" ] ||
  { echo "this is for Linux on $machine, and here is $(uname -s) on $(uname -m)" >&2; exit 2; }
[ -r "$archive" ] || { echo "is not beside install.sh: $archive" >&2; exit 2; }
mkdir -p "$prefix" || exit 2
prefix=$(cd "$prefix" && pwd)
# Beside its place and then moved there: what is killed half way leaves no half.
work=$(mktemp -d "$prefix/.vlaprobe-XXXXXX") || exit 2
# The old one is put back where the new one did not come to its place.
leave() {
  if [ -e "$work/old" ] && [ ! -e "$prefix/$name" ]; then mv -T "$work/old" "$prefix/$name"; fi
  rm -rf "$work"
}
trap leave EXIT
tail -n 1 "${BASH_SOURCE[0]}" | base64 -d >"$work/unzstd"
chmod +x "$work/unzstd"
"$work/unzstd" <"$archive" | tar -xf - -C "$work" ||
  { echo "cannot be unpacked into $prefix" >&2; exit 2; }
"$work/$name/bin/vlaprobe" --version >/dev/null || { echo "does not run here" >&2; exit 2; }
if [ -e "$prefix/$name" ]; then mv -T "$prefix/$name" "$work/old"; fi
mv -T "$work/$name" "$prefix/$name" || { echo "cannot be put into $prefix" >&2; exit 2; }
printf 'export PATH=%q:$PATH   # then: vlaprobe demo\n' "$prefix/$name/bin"
exit 0
