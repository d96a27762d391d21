#!/usr/bin/env python3
"""tests/reach/reach.py VLAPROBE [--libero BDDL_FOLDER] [--arena BDDL_FOLDER] [--plus FOLDER] [--colosseum FOLDER] [--google JSON]
[-o FILE]: which tasks of other benchmarks Probe can say, counted over their released files.

A construct counts as there when the text of constructs.py that uses it compiles; a task when all that it is made of is there.
What a task needs is read from its files: BDDL files, LIBERO-plus' task_classification.json beside its bddl_files, COLOSSEUM's classes
and tables of variations, SimplerEnv's list of Google tasks. Words and meshes are not looked at."""
import argparse
import collections
import glob
import json
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import bddl
import others
from constructs import CONSTRUCTS, PRELUDE

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
STARTS = "start,object,x_m,y_m,z_m,qw,qx,qy,qz\n" + "".join(
    f"{start},{role},{x},{0.05 * start},0.95,1,0,0,0\n" for start in range(2) for role, x in (("source", -0.25), ("target", -0.05)))


def compiles(vlaprobe, text):
    """Whether `check` finds no error, and the first that it finds."""
    if text is None:
        return False, "not simulated"
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "starts.csv"), "w") as file:
            file.write(STARTS)
        path = os.path.join(folder, "t.probe")
        with open(path, "w") as file:
            file.write(PRELUDE.format(suite=os.path.join(ROOT, "suite")) + text)
        done = subprocess.run([vlaprobe, "check", path, "--assets", os.path.join(ROOT, "assets"), "--std", os.path.join(ROOT, "dsl")],
                              capture_output=True, text=True)
        error = next((line for line in done.stderr.splitlines() if line.startswith("error")), "")
        return done.returncode == 0, error


def read(path):
    with open(path, errors="replace") as file:
        return file.read()


def bddl_tasks(folder):
    return [(os.path.relpath(path, folder)[:-5], bddl.keys_of(read(path)))
            for path in sorted(glob.glob(os.path.join(folder, "**", "*.bddl"), recursive=True))]


def plus_tasks(folder):
    bddls = os.path.join(folder, "libero", "libero", "bddl_files")
    known = {os.path.basename(name): keys for name, keys in bddl_tasks(bddls)}
    # A perturbed task's file has its base's goal and start; those without a file of their own end in the perturbation.
    def base(_, name):
        parts = name.split("_")
        for end in range(len(parts), 0, -1):
            if "_".join(parts[:end]) in known:
                return known["_".join(parts[:end])]
        return {"unknown: " + name}
    return [(f"{suite}/{name}", keys) for suite, name, keys in
            others.plus_tasks(os.path.join(folder, "libero", "libero", "benchmark", "task_classification.json"), base)]


def colosseum_tasks(folder):
    tasks = []
    for path in sorted(glob.glob(os.path.join(folder, "colosseum", "rlbench", "tasks", "*.py"))):
        name = os.path.basename(path)[:-3]
        table = os.path.join(folder, "colosseum", "assets", "json", name + ".json")
        if name == "__init__":
            continue
        kinds = {v["type"] for s in json.loads(read(table))["strategy"] for v in s["variations"] if v.get("enabled", True)}
        tasks.append((name, others.colosseum_keys(read(path), kinds)))
    return tasks


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("vlaprobe")
    for name in ("libero", "arena", "plus", "colosseum", "google"):
        parser.add_argument("--" + name)
    parser.add_argument("-o", "--out")
    args = parser.parse_args()
    sets = []
    if args.libero:
        sets.append(("LIBERO", bddl_tasks(args.libero)))
    if args.arena:
        sets.append(("VLA-Arena", bddl_tasks(args.arena)))
    if args.google:
        names = json.loads(read(args.google))["prepackaged_names"]
        sets.append(("SimplerEnv, Google robot", [(name, others.google_keys(name)) for name in names]))
    if args.colosseum:
        sets.append(("COLOSSEUM", colosseum_tasks(args.colosseum)))
    if args.plus:
        sets.append(("LIBERO-plus", plus_tasks(args.plus)))

    there = {key: compiles(args.vlaprobe, text) for key, (_, text) in CONSTRUCTS.items()}
    for key, (ok, error) in there.items():
        if not ok:
            print(f"lacks {key}: {error}", file=sys.stderr)

    def lacks(keys):
        return sorted(key for key in keys if not there.get(key, (False, ""))[0])

    lines = ["# What Probe can say of other benchmarks' tasks", "",
             "Made by `tests/reach/reach.py` from the released files. A construct is there when a text that uses it compiles; a task can be",
             "said when all that it is made of is there. Words and meshes are not looked at, nor whether a policy would see the same picture.", "",
             "| benchmark | tasks | can be said | what the others lack |", "|---|---:|---:|---|"]
    for name, tasks in sets:
        reasons = collections.Counter("; ".join(CONSTRUCTS[k][0] if k in CONSTRUCTS else k for k in lacks(keys))
                                      for _, keys in tasks if lacks(keys))
        told = "; ".join(f"{count}: {why}" for why, count in reasons.most_common(6))
        lines.append(f"| {name} | {len(tasks)} | {sum(not lacks(keys) for _, keys in tasks)} | {told} |")
    lines += ["", "| construct | " + " | ".join(name for name, _ in sets) + " | there |", "|---|" + "---:|" * len(sets) + "---|"]
    for key, (words, _) in CONSTRUCTS.items():
        counts = [sum(key in keys for _, keys in tasks) for _, tasks in sets]
        lines.append(f"| {words} | " + " | ".join(map(str, counts)) + f" | {'yes' if there[key][0] else 'no'} |")
    text = "\n".join(lines) + "\n"
    if args.out:
        with open(args.out, "w") as file:
            file.write(text)
    else:
        print(text)


if __name__ == "__main__":
    main()
