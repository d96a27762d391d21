#!/usr/bin/env bash
# tests/bundle.sh [ROOT ...]: makes the bundle, installs it in a folder with a space and letters of other scripts, and
# holds what it computes against the build's. With ROOTs, folders with a bare system each (debootstrap --variant=minbase),
# the same in each: as an ordinary user, without network, installed by its own install.sh. Last line: N passed, N failed.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
VLAPROBE_BUNDLE_LEVEL=${VLAPROBE_BUNDLE_LEVEL:-3} "$here/.ci/bundle" >/dev/null
made=$here/build/bundle
name=$(cd "$made" && ls vlaprobe-*.tar.zst) && name=${name%.tar.zst}
work=$(mktemp -d "${TMPDIR:-/tmp}/vlaprobe-bundle-XXXXXX")
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
passed=0 failed=0
# check SENTENCE COMMAND...: of the output of what fails, the end is shown.
check() {
  local sentence=$1
  shift
  if "$@" >"$work/log" 2>&1; then passed=$((passed + 1)); else
    failed=$((failed + 1))
    echo "FAILED: $sentence"
    tail -n 20 "$work/log"
  fi
}
episodes() { # VLAPROBE SUITE OUT
  "$1" run "$2" --tasks carrot_on_plate --episodes 0-1 --policy expert --video all -o "$3" &&
    "$1" replay "$3" carrot_on_plate 1 --verify
}
hashes() { "$here/build/vlaprobe" results "$1" --json | grep -E '"(trace|image|frames)_sha256"'; }

"$here/.ci/build" vlaprobe
check "the build runs two episodes" episodes "$here/build/vlaprobe" "$here/suite/intact.probe" "$work/built"
check "the checkout's quickstart goes on where no bundle is of its commit" "$here/examples/quickstart.sh" "$work/quick"
prefix="$work/a place für 試"
check "install.sh installs beside others" bash "$made/install.sh" --prefix "$prefix"
check "installing once more replaces it" bash "$made/install.sh" --prefix "$prefix"
check "nothing but the folder is left" test "$(ls -A "$prefix")" = "$name"
bundle=$prefix/$name
check "another machine's kind is refused" bash -c '! PATH="$1:$PATH" bash "$2/install.sh" --prefix "$3"' - \
  "$(mkdir -p "$work/arm" && printf '#!/bin/sh\n[ "$1" = -m ] && echo aarch64 || echo Linux\n' >"$work/arm/uname" && chmod +x "$work/arm/uname" && echo "$work/arm")" \
  "$made" "$work/no"
chmod -R a-w "$bundle"
ln -s "$bundle/bin/vlaprobe" "$work/linked"
check "a link from elsewhere starts it, from a read-only folder and without an environment" \
  env -i -C / "$work/linked" check "$bundle/suite/intact.probe"
check "it runs two episodes" episodes "$work/linked" "$bundle/suite/intact.probe" "$work/bundled"
check "its traces and pictures are the build's" cmp <(hashes "$work/built") <(hashes "$work/bundled")
check "its videos are the build's" bash -c 'cd "$1/built/videos" && find . -name "*.mp4" -exec cmp {} "$1/bundled/videos/"{} \; | (! grep .)' - "$work"
check "its golden pictures are identical" bash -c '"$1" doctor | grep "golden pictures *\([0-9]*\) of \1 identical"' - "$work/linked"
check "demo writes its report" "$work/linked" demo -o "$work/demo"
check "every library has its licence" bash -c 'cd "$1" && ls lib | while read -r file; do grep -q "^lib/$file " LICENSES/packages.txt || exit 1; done' - "$bundle"
check "every package of the pages has its licence" bash -c 'cd "$1/LICENSES" && for name in monaco-editor echarts zrender tslib fontsource-variable-inter; do
  grep -q "^programs/ npm-$name " packages.txt && [ -s "npm-$name" ] || exit 1; done' - "$bundle"
check "the studio serves its page" python3 -c 'import subprocess, sys, urllib.request
studio = subprocess.Popen([sys.argv[1], "studio", sys.argv[2] + "/my.probe"], stdout=subprocess.PIPE, text=True)
try:
    page = studio.stdout.readline().strip()
    assert len(urllib.request.urlopen(page + "page.js").read()) > 500000
finally:
    studio.terminate()' "$work/linked" "$work"
check "no file names where it was built" bash -c '! grep -rlF "$1" "$2"' - "$here" "$bundle"

# The same bytes also where the clock is behind the commit's, and whether or not the disk has written the folder.
stamp=$(cat "$made/stamp")
echo $(($(date +%s) + 86400)) >"$made/stamp"
images() { (cd "$made" && VLAPROBE_DEB_LEVEL=0 "$here/.ci/package" deb oci && sha256sum ./*.deb ./*.oci.tar); }
check "packages are made" images
cp "$work/log" "$work/first"
sync
check "packages are made again" images
cp "$work/log" "$work/second"
check "and have the same bytes" cmp "$work/first" "$work/second"
echo "$stamp" >"$made/stamp"
check "the image of the commit's time is made" images

# The wheel for other systems: nothing that it loads is this system's but what every system has.
check "the wheel is made" "$here/.ci/package" wheel
in_wheel() {
  /usr/bin/python3 -m venv --system-site-packages "$work/env" && # that has numpy, for which the wheel is made
    "$work/env/bin/pip" install -q --no-index --no-deps "$made"/vlaprobe-*-manylinux_*.whl &&
    (cd / && env -u PYTHONPATH "$work/env/bin/python" - "$work/wheel_run" <<'END'
import os, re, sys, numpy, ssl, sqlite3
promised = re.compile(r"^(ld-linux-x86-64|libc|libm|libmvec|libdl|librt|libpthread|libutil|libgcc_s|libstdc\+\+)\.so")
loaded = lambda: {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
before = loaded()
import vlaprobe
vlaprobe.evaluate("expert", vlaprobe.compile(vlaprobe.suite_file()), tasks="carrot_on_plate", episodes=(0, 1), out=sys.argv[1], progress=False)
odd = [path for path in loaded() - before if "/vlaprobe/" not in path and "/lib-dynload/" not in path and not promised.match(os.path.basename(path))]
assert not odd, odd
END
    )
}
check "it runs two episodes with libraries of its own" in_wheel
check "its traces and pictures are the build's" cmp <(hashes "$work/built") <(hashes "$work/wheel_run")

# The image holds nothing but the folder: no shell, no system.
unpack() { # the image's layers into $work/image
  python3 - "$made/$name.oci.tar" "$work/image" <<'END'
import io, json, sys, tarfile
image = tarfile.open(sys.argv[1])
def blob(digest):
    return image.extractfile("blobs/" + digest.replace(":", "/")).read()
manifest = json.loads(blob(json.load(image.extractfile("index.json"))["manifests"][0]["digest"]))
for layer in manifest["layers"]:
    tarfile.open(fileobj=io.BytesIO(blob(layer["digest"]))).extractall(sys.argv[2])
END
}
check "the image is unpacked" unpack
if [ "$(id -u)" -eq 0 ]; then
  mkdir -p "$work/image/proc"
  check "its program runs with nothing beside it" unshare --mount --pid --fork bash -c 'mount -t proc proc "$0/proc" &&
    exec chroot --userspec=1000:1000 "$0" /opt/vlaprobe/bin/vlaprobe demo -o /tmp/demo' "$work/image"
fi

for root in "$@"; do
  rm -rf "$root/home/guest" && mkdir -p "$root/home/guest"
  cp "$made/$name.tar.zst" "$made/install.sh" "$root/home/guest/"
  chown -R 1000:1000 "$root/home/guest"
  # No network but the loopback that is its own, processes of its own.
  inside=(unshare --net --mount --pid --fork bash -c 'mount -t proc proc "$0/proc" && ip link set lo up &&
    exec chroot --userspec=1000:1000 "$0" env -i HOME=/home/guest PATH=/usr/bin:/bin "$@"' "$root")
  system=$(. "$root/etc/os-release"; echo "$PRETTY_NAME")
  called=/home/guest/.local/share/$name/bin/vlaprobe
  cp "$made"/vlaprobe_*.deb "$root/tmp/vlaprobe.deb"
  check "$system: the package is installed" chroot "$root" dpkg -i /tmp/vlaprobe.deb
  check "$system: the package's program runs" "${inside[@]}" vlaprobe check /usr/lib/vlaprobe/suite/intact.probe
  check "$system: the package is removed" chroot "$root" dpkg -P vlaprobe
  check "$system: and nothing of it is left" test ! -e "$root/usr/lib/vlaprobe"
  check "$system: install.sh" "${inside[@]}" bash /home/guest/install.sh
  check "$system: demo" "${inside[@]}" "$called" demo -o /home/guest/demo
  check "$system: quickstart without a build" "${inside[@]}" bash "/home/guest/.local/share/$name/examples/quickstart.sh" /home/guest/quickstart
  check "$system: two episodes, replayed" "${inside[@]}" bash -c "
    $called run /home/guest/.local/share/$name/suite/intact.probe --tasks carrot_on_plate --episodes 0-1 --policy expert --video all -o /home/guest/run &&
    $called replay /home/guest/run carrot_on_plate 1 --verify"
  check "$system: the build's traces and pictures" cmp <(hashes "$work/built") <(hashes "$root/home/guest/run")
  check "$system: a served policy" "${inside[@]}" bash -c "
    $called serve --policy null --port 8731 & server=\$!
    sleep 2
    $called run /home/guest/.local/share/$name/suite/intact.probe --tasks carrot_on_plate --episodes 0-1 --policy openpi://127.0.0.1:8731 -o /home/guest/served
    status=\$?; kill \$server; exit \$status"
done
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
