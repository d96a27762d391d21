#!/usr/bin/env python3
"""power_cut.py [--cuts N] [--seed S] [--forget SUFFIX] [--build DIR] [VERB..]: cuts the power N times (100) over each of `run`, `merge`,
`sweep`, `ask`, `table` and `dataset` (`export` of either), at a random one of the calls that force something to the disk, and looks at
what a machine would find when it is switched on again: in one half of the cuts nothing that was not forced, in the other any of it.
Then the verb goes on. Held each time: what is there is read, no row lacks its trace, what has the name of an export is whole, and in
the end the rows or bytes are those of one that nobody disturbed.
--forget .trace plants a mistake, files that are not forced, which has to be found: exit 0 then means that it was."""

import argparse
import hashlib
import json
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent.parent.parent


class Found(Exception):
    pass


class Disk:
    """A folder, and of it what was forced to the disk."""

    def __init__(self, work, library):
        self.root, self.kept, self.library = work / "disk", work / "kept", library
        self.root.mkdir()
        self.settle()

    def settle(self):
        """All that is there now is on the disk."""
        shutil.rmtree(self.kept, ignore_errors=True)
        self.kept.mkdir()
        paths = [self.root, *self.root.rglob("*")]
        script = "import os, sys\nfor path in sys.stdin.read().split('\\0'): os.fsync(os.open(path, os.O_RDONLY))"
        # One process a few hundred: it keeps the files open.
        for i in range(0, len(paths), 400):
            subprocess.run([sys.executable, "-c", script], input="\0".join(map(str, paths[i:i + 400])), text=True, check=True,
                           env=self.environment())

    def environment(self, **more):
        return {**os.environ, "LD_PRELOAD": str(self.library), "PROBE_DISK": str(self.root), "PROBE_KEPT": str(self.kept), **more}

    def names(self, key):
        listed = self.kept / f"names {key}"
        lines = listed.read_text().splitlines() if listed.exists() else []
        return {name: (kind, of) for kind, of, name in (line.split(" ", 2) for line in lines)}

    def found(self, key, now, to, draw):
        """Makes in `to` what is found of a folder that has the number `key` and is `now` as it would have been without the cut.
        `draw`: whether something that was not forced is there all the same."""
        to.mkdir()
        forced = self.names(key)
        there = {path.name: path for path in now.iterdir()} if now is not None and now.is_dir() else {}
        for name in sorted(forced.keys() | there.keys()):
            kind, of = forced.get(name, (None, None))
            path = there.get(name)
            if kind is None and not draw():
                continue  # a new name
            if kind is not None and path is None and draw():
                continue  # a name that was taken away
            is_folder = kind == "d" if kind is not None else path.is_dir()
            if is_folder:
                self.found(of or self.number(path), path, to / name, draw)
                continue
            if of is None or (path is not None and draw()):
                of = self.number(path)
                if draw():
                    shutil.copyfile(path, to / name)
                    continue
            bytes_of = self.kept / f"bytes {of}"
            (to / name).write_bytes(bytes_of.read_bytes() if bytes_of.exists() else b"")

    def number(self, path):
        said = subprocess.run(["stat", "-c", "%i %.9W", path], capture_output=True, text=True, check=True).stdout.split()
        seconds, _, nanoseconds = said[1].partition(".")
        return f"{said[0]}-{seconds}.{int(nanoseconds or 0)}"

    def cut(self, chance):
        to = self.root.parent / "found"
        self.found(self.number(self.root), self.root, to, lambda: random.random() < chance)
        shutil.rmtree(self.root)
        to.rename(self.root)
        self.settle()


def rows_of(program, folder):
    said = subprocess.run([program, "results", folder, "--json"], capture_output=True, text=True)
    if said.returncode != 0 or said.stderr.strip():
        raise Found(f"`results` says: {said.stderr.strip()[-600:]}")
    rows = json.loads(said.stdout)
    for row in rows:
        if isinstance(row, dict):
            row.pop("trace", None)
    return sorted(json.dumps(row, sort_keys=True) for row in rows)


class Rows:
    """A verb that makes one run's folder, or answers; with `parts` a folder of such."""

    def __init__(self, program, words, parts=("",), most=40):
        self.program, self.words, self.parts, self.most = program, words, parts, most

    def look(self, out):
        """What a cut left is read."""
        for part in self.parts:
            if not any((out / part / name).exists() for name in ("results.sqlite", "answers.sqlite")):
                continue
            try:
                rows_of(self.program, out / part)
            except Found as found:
                # A database that was not made yet is told, and the verb begins it.
                if not any(words in str(found) for words in ("was cut off as it began", "no run here:", "no answers here:")):
                    raise

    def content(self, out):
        return [row for part in self.parts for row in rows_of(self.program, out / part)]

    def begin_anew(self, out):
        shutil.rmtree(out)


class Export:
    """A file, or a folder of a dataset: whole where it has its name. `most`: of its calls that force something."""

    def __init__(self, program, words, check, most):
        self.program, self.words, self.check, self.most = program, words, check, most

    def look(self, out):
        if not out.exists():
            return
        is_half = out.is_dir() and not (out / "meta/info.json").exists()
        if not is_half:
            said = subprocess.run([self.program, "export", "--check", out, *self.check], capture_output=True, text=True)
            if said.returncode != 0:
                raise Found(f"what has the name of an export does not hold: {said.stderr.strip()[-600:]}")
        if out.is_dir():  # half or whole, a folder that is there is not written into
            shutil.rmtree(out)

    def content(self, out):
        files = [path for path in sorted(out.rglob("*")) if path.is_file()] if out.is_dir() else [out]
        return [f"{path.relative_to(out)} {hashlib.sha256(path.read_bytes()).hexdigest()}" for path in files]

    def begin_anew(self, out):
        shutil.rmtree(out) if out.is_dir() else out.unlink()


def campaign(name, verb, call, disk, out, calm, cuts):
    """`call`: its command line, which makes `out`."""
    since_cut = 0
    done = missed = 0
    while done < cuts:
        at = random.randint(1, verb.most)
        chance = random.choice([0, 0.5])
        ended = subprocess.run(call, env=disk.environment(PROBE_CUT=str(at)), capture_output=True, text=True)
        if ended.returncode not in (0, -signal.SIGKILL):
            raise Found(f"{name} ends with {ended.returncode}: {ended.stderr.strip()[-600:]}")
        if ended.returncode == 0:  # it was done before: begin anew
            missed += 1
            since_cut += 1
            if since_cut > 30:
                sys.exit("power_cut.py: nothing is cut; is the program linked with another C library, or does it force nothing?")
            if verb.content(out) != calm:
                raise Found(f"{name}: what it made is not that of one without cuts")
            verb.begin_anew(out)
            disk.settle()
            continue
        done += 1
        since_cut = 0
        disk.cut(chance)
        verb.look(out)
        disk.settle()  # who looks at a database takes back what was half of it, and waits for the disk
    ended = subprocess.run(call, capture_output=True, text=True)
    if ended.returncode != 0:
        raise Found(f"{name} does not go on: {ended.stderr.strip()[-600:]}")
    if verb.content(out) != calm:
        raise Found(f"{name}: what it made is not that of one without cuts")
    print(f"{name}: {done} cuts, {missed} times done before the cut; {len(calm)} rows or files, those of one without cuts", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cuts", type=int, default=100)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--forget", default="")
    parser.add_argument("--build", type=pathlib.Path, default=HERE / "build")
    parser.add_argument("verbs", nargs="*", default=[])
    wish = parser.parse_args()
    random.seed(wish.seed)
    program, library = wish.build / "vlaprobe", wish.build / "tests/libprobe_test_power_cut.so"
    if not library.exists():
        sys.exit(f"power_cut.py: {library} is not there: build it, `cmake --build {wish.build} --target probe_test_power_cut`")
    os.environ["PROBE_FORGET"] = wish.forget
    with tempfile.TemporaryDirectory(prefix="vlaprobe-cut-") as folder:
        work = pathlib.Path(folder)
        plan = work / "suite.plan"
        subprocess.run([program, "build", HERE / "suite/intact.probe", "-o", plan], check=True, capture_output=True)
        act = [str(plan), "--tasks", "carrot_on_plate", "--policy", "random", "--seeds", "1"]
        for shard in ("1", "2"):
            subprocess.run([program, "run", *act, "--episodes", "0-5", "--shard", f"{shard}/2", "-o", work / shard], check=True,
                           capture_output=True)
        few = [str(plan), "--tasks", "carrot_on_plate", "--episodes", "0-3"]
        whole = work / "whole"
        subprocess.run([program, "run", *act, "--episodes", "0-1", "-o", whole], check=True, capture_output=True)
        verbs = {
            "run": Rows(program, ["run", *act, "--episodes", "0-5", "--jobs", "2"]),
            "merge": Rows(program, ["merge", work / "1", work / "2"]),
            "sweep": Rows(program, ["sweep", *few, "--policy", "weak:ambient<{}", "--checkpoints", "0.1,0.5"], ("0.1", "0.5")),
            "ask": Rows(program, ["ask", HERE / "suite/questions.probe", "--tasks", "*carrot_on_plate", "--episodes", "0-1", "--model", "random"]),
            "table": Export(program, ["export", whole], [whole], 1),
            "dataset": Export(program, ["export", whole, "--format", "lerobot", "--size", "64x48"], [whole, "--no-redraw"], 30),
        }
        try:
            for name in wish.verbs or verbs:
                verb = verbs[name]
                ending = ".h5" if name == "table" else ""
                calm = work / f"calm_{name}{ending}"
                subprocess.run([program, *verb.words, "-o", calm], check=True, capture_output=True)
                here = work / name
                here.mkdir()
                disk = Disk(here, library)
                out = disk.root / f"out{ending}"
                campaign(name, verb, [program, *verb.words, "-o", out], disk, out, verb.content(calm), wish.cuts)
        except Found as found:
            print(f"FOUND {found}")
            return 0 if wish.forget and "is left out" in str(found) else 1
    if wish.forget:
        print(f"files that end with {wish.forget} were not forced, and nothing was found")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
