#!/usr/bin/env python3
"""A wheel of a folder that `cmake --install` filled: the standard library alone, and the same bytes of the same files.

    wheel.py FOLDER --name vlaprobe --version 0.1.0 --tag cp311-cp311-linux_x86_64 --license LICENSE --requires numpy -o DIR
"""

import argparse
import base64
import hashlib
import os
import zipfile

SUMMARY = {
    "vlaprobe": "Probing tasks for vision-language-action policies: compile, step, evaluate, read results",
    "lerobot_env_vlaprobe": "vlaprobe's tasks in LeRobot: --env.type=vlaprobe",
}


def files_of(folder: str, package: str) -> dict:
    """By name within the wheel, sorted, the package's files."""
    found = {}
    for path, folders, names in os.walk(os.path.join(folder, package)):
        folders[:] = [name for name in folders if name != "__pycache__"]
        for name in names:
            full = os.path.join(path, name)
            with open(full, "rb") as file:
                found[os.path.relpath(full, folder).replace(os.sep, "/")] = file.read()
    if not found:
        raise SystemExit(f"{folder} holds no package {package}: `cmake --install BUILD --component python --prefix {folder}`")
    return dict(sorted(found.items()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--name", required=True)
    parser.add_argument("--version", required=True)
    parser.add_argument("--tag", required=True)
    parser.add_argument("--license", required=True)
    parser.add_argument("--requires", action="append", default=[])
    parser.add_argument("-o", "--out", required=True)
    given = parser.parse_args()
    stem = f"{given.name}-{given.version}"
    info = f"{stem}.dist-info/"
    files = files_of(given.folder, given.name)
    # Of one Python and one machine where it holds a library of it.
    is_pure = given.tag.endswith("-none-any")
    metadata = [
        "Metadata-Version: 2.1",
        f"Name: {given.name}",
        f"Version: {given.version}",
        f"Summary: {SUMMARY[given.name]}",
        "License-File: LICENSE",
        "Requires-Python: >=3.9",
        *(f"Requires-Dist: {name}" for name in given.requires),
    ]
    with open(given.license, "rb") as file:
        files[info + "LICENSE"] = file.read()
    files[info + "METADATA"] = "\n".join(metadata + [""]).encode()
    wheel = ["Wheel-Version: 1.0", "Generator: vlaprobe", f"Root-Is-Purelib: {str(is_pure).lower()}", f"Tag: {given.tag}", ""]
    files[info + "WHEEL"] = "\n".join(wheel).encode()
    record = ""
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[info + "RECORD"] = (record + info + "RECORD,,\n").encode()
    os.makedirs(given.out, exist_ok=True)
    path = os.path.join(given.out, f"{stem}-{given.tag}.whl")
    with zipfile.ZipFile(path + ".tmp", "w", zipfile.ZIP_DEFLATED, compresslevel=6) as out:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if ".so" in os.path.basename(name) else 0o100644) << 16
            out.writestr(entry, data)
    os.replace(path + ".tmp", path)


if __name__ == "__main__":
    main()
