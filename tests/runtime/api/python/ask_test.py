"""Questions to models from Python: the program's rows, callables as models, what goes wrong."""

import json
import os
import signal
import subprocess
import sys
import threading
import unittest

import numpy as np
import vlaprobe
from common import SOURCE, TASK, Case, decoded, program

QUESTIONS = os.path.join(SOURCE, "suite", "questions.probe")
CHOSEN = dict(tasks=TASK, episodes=(0, 1), questions="understanding.source", progress=False)


class AskTest(Case):
    def test_a_model_of_the_programs_gives_the_rows_of_the_program(self):
        folder = self.folder()
        answers = vlaprobe.ask(QUESTIONS, "truth", out=folder + "/here", jobs=2, **CHOSEN)
        told = program(
            "ask", QUESTIONS, "--model", "truth", "--tasks", TASK, "--episodes", "0-1", "--questions",
            "understanding.source", "-o", folder + "/there",
        )
        self.assertEqual(told.returncode, 0, told.stderr)
        there = json.loads(program("results", folder + "/there", "--json").stdout)
        rows = answers.results()
        self.assertGreater(len(rows), 2)
        self.assertEqual((answers.done, answers.right, answers.invalid), (len(rows), len(rows), 0))
        for here, other in zip(rows, there, strict=True):
            self.assertEqual({**here, "latency_s": 0}, {**other, "latency_s": 0})
        self.assertEqual(rows.counts(), {"understanding.source": (2, 2)})
        self.assertEqual(rows.valid, list(rows))
        (score,) = rows.scores
        self.assertEqual((score["arm"], score["right_in_every_order"]["asked"], score["rows"]), ("picture", 2, len(rows)))
        self.assertLess(score["luck_in_every_order"], score["luck_in_one_order"])
        self.assertIn("2 of 2", rows._repr_html_())
        why = answers.why(TASK, 1, question="source")
        self.assertEqual([one["question"] for one in why["questions"]], ["understanding.source"])
        self.assertTrue(why["questions"][0]["answers"][0]["right"])
        again = vlaprobe.ask(QUESTIONS, "truth", out=folder + "/here", **CHOSEN)
        self.assertEqual((again.done, again.skipped), (0, len(rows)))
        self.assertEqual(list(vlaprobe.open_answers(folder + "/here").results()), list(rows))
        guessed = vlaprobe.ask(QUESTIONS, "random", out=folder + "/luck", **CHOSEN)
        self.assertTrue(str(vlaprobe.compare(answers, guessed)))

    def test_a_callable_sees_the_picture_that_its_row_has_the_hash_of(self):
        seen, lock = [], threading.Lock()

        def model(asked):
            with lock:
                seen.append(asked)
            return "A"

        rows = vlaprobe.ask(
            QUESTIONS, model, out=self.folder() + "/a", arms=["picture", "blind"], size=(64, 48), jobs=3, **CHOSEN
        ).results()
        self.assertEqual(len(seen), len(rows))
        self.assertEqual({row["arm"] for row in rows}, {"picture", "blind"})
        self.assertEqual({row["model"] for row in rows}, {"model"})
        key = ("task", "arm", "episode", "rotation")
        by_key = {tuple(asked[name] for name in key): asked for asked in seen}
        import hashlib

        for row in rows:
            asked = by_key[tuple(row[name] for name in key)]
            self.assertEqual(asked["prompt"], row["text"])
            self.assertEqual(asked["question"], "understanding.source")
            if row["arm"] == "blind":
                self.assertIsNone(asked["picture"])
                self.assertIsNone(asked["png"])
                continue
            self.assertEqual(hashlib.sha256(asked["png"]).hexdigest(), row["image_sha256"])
            self.assertEqual((asked["picture"].shape, asked["picture"].dtype), ((48, 64, 3), np.uint8))
        shown = next(asked for asked in seen if asked["arm"] == "picture")
        np.testing.assert_array_equal(decoded(shown["png"]), shown["picture"])
        # A is right in one rotation of each start, and not in all.
        self.assertEqual(rows.counts()["understanding.source"], (0, 2))
        self.assertTrue(any(row["right"] for row in rows))

    def test_what_a_callable_does_wrong_is_its_rows_reason_and_asked_again(self):
        calls = []

        def broken(asked):
            calls.append(asked)
            if asked["rotation"] == 0:
                raise RuntimeError("no weights here")
            return 7 if asked["rotation"] == 1 else "A"

        folder = self.folder() + "/a"
        answers = vlaprobe.ask(QUESTIONS, broken, out=folder, **CHOSEN)
        rows = answers.results()
        self.assertEqual(answers.invalid, 4)
        for row in rows:
            if row["rotation"] == 0:
                self.assertSays(row["invalid"], "model:", "RuntimeError: no weights here", "ask_test.py", "in broken")
                self.assertNotIn("asking.py", row["invalid"])
            elif row["rotation"] == 1:
                self.assertSays(row["invalid"], "returned a int", "str")
            else:
                self.assertIsNone(row["invalid"])
        count = len(calls)
        again = vlaprobe.ask(QUESTIONS, broken, out=folder, **CHOSEN)
        # One call more: a stored answer is asked for again before the folder is gone on with.
        self.assertEqual((again.done, len(calls) - count), (4, 5))

    def test_another_callable_of_the_same_name_is_found_out(self):
        def saying(word):
            def model(asked):
                return word

            return model

        folder = self.folder() + "/a"
        first = dict(CHOSEN, episodes=0)
        asked = vlaprobe.ask(QUESTIONS, saying("A"), out=folder, **first)
        with self.assertRaises(vlaprobe.Error) as raised:
            vlaprobe.ask(QUESTIONS, saying("B"), out=folder, **CHOSEN)
        self.assertSays(raised.exception, folder, "same name", TASK, "`A` then, `B` now", "content")
        self.assertEqual(len(vlaprobe.open_answers(folder).results()), asked.done)
        again = vlaprobe.ask(QUESTIONS, saying("A"), out=folder, **CHOSEN)
        self.assertEqual((again.skipped, again.done), (asked.done, asked.done))
        mixed = vlaprobe.ask(QUESTIONS, saying("B"), out=folder, **{**CHOSEN, "episodes": (0, 2)}, if_changed="continue")
        self.assertSays(mixed.notes, "`A` then, `B` now", "continued all the same")

    def test_content_says_which_callable_it_is(self):
        said = iter("ABCABCABCABC")

        def drawing(asked):
            return next(said)

        folder = self.folder() + "/a"
        vlaprobe.ask(QUESTIONS, drawing, out=folder, content="weights 1", **dict(CHOSEN, episodes=0))
        vlaprobe.ask(QUESTIONS, drawing, out=folder, content="weights 1", **CHOSEN)
        with self.assertRaises(vlaprobe.Error):
            vlaprobe.ask(QUESTIONS, drawing, out=folder, content="weights 2", **CHOSEN)

    def test_what_cannot_be_is_refused_before_there_is_a_folder(self):
        folder = self.folder() + "/a"
        for model, options, words in [
            (lambda asked: "A", {}, ["lambda", "name"]),
            (7, {}, ["7"]),
            ("truht", {}, ["truht", "truth"]),
            (str, dict(name="truth"), ["`truth`", "another name"]),
            (str, dict(name="\uff34ruth"), ["another name"]),
            (str, dict(name="first\u200b"), ["nobody sees"]),
            (str, dict(name="mine\nand yours"), ["line break"]),
            (str, dict(name=" "), ["blank"]),
            ("openai://127.0.0.1:9?model=truth", {}, ["`truth`", "another name"]),
            ("truth", dict(name="random"), ["`random`", "another name"]),
            ("truth", dict(arms="blind"), ["truth", "blind"]),
            ("truth", dict(arms="picturesque"), ["picturesque"]),
            ("truth", dict(questions="understanding.sauce"), ["sauce"]),
            ("truth", dict(size=(64, 48)), ["size", "callable"]),
            ("truth", dict(jobs=-1), ["-1"]),
            ("truth", dict(shard=(3, 2)), ["3", "2"]),
            ("truth", dict(shard=(1, 2, 3)), ["shard", "(1, 2, 3)"]),
            ("truth", dict(jobs=1.7), ["jobs", "1.7"]),
            ("truth", dict(retries=True), ["retries", "True"]),
            ("truth", dict(insecure="no"), ["insecure", "'no'"]),
            ("truth", dict(questions=[3]), ["questions", "3"]),
            ("truth", dict(tasks=["*"]), ["tasks", "['*']"]),
            (str, dict(size=(64.5, 48)), ["size", "64.5"]),
            ("truth", dict(episodes=[0, 2]), ["[0, 2]", "(first, last)"]),
            ("truth", dict(episodes=(5, 2)), ["5", "2"]),
            ("truth", dict(if_changed="ask"), ["ask", "refuse"]),
        ]:
            with self.assertRaises(vlaprobe.UsageError) as raised:
                vlaprobe.ask(QUESTIONS, model, out=folder, **{**CHOSEN, **options})
            self.assertSays(raised.exception, *words)
            self.assertFalse(os.path.exists(folder))
        with self.assertRaises(vlaprobe.UsageError):
            vlaprobe.open_answers(folder)
        with self.assertRaises(vlaprobe.Error):
            vlaprobe.ask(QUESTIONS, "openai://127.0.0.1:9?model=x&timeout.wait_s=0&timeout.connect_s=1", out=folder, **CHOSEN)
        self.assertFalse(os.path.exists(folder))

    def test_progress_is_told_and_can_end_the_call(self):
        folder, told = self.folder() + "/a", []

        def stop(row):
            told.append(row)
            if row["done"] == 3:
                raise LookupError("enough")

        with self.assertRaises(LookupError):
            vlaprobe.ask(QUESTIONS, "truth", out=folder, **{**CHOSEN, "progress": stop})
        self.assertNotIn("question", told[0])
        self.assertEqual((told[1]["question"], told[1]["right"], told[1]["invalid"]), ("understanding.source", True, None))
        self.assertGreaterEqual(len(vlaprobe.open_answers(folder).results()), 3)
        rest = vlaprobe.ask(QUESTIONS, "truth", out=folder, **CHOSEN)
        self.assertEqual(rest.invalid, 0)
        self.assertEqual(rest.done + rest.skipped, rest.total)

    def test_control_c_ends_the_call_and_the_same_one_continues(self):
        folder = self.folder() + "/a"
        script = (
            "import time, vlaprobe\n"
            "def slow(asked):\n"
            "    print('asked', flush=True)\n"
            "    time.sleep(0.1)\n"
            "    return 'A'\n"
            "try:\n"
            f"    vlaprobe.ask({QUESTIONS!r}, slow, out={folder!r}, tasks={TASK!r})\n"
            "except KeyboardInterrupt:\n"
            "    print('interrupted', flush=True)\n"
        )
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "asked\n")
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)
        self.assertTrue(said.endswith("interrupted\n"))
        rows = vlaprobe.open_answers(folder).results()
        self.assertTrue(0 < len(rows) < 50)
        self.assertEqual(rows.valid, list(rows))


if __name__ == "__main__":
    unittest.main()
