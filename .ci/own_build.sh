# Sourced by NAME_source, each of which builds a library of its own from Debian's source package. Kept in ~/.cache/vlaprobe,
# one folder for each version, flags and compiler, which the name of the folder has as a hash.
#   own_build_named NAME VERSION KEY...   sets $out, that folder, $cache and $work
#   own_build_is_there                    whether it is built
#   own_build_begin [OPTION]              prints it and ends the script if so; else the source is in $work/source. OPTION: as debian_source's
#   own_build_end [LINE...]               says that it is whole, in lines that tell of what it is, and prints it
own_build_named() {
  name=$1 version=$2
  local key
  key=$(printf '%s\n' "${@:2}" | sha256sum | cut -c1-12)
  cache=${XDG_CACHE_HOME:-$HOME/.cache}/vlaprobe
  out=$cache/$name-${version#*:}-$key
  work=$cache/$name-work
}
own_build_is_there() { [ -f "$out/complete" ]; }
own_build_begin() {
  if own_build_is_there; then echo "$out"; exit 0; fi
  # One build at a time; a second caller waits and finds the result.
  mkdir -p "$cache"
  exec 9>"$cache/$name.lock"
  flock 9
  if own_build_is_there; then echo "$out"; exit 0; fi
  rm -rf "$work" "$out"
  "$here/debian_source" "$@" "$name" "$version" "$work"
}
own_build_end() {
  cd /
  printf '%s\n' "$@" >"$out/complete"
  rm -rf "$work"
  echo "$out"
}
