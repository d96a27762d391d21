"""The wheel in an empty virtual environment, where nothing of the source tree or the build can be seen."""

import csv
import glob
import hashlib
import base64
import os
import shutil
import subprocess
import sys
import textwrap
import unittest
import zipfile

import numpy
from common import BINARY, SOURCE, TASK, Case, program, suite_plan

SCRIPT = f"""
import json, os, sys
import numpy as np
import vlaprobe
for hidden in sys.argv[2:]:
    assert not os.path.exists(os.path.join(hidden, "README.md")), hidden
plan = vlaprobe.compile(vlaprobe.suite_file())
env = vlaprobe.make(plan, "{TASK}", episode=2)
observation, info = env.reset()
for _ in range(5):
    observation, *_ = env.step([0, 0, -0.01, 0, 0, 0, 1])
run = vlaprobe.evaluate("expert", plan, tasks="{TASK}", episodes=0, out="run", progress=False)
run.report("page.html")
asked = vlaprobe.ask(vlaprobe.suite_file("questions"), "truth", out="answers", tasks="{TASK}", episodes=0, progress=False)
json.dump({{
    "file": vlaprobe.__file__,
    "root": plan.root,
    "state": env.state_hash(),
    "trace": run.results()[0]["trace_sha256"],
    "page": os.path.getsize("page.html"),
    "right": [asked.right, asked.total - asked.skipped],
}}, open(sys.argv[1], "w"))
"""


class WheelTest(Case):
    def wheel(self, name: str) -> str:
        (path,) = glob.glob(os.path.join(BINARY, "wheel", name + "-*.whl"))
        return path

    def test_its_record_is_right_and_nothing_of_the_tree_is_in_it(self):
        for name in ("vlaprobe", "lerobot_env_vlaprobe"):
            with zipfile.ZipFile(self.wheel(name)) as wheel:
                names = wheel.namelist()
                (record,) = [entry for entry in names if entry.endswith(".dist-info/RECORD")]
                rows = list(csv.reader(wheel.read(record).decode().splitlines()))
                self.assertEqual(sorted(row[0] for row in rows), sorted(names))
                for path, digest, size in rows:
                    if path == record:
                        continue
                    data = wheel.read(path)
                    self.assertEqual(int(size), len(data))
                    wanted = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
                    self.assertEqual(digest, "sha256=" + wanted)
                self.assertFalse([entry for entry in names if "__pycache__" in entry or entry.startswith("/")])
        with zipfile.ZipFile(self.wheel("vlaprobe")) as wheel:
            names = wheel.namelist()
            for path in ("vlaprobe/py.typed", "vlaprobe/_vlaprobe.pyi", "vlaprobe/lib/libvlaprobe.so.0",
                         "vlaprobe/assets/manifest.json", "vlaprobe/dsl/std/contact.probe", "vlaprobe/suite/intact.probe"):
                self.assertIn(path, names)

    def test_installs_into_an_empty_environment_and_works_there(self):
        folder = self.folder()
        home = os.path.join(folder, "env")
        subprocess.run([sys.executable, "-m", "venv", home], check=True)
        # numpy is what it needs, and Debian's is what there is; of its folder nothing else is to be seen.
        (packages,) = glob.glob(os.path.join(home, "lib", "python3*", "site-packages"))
        theirs = os.path.dirname(os.path.dirname(numpy.__file__))
        for entry in [os.path.dirname(numpy.__file__), *glob.glob(os.path.join(theirs, "numpy-*"))]:
            os.symlink(entry, os.path.join(packages, os.path.basename(entry)))
        pip = [os.path.join(home, "bin", "python"), "-m", "pip", "--isolated", "install", "--no-index", "--quiet"]
        outside = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PIP_FIND_LINKS")}
        told = subprocess.run(
            pip + [self.wheel("vlaprobe"), self.wheel("lerobot_env_vlaprobe")], capture_output=True, text=True, env=outside
        )
        self.assertEqual(told.returncode, 0, told.stderr)
        script, answer = os.path.join(folder, "script.py"), os.path.join(folder, "answer.json")
        with open(script, "w") as file:
            file.write(textwrap.dedent(SCRIPT))
        command = [os.path.join(home, "bin", "python"), script, answer]
        # Source and build are covered up, where this machine lets a process do so.
        hidden = [BINARY, SOURCE]
        cover = "".join(f"mount -t tmpfs none '{path}' && " for path in hidden)
        covered = ["unshare", "--mount", "--map-root-user", "sh", "-c", cover + 'exec "$@"', "sh"]
        if subprocess.run(covered + ["true"], capture_output=True, check=False).returncode == 0:
            command = covered + command + hidden
        else:
            print("... skipped that the source tree is hidden: no mounts of its own for a process here", file=sys.stderr)
        told = subprocess.run(command, capture_output=True, text=True, cwd=folder, env=outside)
        self.assertEqual(told.returncode, 0, told.stderr)
        import json

        with open(answer) as file:
            said = json.load(file)
        self.assertTrue(said["file"].startswith(packages), said["file"])
        self.assertEqual(said["root"], suite_plan().root)
        import vlaprobe

        env = vlaprobe.make(suite_plan(), TASK, episode=2, cameras=False)
        env.reset()
        for _ in range(5):
            env.step([0, 0, -0.01, 0, 0, 0, 1])
        self.assertEqual(said["state"], env.state_hash())
        here = vlaprobe.evaluate("expert", suite_plan(), tasks=TASK, episodes=0, out=folder + "/here", progress=False)
        self.assertEqual(said["trace"], here.results()[0]["trace_sha256"])
        self.assertGreater(said["page"], 100_000)
        self.assertEqual(said["right"][0], said["right"][1])
        gone = subprocess.run(pip[:-4] + ["uninstall", "-y", "-q", "vlaprobe"], capture_output=True, text=True, env=outside)
        self.assertEqual(gone.returncode, 0, gone.stderr)
        self.assertFalse(os.path.exists(os.path.join(packages, "vlaprobe")))


if __name__ == "__main__":
    unittest.main()
