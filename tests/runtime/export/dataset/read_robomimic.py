"""A robomimic file as h5py sees it, as one JSON object: python3 read_robomimic.py FILE.

Pictures are given as the SHA-256 of each frame's bytes, in hex.
"""
import hashlib
import json
import sys

import h5py

with h5py.File(sys.argv[1], "r", swmr=True, libver="latest") as file:
    data = file["data"]
    out = {"total": int(data.attrs["total"]), "env_args": json.loads(data.attrs["env_args"]), "demos": [], "mask": {}}
    for name in sorted(data.keys(), key=lambda demo: int(demo[5:])):
        demo = data[name]
        pictures = {}
        for key, values in demo["obs"].items():
            if values.dtype == "uint8":
                pictures[key] = [hashlib.sha256(frame.tobytes()).hexdigest() for frame in values[()]]
        out["demos"].append({
            "num_samples": int(demo.attrs["num_samples"]),
            "ep_meta": json.loads(demo.attrs["ep_meta"]),
            "actions": demo["actions"][()].tolist(),
            "rewards": demo["rewards"][()].tolist(),
            "dones": demo["dones"][()].tolist(),
            "joints": demo["obs/joints"][()].tolist(),
            "pictures": pictures,
        })
    for key, values in file["mask"].items():
        out["mask"][key] = [name.decode("utf-8") for name in values[()]]
json.dump(out, sys.stdout)
