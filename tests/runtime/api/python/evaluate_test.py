"""Callables through the program's own runner: the same traces, and failures that stay with their episodes."""

import hashlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np
import vlaprobe
from common import SUITE, TASK, Case, act, program, sky_plan, suite_plan


def reach_out(batch):
    return np.array([act(step) for step in batch["step"]])


def rows_of(folder):
    told = program("results", folder, "--json")
    return {(row["task"], row["episode"]): row for row in json.loads(told.stdout)}


class SplitMix:
    """The draws of the program's `random` policy, from draw_seed."""

    def __init__(self, key: int):
        self.key, self.counter = key, 0

    def uniform(self) -> float:
        mask = (1 << 64) - 1
        self.counter += 1
        z = (self.key + 0x9E3779B97F4A7C15 * self.counter) & mask
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        return ((z ^ (z >> 31)) >> 11) * 2.0**-53


class EvaluateTest(Case):
    def test_a_policy_of_the_programs_gives_the_traces_of_the_program(self):
        folder = self.folder()
        run = vlaprobe.evaluate(
            "expert", suite_plan(), tasks=TASK, episodes=range(0, 3), jobs=2, out=folder + "/here", progress=False
        )
        self.assertEqual((run.total, run.done, run.invalid), (3, 3, 0))
        told = program(
            "run", SUITE, "--tasks", TASK, "--episodes", "0-2", "--policy", "expert", "-o", folder + "/there"
        )
        self.assertEqual(told.returncode, 0, told.stderr)
        here, there = rows_of(run.folder), rows_of(folder + "/there")
        self.assertEqual(len(here), 3)
        for key, row in here.items():
            for hashed in ("trace_sha256", "frames_sha256", "image_sha256", "episode_id"):
                self.assertEqual(row[hashed], there[key][hashed])
        results = run.results()
        self.assertEqual(results.counts(), {TASK: (3, 3)})
        self.assertEqual(list(results), list(rows_of(run.folder).values()))
        self.assertEqual(results.refused, [])
        self.assertIn("3 of 3", results._repr_html_())
        why = run.why(TASK, 2, metric="success")
        self.assertEqual([metric["metric"] for metric in why["metrics"]], ["success"])
        self.assertTrue(why["metrics"][0]["value"])
        replayed = run.replay(TASK, 1, png=folder + "/first.png")
        self.assertTrue(replayed["identical"], replayed)
        self.assertTrue(os.path.getsize(folder + "/first.png") > 0)
        page = run.report(folder + "/page.html", title="three starts")
        self.assertEqual((page["policies"], page["episodes"]), (1, 3))
        with open(folder + "/page.html") as file:
            self.assertIn("three starts", file.read())
        with self.assertRaises(vlaprobe.UsageError) as raised:
            run.report(folder + "/here/results.sqlite")
        self.assertSays(raised.exception, "results.sqlite")
        with self.assertRaises(vlaprobe.UsageError):
            run.replay(TASK, 1, png=SUITE)
        # The same call again finds everything there.
        again = vlaprobe.evaluate(
            "expert", suite_plan(), tasks=TASK, episodes=(0, 2), out=folder + "/here", progress=False
        )
        # What is asked of a folder is refused by its name.
        for call, words in [
            (lambda: run.why(TASK, 2**40), ["episode", str(2**40)]),
            (lambda: run.why(TASK, 1.5), ["episode", "1.5"]),
            (lambda: run.why(7, 1), ["task", "7"]),
            (lambda: run.why(TASK, 1, seed=-1), ["seed", "-1"]),
            (lambda: run.why(TASK, 1, metric=["success"]), ["metric", "['success']"]),
            (lambda: run.replay(TASK, 1, step=0.5), ["step", "0.5"]),
            (lambda: run.replay(TASK, 1, verify="no"), ["verify", "'no'"]),
            (lambda: run.replay(TASK, 1, camera=0), ["camera", "0"]),
            (lambda: vlaprobe.report(run.folder, folder + "/page.html"), ["several folders", run.folder]),
            (lambda: run.report(folder + "/page.html", title=5), ["title", "5"]),
            (lambda: run.report(folder + "/page.html", jobs=1.5), ["jobs", "1.5"]),
            (lambda: vlaprobe.compare(run, run, metrics=3), ["metrics", "3"]),
        ]:
            with self.assertRaises(vlaprobe.UsageError) as raised:
                call()
            self.assertSays(raised.exception, *words)
        self.assertEqual(run.why(suite_plan().tasks[TASK], 1), run.why(TASK, 1))
        self.assertEqual((again.done, again.skipped), (0, 3))

    def test_a_random_agent_has_the_same_traces_through_a_callable_an_env_and_the_program(self):
        folder = self.folder()
        draws, said = {}, {}

        def random(batch):
            actions = []
            for world, key, step in zip(batch["world"], batch["draw_seed"], batch["step"]):
                if step == 0:
                    draws[world] = SplitMix(int(key))
                draw = draws[world].uniform
                action = [most * (2 * draw() - 1) for most in (0.02,) * 3 + (0.1,) * 3]
                actions.append(action + [-1.0 if draw() < 0.5 else 1.0])
            for episode, action in zip(batch["episode"], actions):
                said.setdefault(int(episode), []).append(action)
            return np.array(actions)

        run = vlaprobe.evaluate(
            random, suite_plan(), tasks=TASK, episodes=(0, 2), jobs=2, out=folder + "/here", progress=False, draws=True,
            seeds=[42], name="drawn",  # which traces have
        )
        told = program(
            "run", SUITE, "--tasks", TASK, "--episodes", "0-2", "--seeds", "42", "--policy", "random", "--name", "drawn", "-o",
            folder + "/there",
        )
        self.assertEqual(told.returncode, 0, told.stderr)
        here, there = rows_of(run.folder), rows_of(folder + "/there")
        for key, row in there.items():
            self.assertEqual(row["frames_sha256"], here[key]["frames_sha256"])
            self.assertEqual(row["trace_sha256"], here[key]["trace_sha256"])
        # Worlds that are stepped by hand show the same pictures and have the same states, step by step.
        exported = folder + "/steps.jsonl"
        told = program("export", folder + "/there", "-o", exported)
        self.assertEqual(told.returncode, 0, told.stderr)
        steps = {}
        with open(exported) as lines:
            for line in map(json.loads, lines):
                if line["kind"] == "step":
                    steps.setdefault(line["episode"], []).append(line)
        env = vlaprobe.make_vec(suite_plan(), TASK, num_envs=3, threads=2, autoreset="disabled")
        (camera,) = env.camera_names
        observations, _ = env.reset(options={"episode": [0, 1, 2]})
        for step in range(60):
            for world in range(3):
                seen = hashlib.sha256(observations["pixels"][camera][world].tobytes()).hexdigest()
                self.assertEqual(seen, steps[world][step]["image_sha256"])
                self.assertEqual(steps[world][step]["action"], said[world][step])
            observations, *_ = env.step(np.array([said[world][step] for world in range(3)]))
            self.assertEqual(env.state_hashes(), [steps[world][step]["state_hash"] for world in range(3)])

    def test_a_callable_answers_all_worlds_that_wait(self):
        sizes, shapes = [], set()

        def still(batch):
            sizes.append(len(batch["world"]))
            (camera,) = batch["pixels"]
            shapes.add(batch["pixels"][camera].shape[1:])
            self.assertEqual(batch["agent_pos"].shape, (sizes[-1], 8))
            self.assertEqual(batch["prompt"], ["put carrot on plate"] * sizes[-1])
            self.assertEqual(batch["horizon"].tolist(), [60] * sizes[-1])
            return [[0, 0, 0, 0, 0, 0, 1]] * sizes[-1]

        run = vlaprobe.evaluate(
            still, suite_plan(), tasks=TASK, episodes=(0, 3), jobs=4, out=self.folder() + "/run", progress=False
        )
        self.assertEqual((run.done, run.invalid), (4, 0))
        self.assertEqual(sum(sizes), 4 * 60)
        self.assertEqual(max(sizes), 4)
        self.assertGreater(np.mean(sizes), 2)
        self.assertEqual(len(shapes), 1)

    def test_what_a_callable_does_wrong_is_its_episodes_reason(self):
        class CudaTensor:
            def __array__(self, *args):
                raise TypeError("can't convert cuda:0 device type tensor to numpy")

        def broken(batch):
            actions = reach_out(batch)
            episode, step = int(batch["episode"][0]), int(batch["step"][0])
            if episode == 0 and step == 4:
                raise RuntimeError("no weights here")
            if episode == 1 and step == 2:
                return actions[:, :6]
            if episode == 2:
                return np.where(step == 3, np.nan, actions)
            if episode == 3:
                return CudaTensor()
            if episode == 4:
                return object()
            return actions

        run = vlaprobe.evaluate(
            broken, suite_plan(), tasks=TASK, episodes=(0, 5), out=self.folder() + "/run", progress=False
        )
        self.assertEqual((run.done, run.invalid), (6, 5))
        rows = {row["episode"]: row for row in run.results()}
        for episode, words in {
            0: ["policy: the callable raised RuntimeError: no weights here", "Traceback", "evaluate_test.py", "in broken"],
            1: ["policy: the callable returned the shape (1, 6)", "(1, 7)"],
            2: ["policy:", "not finite"],
            3: ["policy:", "CudaTensor", "cuda:0"],
            4: ["policy:", "object"],
        }.items():
            self.assertSays(rows[episode]["invalid"], *words)
            self.assertIsNone(rows[episode]["success"])
        self.assertNotIn("runs.py", rows[0]["invalid"])
        self.assertIsNone(rows[5]["invalid"])
        self.assertEqual(run.results().counts(), {TASK: (0, 1)})

    def test_a_start_that_fails_is_a_row_with_its_reason(self):
        asked = []

        def reached(batch):
            asked.extend(batch["task"])
            return reach_out(batch)

        run = vlaprobe.evaluate(reached, sky_plan(), episodes=0, out=self.folder() + "/run", progress=False)
        self.assertEqual((run.total, run.invalid), (2, 1))
        self.assertEqual(set(asked), {TASK})
        (row,) = [row for row in run.results() if row["invalid"]]
        self.assertSays(row["invalid"], "world:", "farther than 100 m")

    def test_progress_is_told_and_can_end_the_run(self):
        told = []
        folder = self.folder() + "/run"
        options = dict(tasks=TASK, episodes=(0, 2), out=folder)
        vlaprobe.evaluate(reach_out, suite_plan(), progress=told.append, **options)
        self.assertEqual([row["done"] for row in told], [0, 1, 2, 3])
        self.assertNotIn("task", told[0])
        self.assertEqual((told[1]["task"], told[1]["invalid"], told[1]["steps"]), (TASK, None, 60))

        class Enough(Exception):
            pass

        def stop(row):
            if row["done"] == 1:
                raise Enough("one will do")

        with self.assertRaises(Enough):
            vlaprobe.evaluate(reach_out, suite_plan(), progress=stop, **{**options, "out": folder + "2"})
        self.assertEqual(len(rows_of(folder + "2")), 1)
        rest = vlaprobe.evaluate(reach_out, suite_plan(), progress=False, **{**options, "out": folder + "2"})
        self.assertEqual((rest.done, rest.skipped), (2, 1))
        hashes = [row["trace_sha256"] for row in rows_of(folder).values()]
        self.assertEqual([row["trace_sha256"] for row in rows_of(folder + "2").values()], hashes)

    def test_control_c_ends_the_run_and_the_same_call_continues(self):
        folder = self.folder()
        script = (
            "import sys, time, numpy as np, vlaprobe\n"
            "def slow(batch):\n"
            "    print('asked', flush=True)\n"
            "    time.sleep(0.02)\n"
            "    return np.zeros((len(batch['world']), 7))\n"
            "try:\n"
            f"    vlaprobe.evaluate(slow, {SUITE!r}, tasks={TASK!r}, episodes=(0, 9), jobs=2, out={folder + '/run'!r})\n"
            "except KeyboardInterrupt:\n"
            "    print('interrupted', flush=True)\n"
        )
        process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
        self.assertEqual(process.stdout.readline(), "asked\n")
        process.send_signal(signal.SIGINT)
        said, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)
        self.assertTrue(said.endswith("interrupted\n"))

        def slow(batch):
            return np.zeros((len(batch["world"]), 7))

        run = vlaprobe.evaluate(slow, SUITE, tasks=TASK, episodes=(0, 2), out=folder + "/run", progress=False)
        self.assertEqual((run.total, run.invalid), (3, 0))
        self.assertFalse([name for name in os.listdir(folder + "/run") if "tmp" in name])

    def test_an_exit_in_a_callable_ends_the_run(self):
        def leave(batch):
            sys.exit("enough")

        folder = self.folder() + "/run"
        with self.assertRaises(SystemExit):
            vlaprobe.evaluate(leave, suite_plan(), tasks=TASK, episodes=(0, 2), out=folder, progress=False)
        self.assertEqual(rows_of(folder), {})

    def test_what_cannot_be_is_refused_before_there_is_a_folder(self):
        folder = self.folder() + "/run"
        for options, words in [
            (dict(policy=lambda batch: None), ["lambda", "name"]),
            (dict(policy=7), ["7"]),
            (dict(policy="expart"), ["expart", "expert"]),
            (dict(tasks="carot_on_plate"), ["carot_on_plate"]),
            (dict(episodes=(5, 2)), ["5", "2"]),
            (dict(episodes=range(0, 10, 2)), ["gaps"]),
            (dict(episodes=100), ["100"]),
            (dict(episodes=[0, 3]), ["[0, 3]", "(first, last)"]),
            (dict(episodes=(0, 1, 5)), ["(0, 1, 5)", "(first, last)"]),
            (dict(episodes=(0.9, 1.9)), ["episode", "0.9"]),
            (dict(episodes=True), ["episode", "True"]),
            (dict(episodes="0"), ["'0'"]),
            (dict(episodes=2**40), ["episode", str(2**40)]),
            (dict(jobs=-1), ["-1"]),
            (dict(jobs=1.7), ["jobs", "1.7"]),
            (dict(jobs=True), ["jobs", "True"]),
            (dict(batch="3"), ["batch", "'3'"]),
            (dict(seeds=[-3]), ["-3"]),
            (dict(seeds="42"), ["seeds", "'42'"]),
            (dict(seeds=42), ["seeds", "42"]),
            (dict(seeds=[1.9]), ["seed", "1.9"]),
            (dict(seeds=[1, 1]), ["seed 1", "twice"]),
            (dict(seeds=[]), ["None"]),
            (dict(tasks=[TASK, "carrot_*"]), ["tasks", TASK, "glob"]),
            (dict(suite=3), ["suite", "3"]),
            (dict(name=5), ["name", "5"]),
            (dict(content=b"x"), ["content", "b'x'"]),
            (dict(draws=1), ["draws", "1"]),
            (dict(originals="yes"), ["originals", "'yes'"]),
            (dict(progress=3), ["progress", "3"]),
            (dict(gather_s="soon"), ["gather_s", "soon"]),
            (dict(video="some"), ["some", "failures"]),
            (dict(if_changed="ask"), ["ask", "refuse"]),
            (dict(gather_s=-1.0), ["gather_s"]),
            (dict(until="soon"), ["soon", "width 10%"]),
            (dict(until=0.1), ["until", "0.1"]),
        ]:
            options = {"policy": reach_out, "tasks": TASK, "episodes": 0, "progress": False, **options}
            with self.assertRaises(vlaprobe.UsageError) as raised:
                vlaprobe.evaluate(plan=suite_plan(), out=folder, **options)
            self.assertSays(raised.exception, *words)
            self.assertFalse(os.path.exists(folder))
        with self.assertRaises(vlaprobe.UsageError):
            vlaprobe.open_run(folder)
        with self.assertRaises(vlaprobe.Error) as raised:
            vlaprobe.open_run(self.folder()).results()

    def test_a_run_stops_where_its_rate_is_known(self):
        folder = self.folder() + "/until"
        options = dict(tasks=TASK, name="mine", content="1", out=folder, progress=False)
        run = vlaprobe.evaluate(reach_out, suite_plan(), until="width 60%", **options)
        results = run.results()
        self.assertTrue(0 < len(results) < 24, len(results))
        self.assertIn("width 60 %", results.until)
        self.assertIn(TASK, " ".join(run.until))
        with self.assertRaises(vlaprobe.Error) as raised:
            vlaprobe.evaluate(reach_out, suite_plan(), until="width 30%", **options)
        self.assertSays(raised.exception, "width 60 %")
        whole = vlaprobe.evaluate(reach_out, suite_plan(), until="none", **options)
        self.assertEqual(len(whole.results()), 24)
        self.assertEqual(whole.results().until, "")

    def test_a_folder_of_demonstrations_has_rows_and_no_rates(self):
        folder = self.folder() + "/demos"
        told = program("demos", SUITE, "--suite", "intact", "--tasks", TASK, "--episodes", "0", "-o", folder)
        self.assertEqual(told.returncode, 0, told.stderr)
        rows = vlaprobe.open_run(folder).results()
        self.assertEqual((len(rows), rows.only_success), (1, True))
        with self.assertRaises(vlaprobe.UsageError) as raised:
            rows.counts()
        self.assertSays(raised.exception, "successes alone")
        self.assertIn("successes alone", rows._repr_html_())
        self.assertNotIn("1 of 1", rows._repr_html_())
        self.assertIn("successes alone", program("results", folder, "--events").stderr)

    def test_two_contents_under_one_name_are_not_one_run(self):
        options = dict(tasks=TASK, episodes=0, out=self.folder() + "/run", progress=False)
        vlaprobe.evaluate(reach_out, suite_plan(), content="weights 1", **options)
        with self.assertRaises(vlaprobe.Error) as raised:
            vlaprobe.evaluate(reach_out, suite_plan(), content="weights 2", **options)
        self.assertSays(raised.exception, options["out"])

    def test_a_callable_is_never_taken_for_a_policy_of_the_programs(self):
        folder = self.folder()
        options = dict(plan=suite_plan(), tasks=TASK, episodes=0, progress=False)

        def null(batch):
            return reach_out(batch)

        for policy, name, words in [
            (null, None, ["`null`", "name"]),
            (reach_out, "expert", ["`expert`", "name"]),
            (reach_out, "noisy:0.01", ["`noisy:0.01`", "name"]),
            (reach_out, "Expert", ["`Expert`", "name"]),
            (reach_out, "ex\u200bpert", ["nobody sees"]),
            (reach_out, "mine\n", ["line break"]),
            (reach_out, "x" * 256, ["256 bytes"]),
            ("null", "expert", ["`expert`", "`null`", "name"]),
        ]:
            with self.assertRaises(vlaprobe.UsageError) as raised:
                vlaprobe.evaluate(policy, name=name, out=folder + "/run", **options)
            self.assertSays(raised.exception, *words)
            self.assertFalse(os.path.exists(folder + "/run"))
        told = program("run", SUITE, "--tasks", TASK, "--policy", "null", "--name", "expert", "-o", folder + "/run")
        self.assertEqual(told.returncode, 1)
        self.assertIn("`expert`", told.stderr)
        # Under a name that is nobody's the folder still knows which of the two it is.
        for first, second, content in [("null", reach_out, ""), ("null", reach_out, "policy null"), (reach_out, "null", "")]:
            out = tempfile.mkdtemp(dir=folder) + "/run"
            vlaprobe.evaluate(first, name="mine", out=out, **options)
            with self.assertRaises(vlaprobe.Error) as raised:
                vlaprobe.evaluate(second, name="mine", content=content, out=out, **options)
            self.assertSays(raised.exception, out, "another policy", "policy null", "the caller's")

    def test_another_callable_of_the_same_name_is_found_out(self):
        class Policy:
            def __init__(self, late=60, noise=0.0):
                self.late, self.noise, self.random = late, noise, np.random.default_rng(0)

            def __call__(self, batch):
                actions = reach_out(batch) + self.noise * self.random.normal(size=(len(batch["world"]), 7))
                actions[batch["step"] >= self.late] = 0
                return actions

        options = dict(plan=suite_plan(), tasks=TASK, progress=False)
        out = self.folder() + "/run"
        first = vlaprobe.evaluate(Policy(), episodes=(0, 1), out=out, **options)
        self.assertEqual((first.done, first.skipped), (2, 0))
        before = rows_of(out)
        # Another object that does the same goes on.
        again = vlaprobe.evaluate(Policy(), episodes=(0, 2), out=out, jobs=2, **options)
        self.assertEqual((again.done, again.skipped), (1, 2))
        # One that differs in the last step alone does not, whether or not its episodes are there.
        for episodes in [(0, 2), 5]:
            with self.assertRaises(vlaprobe.Error) as raised:
                vlaprobe.evaluate(Policy(late=59), episodes=episodes, out=out, **options)
            self.assertEqual(raised.exception.code, "store")
            self.assertSays(raised.exception, out, "step 59", "content")
        # Nor one that draws, whose answers show nothing.
        with self.assertRaises(vlaprobe.Error) as raised:
            vlaprobe.evaluate(Policy(noise=1e-3), episodes=(0, 2), out=out, **options)
        self.assertSays(raised.exception, "step 0", "draws")
        self.assertEqual(len(rows_of(out)), 3)
        for key, row in before.items():
            self.assertEqual(rows_of(out)[key], row)
        mixed = vlaprobe.evaluate(Policy(late=59), episodes=5, out=out, if_changed="continue", **options)
        self.assertEqual(mixed.done, 1)
        self.assertTrue(any("step 59" in note and "continued all the same" in note for note in mixed.notes), mixed.notes)
        # What is said of it vouches for it.
        said = self.folder() + "/run"
        vlaprobe.evaluate(Policy(noise=1e-3), episodes=0, out=said, content="sha256 1", **options)
        more = vlaprobe.evaluate(Policy(noise=1e-3), episodes=(0, 1), out=said, content="sha256 1", **options)
        self.assertEqual((more.done, more.skipped), (1, 1))

    def test_a_folder_that_is_being_written_is_refused(self):
        folder = self.folder() + "/run"
        entered, go_on = threading.Event(), threading.Event()

        def waits(batch):
            entered.set()
            go_on.wait(30)
            return np.zeros((len(batch["world"]), 7))

        first = threading.Thread(
            target=vlaprobe.evaluate, args=(waits, suite_plan()),
            kwargs=dict(tasks=TASK, episodes=0, out=folder, progress=False),
        )
        first.start()
        self.assertTrue(entered.wait(60))
        with self.assertRaises(vlaprobe.Error) as raised:
            vlaprobe.evaluate(waits, suite_plan(), tasks=TASK, episodes=1, out=folder, progress=False)
        self.assertSays(raised.exception, folder)
        go_on.set()
        first.join()
        self.assertEqual(len(rows_of(folder)), 1)


if __name__ == "__main__":
    unittest.main()
