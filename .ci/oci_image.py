"""oci_image.py FOLDER --version V --created SECONDS -o FILE: an OCI image (image-spec 1.0: a layout in a tar) whose only
layer is FOLDER as /opt/vlaprobe, with a /tmp. Nothing of it depends on when or by whom it is made."""
import argparse
import datetime
import gzip
import hashlib
import io
import json
import os
import platform
import tarfile

ARCHITECTURES = {"x86_64": "amd64", "aarch64": "arm64"}


def entry(name, created, mode, kind=tarfile.REGTYPE):
    info = tarfile.TarInfo(name)
    info.mtime, info.mode, info.type = created, mode, kind
    return info


def layer(folder, created):
    """The uncompressed tar: everything sorted, owned by root."""
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode="w", format=tarfile.GNU_FORMAT) as tar:
        tar.addfile(entry("tmp", created, 0o1777, tarfile.DIRTYPE))
        tar.addfile(entry("opt", created, 0o755, tarfile.DIRTYPE))
        for place, folders, files in os.walk(folder):
            folders.sort()
            inside = os.path.join("opt/vlaprobe", os.path.relpath(place, folder)).removesuffix("/.")
            tar.addfile(entry(inside, created, 0o755, tarfile.DIRTYPE))
            for name in sorted(files):
                path = os.path.join(place, name)
                info = entry(f"{inside}/{name}", created, 0o755 if os.access(path, os.X_OK) else 0o644)
                info.size = os.path.getsize(path)
                with open(path, "rb") as file:
                    tar.addfile(info, file)
    return out.getvalue()


def sha256(data):
    return "sha256:" + hashlib.sha256(data).hexdigest()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--version", required=True)
    parser.add_argument("--created", type=int, required=True)
    parser.add_argument("-o", "--out", required=True)
    options = parser.parse_args()
    plain = layer(options.folder, options.created)
    packed = gzip.compress(plain, 6, mtime=options.created)
    blobs = {sha256(packed): packed}

    def stored(kind, value):
        data = json.dumps(value, sort_keys=True).encode()
        blobs[sha256(data)] = data
        return {"mediaType": f"application/vnd.oci.image.{kind}.v1+json", "digest": sha256(data), "size": len(data)}

    path = "/opt/vlaprobe/bin"
    created = datetime.datetime.fromtimestamp(options.created, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")
    config = stored("config", {
        "created": created,
        "architecture": ARCHITECTURES[platform.machine()],
        "os": "linux",
        "config": {"Entrypoint": [f"{path}/vlaprobe"], "Env": [f"PATH={path}"], "WorkingDir": "/tmp",
                   "Labels": {"org.opencontainers.image.title": "vlaprobe",
                              "org.opencontainers.image.version": options.version}},
        "rootfs": {"type": "layers", "diff_ids": [sha256(plain)]},
        "history": [{"created": created, "created_by": "vlaprobe .ci/package oci"}]})
    manifest = stored("manifest", {
        "schemaVersion": 2, "mediaType": "application/vnd.oci.image.manifest.v1+json", "config": config,
        "layers": [{"mediaType": "application/vnd.oci.image.layer.v1.tar+gzip", "digest": sha256(packed),
                    "size": len(packed)}]})
    manifest["annotations"] = {"org.opencontainers.image.ref.name": options.version}
    index = {"schemaVersion": 2, "mediaType": "application/vnd.oci.image.index.v1+json", "manifests": [manifest]}
    with tarfile.open(options.out + ".part", "w", format=tarfile.GNU_FORMAT) as tar:
        def add(name, data):
            info = entry(name, options.created, 0o644)
            info.size = len(data)
            tar.addfile(info, io.BytesIO(data))
        add("oci-layout", b'{"imageLayoutVersion": "1.0.0"}')
        add("index.json", json.dumps(index, sort_keys=True).encode())
        for digest, data in sorted(blobs.items()):
            add("blobs/sha256/" + digest.removeprefix("sha256:"), data)
    os.replace(options.out + ".part", options.out)
    print(options.out)


if __name__ == "__main__":
    main()
