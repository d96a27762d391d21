"""What the tests of the package share: the suite of this tree, compiled once a process."""

import functools
import os
import struct
import subprocess
import tempfile
import unittest
import zlib

import numpy as np
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


def decoded(png: bytes) -> np.ndarray:
    """An 8-bit RGB PNG as an array, by the rules of the format; the checksums of its chunks hold."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, data = 8, b""
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at : at + 8])
        body = png[at + 8 : at + 8 + size]
        assert struct.unpack(">I", png[at + 8 + size : at + 12 + size]) == (zlib.crc32(kind + body),)
        if kind == b"IHDR":
            width, height, *rest = struct.unpack(">IIBBBBB", body)
            assert rest == [8, 2, 0, 0, 0]
        data += body if kind == b"IDAT" else b""
        at += 12 + size
    raw = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, width * 3 + 1)
    rows = np.zeros((height + 1, width + 1, 3), np.int32)
    for y in range(height):
        line, above, out = raw[y, 1:].reshape(width, 3).astype(np.int32), rows[y], rows[y + 1]
        if raw[y, 0] == 0:
            out[1:] = line
        elif raw[y, 0] == 1:
            out[1:] = np.cumsum(line, axis=0) & 255
        elif raw[y, 0] == 2:
            out[1:] = (line + above[1:]) & 255
        else:
            for x in range(1, width + 1):
                left, up, corner = out[x - 1], above[x], above[x - 1]
                if raw[y, 0] == 3:
                    guess = (left + up) // 2
                else:
                    far = np.abs(np.stack([up - corner, left - corner, left + up - 2 * corner]))
                    guess = np.choose(far.argmin(0), [left, up, corner])
                out[x] = (line[x - 1] + guess) & 255
    return rows[1:, 1:].astype(np.uint8)


class Case(unittest.TestCase):
    def folder(self) -> str:
        made = tempfile.TemporaryDirectory()
        self.addCleanup(made.cleanup)
        return made.name

    def assertSays(self, exception, *words):
        for word in words:
            self.assertIn(word, str(exception))
