"""What the tests of the package share: the suite of this tree, compiled once a process."""

import functools
import os
import subprocess
import tempfile
import unittest

import vlaprobe

SOURCE = os.environ["VLAPROBE_SOURCE_DIR"]
BINARY = os.environ["VLAPROBE_BINARY_DIR"]
SUITE = os.path.join(SOURCE, "suite", "intact.probe")
TASK = "carrot_on_plate"


@functools.lru_cache(maxsize=None)
def suite_plan() -> vlaprobe.Plan:
    return vlaprobe.compile(SUITE)


def program(*words: str) -> subprocess.CompletedProcess:
    """The command line, as a user would call it."""
    return subprocess.run([os.path.join(BINARY, "vlaprobe"), *words], capture_output=True, text=True, check=False)


@functools.lru_cache(maxsize=None)
def sky_plan() -> vlaprobe.Plan:
    """`carrot_on_plate`, and `carrot_from_the_sky`, whose carrot is dropped from farther than a world reaches."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "high.probe")
        with open(path, "w") as file:
            file.write(
                f'use "{SUITE}"\n'
                "layout high like grid_24 { drop 900m settle 10s }\n"
                "variant carrot_from_the_sky of carrot_on_plate { layout high }\n"
                "suite high { tasks { carrot_on_plate, carrot_from_the_sky }; seeds 42 }\n"
            )
        return vlaprobe.compile(path, suite="high")


def small_env(**options):
    """Pictures that cost little."""
    return vlaprobe.make(suite_plan(), options.pop("task", TASK), width=64, height=48, **options)


def act(step: int) -> list:
    """Reaches out while it goes down, then closes the gripper and goes up."""
    down = step < 30
    return [0.005 if down else 0.0, 0, -0.01 if down else 0.01, 0, 0, 0.02, 1.0 if down else -1.0]


class Case(unittest.TestCase):
    def folder(self) -> str:
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        return made.name

    def assertSays(self, exception, *words):
        for word in words:
            self.assertIn(word, str(exception))
