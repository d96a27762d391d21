"""What plans, starts, worlds and results show of themselves in notebooks, and how progress is drawn there and on terminals."""

import base64
import os
import pty
import re
import select
import struct
import sys
import types
import unittest

import numpy as np
import vlaprobe
from common import SOURCE, SUITE, TASK, Case, decoded, small_env, suite_plan


def sizes_in(page: str) -> list:
    """(width, height) of the pictures in HTML."""
    return [struct.unpack(">II", base64.b64decode(data)[16:24]) for data in re.findall(r'src="data:image/png;base64,([^"]+)"', page)]


class NotebookTest(Case):
    def test_a_world_and_its_pictures_show_themselves(self):
        env = small_env()
        self.addCleanup(env.close)
        self.assertIsNone(env._repr_png_())  # nothing to be seen before the first reset
        observation, _ = env.reset(options={"episode": 2})
        seen = next(iter(observation["pixels"].values()))
        np.testing.assert_array_equal(decoded(env._repr_png_()), seen)
        picture = env.picture()
        np.testing.assert_array_equal(decoded(picture._repr_png_()), seen)
        np.testing.assert_array_equal(decoded(picture[:10, :7]._repr_png_()), seen[:10, :7])
        self.assertIsNone(picture[0]._repr_png_())
        self.assertIsNone((picture / 2)._repr_png_())
        self.assertIs(type(env.picture(kind="depth")), np.ndarray)
        path = self.folder() + "/seen.png"
        picture.save(path)
        with open(path, "rb") as file:
            np.testing.assert_array_equal(decoded(file.read()), seen)
        env.close()
        self.assertIsNone(env._repr_png_())
        self.assertIn("closed", repr(env))

    def test_a_start_shows_what_a_policy_sees_first(self):
        env = small_env()
        self.addCleanup(env.close)
        observation, _ = env.reset(options={"episode": 5})
        start = suite_plan().episodes(TASK)[5]
        np.testing.assert_array_equal(start.picture(width=64, height=48), next(iter(observation["pixels"].values())))
        page = start._repr_html_()
        self.assertIn("put carrot on plate", page)
        self.assertEqual(start.picture().shape, (480, 640, 3))
        self.assertEqual(sizes_in(page), [(320, 240)])  # a notebook keeps its bytes
        several = suite_plan().episodes(TASK)[:3]._repr_html_()
        self.assertEqual(len(sizes_in(several)), 3)
        self.assertNotIn("more", several)
        many = suite_plan().episodes()._repr_html_()
        self.assertLessEqual(len(sizes_in(many)), 6)
        self.assertIn(f"and {len(suite_plan().episodes()) - 6} more", many)
        with self.assertRaises(vlaprobe.UsageError) as raised:
            start.picture("elsewhere")
        self.assertSays(raised.exception, "elsewhere")

    def test_words_are_text_and_never_markup(self):
        folder = self.folder()
        path = folder + "/markup.probe"
        with open(path, "w") as file:
            file.write(
                f'use "{SUITE}"\n'
                'variant odd of carrot_on_plate { say "put {source} <b>on</b> {target}" }\n'
                "suite odd { tasks { carrot_on_plate, odd }; seeds 42 }\n"
            )
        try:
            plan = vlaprobe.compile(path, suite="odd")
        except vlaprobe.CompileError:
            self.skipTest("the language refuses such words by itself")
        for page in (plan._repr_html_(), plan.tasks["odd"]._repr_html_(), plan.episodes("odd")[0]._repr_html_()):
            self.assertNotIn("<b>on</b>", page)

    def test_tasks_and_runs_show_themselves(self):
        task = suite_plan().tasks[TASK]
        page = task._repr_html_()
        self.assertIn("put carrot on plate", page)
        self.assertEqual(len(sizes_in(page)), 1)
        run = vlaprobe.evaluate(
            "null", suite_plan(), tasks=TASK, episodes=(0, 1), out=self.folder() + "/null", progress=False
        )
        self.assertIn("0 of 2", run._repr_html_())
        self.assertIn(run.folder, run._repr_html_())


class Shown:
    def __init__(self):
        self.texts = []

    def update(self, text):
        self.texts.append(text)


class ProgressTest(Case):
    def notebook(self) -> Shown:
        """A kernel, as IPython tells of it."""
        shown = Shown()
        shell = types.SimpleNamespace(config={"IPKernelApp": {}})
        ipython, display = types.ModuleType("IPython"), types.ModuleType("IPython.display")
        ipython.get_ipython = lambda: shell
        display.display = lambda text, display_id: shown
        for name, module in (("IPython", ipython), ("IPython.display", display)):
            before = sys.modules.get(name)
            sys.modules[name] = module
            self.addCleanup(
                lambda name=name, before=before: sys.modules.pop(name) if before is None else sys.modules.update({name: before})
            )
        return shown

    def test_a_notebook_has_one_line_that_changes(self):
        shown = self.notebook()
        vlaprobe.evaluate("expert", suite_plan(), tasks=TASK, episodes=(0, 1), out=self.folder() + "/run")
        self.assertEqual(shown.texts[-1], "2 of 2 episodes, 2 of 2 succeeded")
        self.assertEqual(shown.texts[0], "0 of 2 episodes")
        shown = self.notebook()
        vlaprobe.ask(
            os.path.join(SOURCE, "suite", "questions.probe"), "truth", out=self.folder() + "/a", tasks=TASK, episodes=0,
            questions="understanding.source",
        )
        self.assertRegex(shown.texts[-1], r"^(\d+) of \1 answers, \1 of \1 right$")

    def test_a_terminal_has_a_line_that_is_redrawn_and_a_log_has_none(self):
        script = (
            "import vlaprobe\n"
            f"vlaprobe.evaluate('expert', {SUITE!r}, tasks={TASK!r}, episodes=(0, 1), out={self.folder() + '/run'!r})\n"
        )
        child, terminal = pty.fork()
        if child == 0:
            os.execv(sys.executable, [sys.executable, "-c", script])
        said = b""
        while True:
            if not select.select([terminal], [], [], 120)[0]:
                break
            try:
                more = os.read(terminal, 4096)
            except OSError:  # its end
                break
            if not more:
                break
            said += more
        _, status = os.waitpid(child, 0)
        self.assertEqual(status, 0, said)
        self.assertTrue(said.endswith(b"\r\x1b[K2 of 2 episodes, 2 of 2 succeeded\r\n"), said)
        import subprocess

        quiet = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True)
        self.assertEqual((quiet.stdout, quiet.stderr), (b"", b""))

    def test_what_is_left_is_told(self):
        from vlaprobe._progress import Line

        now = [0.0]
        shown = self.notebook()
        line = Line("episodes", "success", clock=lambda: now[0])
        line(dict(done=0, skipped=10, total=110))
        for done in range(1, 51):
            now[0] = done * 6.0
            line(dict(done=done, skipped=10, total=110, success=done % 2 == 0, invalid="world: it broke" if done == 7 else None))
        self.assertEqual(shown.texts[-1], "60 of 110 episodes, 25 of 49 succeeded, 1 invalid, 5 min left")
        # No more often than an eye can follow.
        count = len(shown.texts)
        for _ in range(100):
            line(dict(done=51, skipped=10, total=110))
        self.assertLess(len(shown.texts) - count, 3)


if __name__ == "__main__":
    unittest.main()
