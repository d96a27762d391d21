"""Plans from Python: compile, tasks, episodes, mistakes."""

import pickle
import shutil
import unittest

import vlaprobe
from common import SOURCE, SUITE, TASK, Case, program, suite_plan


class PlanTest(Case):
    def test_is_the_plan_that_the_program_builds(self):
        path = self.folder() + "/suite.plan"
        self.assertEqual(program("build", SUITE, "-o", path).returncode, 0)
        plan = suite_plan()
        with open(path, "rb") as file:
            self.assertEqual(file.read(), plan.to_bytes())
        opened = vlaprobe.load(path)
        self.assertEqual(opened, plan)
        self.assertEqual(len(plan.root), 64)
        plan.save(path + "2")
        self.assertEqual(vlaprobe.load(path + "2").root, plan.root)
        self.assertEqual(pickle.loads(pickle.dumps(plan)), plan)

    def test_tasks_are_there_by_name_and_in_order(self):
        plan = suite_plan()
        task = plan.tasks[TASK]
        self.assertEqual(task.instruction, "put carrot on plate")
        self.assertEqual((task.episodes, task.horizon, task.baseline), (24, 60, None))
        self.assertIs(plan.tasks["widowx_" + TASK], task)
        variant = next(task for task in plan.tasks.values() if task.baseline == TASK)
        self.assertIn(variant.name, plan.suites["intact"].tasks)
        self.assertEqual([task["task"] for task in plan.list()], list(plan.tasks))
        self.assertEqual(task.describe()["prompt"], task.instruction)
        self.assertEqual(pickle.loads(pickle.dumps(task)).name, TASK)
        with self.assertRaises(KeyError) as raised:
            plan.tasks["carrot_on_plat"]
        self.assertSays(raised.exception, "did you mean `carrot_on_plate`?")

    def test_episodes_are_read_when_they_are_looked_at(self):
        plan = suite_plan()
        every = plan.episodes()
        self.assertEqual(len(every), sum(task.episodes for task in plan.tasks.values()))
        language = plan.episodes("*_lang_*")
        self.assertTrue(0 < len(language) < len(every))
        self.assertTrue(all("_lang_" in episode.task for episode in language[::50]))
        third = plan.episodes(TASK)[3]
        self.assertEqual((third.task, third.index, third.instruction), (TASK, 3, "put carrot on plate"))
        self.assertEqual([placed.object for placed in third.placements], ["carrot", "plate"])
        shown = program("show", SUITE, TASK, "--json")
        self.assertEqual(shown.returncode, 0)
        self.assertIn(third.episode_id, shown.stdout)
        self.assertIn(third.start_id, shown.stdout)
        row = plan.episodes(TASK).to_dicts()[3]
        self.assertEqual(row["carrot.x"], third.placements[0].position[0])
        self.assertEqual(every[-1].index, list(plan.tasks.values())[-1].episodes - 1)
        with self.assertRaises(IndexError):
            every[len(every)]

    def test_models_lie_beside_their_text_or_in_several_folders(self):
        folder = self.folder()
        for place in (folder + "/near/objects/my_plate", folder + "/far/objects/my_plate"):
            shutil.copytree(SOURCE + "/assets/objects/plate", place)
        with open(folder + "/near/mine.probe", "w") as file:
            file.write(
                'use "suite/intact.probe"\nobject my_plate like plate { mesh "my_plate"; name "my plate" }\n'
                "task mine like on_table { source carrot; target my_plate }\nsuite own { tasks { mine }; seeds 1 }\n"
            )
        shutil.copy(folder + "/near/mine.probe", folder + "/mine.probe")
        near = vlaprobe.compile(folder + "/near/mine.probe")
        self.assertEqual(near.assets[0], folder + "/near")
        with vlaprobe.make(near, "mine", cameras=False) as env:
            env.reset()
        self.assertEqual(pickle.loads(pickle.dumps(near)).assets, near.assets)
        self.assertIsNone(suite_plan().assets)
        with self.assertRaises(vlaprobe.CompileError) as raised:
            vlaprobe.compile(folder + "/mine.probe", assets=SOURCE + "/assets")
        self.assertSays(raised.exception, "P0202", "objects/my_plate")
        several = vlaprobe.compile(folder + "/mine.probe", assets=[folder + "/far", SOURCE + "/assets"])
        self.assertEqual(several, near)
        self.assertEqual(several.assets, (folder + "/far", SOURCE + "/assets"))
        self.assertEqual(vlaprobe.from_bytes(near.to_bytes(), assets=several.assets).assets, several.assets)
        again = pickle.dumps(near)
        shutil.rmtree(folder + "/near")
        with self.assertRaises(vlaprobe.Error) as raised:
            vlaprobe.make(pickle.loads(again), "mine")
        self.assertSays(raised.exception, folder + "/near")

    def test_a_text_with_mistakes_carries_its_diagnostics(self):
        with self.assertRaises(vlaprobe.CompileError) as raised:
            vlaprobe.compile(SOURCE + "/tests/golden/P0402_ambiguous.probe")
        error = raised.exception
        self.assertSays(error, "error[P0402]", "^^^")
        self.assertEqual(error.diagnostics[0]["code"], "P0402")
        self.assertEqual(error.diagnostics[0]["line"], 3)
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(again), again.diagnostics), (str(error), error.diagnostics))

    def test_what_is_not_there_is_named(self):
        for call, words in [
            (lambda: vlaprobe.compile("/no/such.probe"), ["/no/such.probe"]),
            (lambda: vlaprobe.load("/no/such.plan"), ["/no/such.plan"]),
            (lambda: vlaprobe.from_bytes(b"no plan"), []),
            (lambda: vlaprobe.compile(SUITE, assets="/no/assets"), ["/no/assets"]),
            (lambda: vlaprobe.compile(SUITE, std="/no/std"), ["/no/std"]),
            (lambda: vlaprobe.compile(SUITE, suite="intakt"), ["intakt", "did you mean `intact`?"]),
            (lambda: vlaprobe.compile(), ["path"]),
            (lambda: suite_plan().episodes("carot_on_plate"), ["carot_on_plate", "did you mean `carrot_on_plate`?"]),
            (lambda: suite_plan().select([]), ["no task"]),
            (lambda: suite_plan().select(7), ["7", "glob"]),
            (lambda: vlaprobe.make(suite_plan(), 3), ["3", "glob"]),
            (lambda: vlaprobe.compile(SUITE, tasks=["a"]), ["tasks", "['a']"]),
            (lambda: vlaprobe.Policy(3), ["policy", "3"]),
        ]:
            with self.assertRaises(vlaprobe.Error) as raised:
                call()
            self.assertSays(raised.exception, *words)

    def test_shows_itself_in_a_notebook(self):
        page = suite_plan()._repr_html_()
        self.assertIn("<td>put carrot on plate</td>", page)
        self.assertIn(suite_plan().root[:12], page)
        self.assertIn("tasks", repr(suite_plan()))


if __name__ == "__main__":
    unittest.main()
