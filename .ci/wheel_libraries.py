#!/usr/bin/env python3
"""Puts beside a library all others that it needs and no Linux promises, so that a wheel of it may be called manylinux.

    wheel_libraries.py FOLDER [--look-in FOLDER:FOLDER..]     prints the platform tag, manylinux_2_36_x86_64

FOLDER is a package's folder of libraries. As auditwheel does it (PEP 600): libraries of the C library and the compiler stay
the system's; each other is copied, is found from its own folder alone and has a hash in its name, so that no other package's of
the same name takes its place in the process. The tag is of the C library whose symbols all of them together ask for.
"""

import argparse
import hashlib
import os
import platform
import re
import shutil
import subprocess

# Of every system that a manylinux tag speaks of, in one ABI.
PROMISED = re.compile(r"^(ld-linux-x86-64|libc|libm|libmvec|libdl|librt|libpthread|libutil|libgcc_s|libstdc\+\+)\.so\.\d+$")
# What a system of glibc 2.N has of the compiler's: policies of auditwheel.
COMPILER = {"GLIBCXX": {31: (3, 4, 28), 34: (3, 4, 29), 35: (3, 4, 30), 36: (3, 4, 30)}, "CXXABI": {31: (1, 3, 12), 34: (1, 3, 13), 35: (1, 3, 13), 36: (1, 3, 13)}}


def said(*words: str, **more) -> str:
    return subprocess.run(words, check=True, capture_output=True, text=True, **more).stdout


def numbers(version: str) -> tuple:
    return tuple(int(part) for part in version.split("."))


def needed(path: str) -> list:
    return said("patchelf", "--print-needed", path).split()


def asked_of(path: str) -> set:
    """(whose, version) of the symbols that a file wants of others."""
    wants = said("readelf", "--version-info", "--wide", path).partition("Version needs section")[2]
    return {(whose, numbers(version)) for whose, version in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI)_([0-9.]+)\b", wants)}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--look-in", default="")
    given = parser.parse_args()
    own = sorted(os.path.join(given.folder, name) for name in os.listdir(given.folder))
    environment = dict(os.environ, LD_LIBRARY_PATH=given.look_in, LC_ALL="C")
    found = {}
    for path in own:
        listing = said("ldd", path, env=environment)
        if "not found" in listing:
            raise SystemExit(f"{path} needs what is not here:\n{listing}")
        found |= dict(re.findall(r"^\t(\S+) => (/\S+) ", listing, re.M))
    taken = {soname: os.path.realpath(path) for soname, path in sorted(found.items()) if not PROMISED.match(soname)}
    names = {}
    for soname, path in taken.items():
        with open(path, "rb") as file:
            digest = hashlib.sha256(file.read()).hexdigest()[:8]
        stem, _, rest = soname.partition(".so")
        names[soname] = f"{stem}-{digest}.so{rest}"
        copy = os.path.join(given.folder, names[soname])
        subprocess.run(["strip", "--strip-unneeded", "-o", copy, path], check=True)
        os.chmod(copy, 0o755)
    all_files = own + [os.path.join(given.folder, name) for name in names.values()]
    # One change a call: several at once leave some of them out.
    for path in all_files:
        if os.path.basename(path) in names.values():
            subprocess.run(["patchelf", "--set-soname", os.path.basename(path), path], check=True)
        for soname in needed(path):
            if soname in names:
                subprocess.run(["patchelf", "--replace-needed", soname, names[soname], path], check=True)
        subprocess.run(["patchelf", "--force-rpath", "--set-rpath", "$ORIGIN", path], check=True)
    wanted = set().union(*(asked_of(path) for path in all_files))
    minor = max(version[1] for whose, version in wanted if whose == "GLIBC")
    for whose, limits in COMPILER.items():
        has = max(limit for least, limit in limits.items() if least <= minor)
        most = max(version for name, version in wanted if name == whose)
        if most > has:
            raise SystemExit(f"{whose} {most} is asked for, and systems of glibc 2.{minor} have {has}")
    print(f"manylinux_2_{minor}_{platform.machine()}")


if __name__ == "__main__":
    main()
