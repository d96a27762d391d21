"""Worlds side by side: gymnasium's three autoresets, and the bits of one world alone."""

import pickle
import unittest

import numpy as np
import vlaprobe
from common import TASK, Case, act, sky_plan, small_env, suite_plan
from vlaprobe._gym import AutoresetMode


def make(**options):
    options = {"num_envs": 3, "threads": 2, "width": 64, "height": 48, **options}
    return vlaprobe.make_vec(suite_plan(), options.pop("tasks", TASK), **options)


def actions(worlds: int, step: int) -> np.ndarray:
    return np.tile(np.array(act(step)), (worlds, 1))


class VecTest(Case):
    def test_shapes_are_those_of_gymnasium(self):
        env = make()
        self.addCleanup(env.close)
        observations, infos = env.reset(seed=5)
        self.assertIn(observations, env.observation_space)
        self.assertIn(env.action_space.sample(), env.action_space)
        (name,) = env.camera_names
        self.assertEqual(observations["pixels"][name].shape, (3, 48, 64, 3))
        self.assertEqual(env.observation_space["agent_pos"].shape, (3, 8))
        self.assertEqual(env.single_observation_space, small_env().observation_space)
        self.assertIs(env.metadata["autoreset_mode"], AutoresetMode.NEXT_STEP)
        observations, rewards, terminations, truncations, infos = env.step(env.action_space.sample())
        self.assertEqual((rewards.shape, rewards.dtype), ((3,), np.float64))
        for flags in (terminations, truncations):
            self.assertEqual((flags.shape, flags.dtype), ((3,), bool))
        for key in ("is_success", "prompt", "task", "episode_index", "steps", "metrics"):
            self.assertTrue(infos["_" + key].all())
        self.assertEqual(infos["metrics"]["success"].dtype, bool)
        self.assertEqual(len(env.render()), 3)
        self.assertEqual(env.call("task_description"), ("put carrot on plate",) * 3)
        self.assertEqual(env.call("_max_episode_steps"), (60,) * 3)
        self.assertIsInstance(env.spec, type(None))

    def test_a_world_has_the_bits_of_an_env_with_its_seed(self):
        env = make(autoreset="next_step")
        observations, infos = env.reset(seed=11)
        (name,) = env.camera_names
        for world in range(3):
            alone = small_env()
            observation, info = alone.reset(seed=11 + world)
            self.assertEqual(infos["episode_index"][world], info["episode_index"])
            np.testing.assert_array_equal(observations["pixels"][name][world], observation["pixels"][name])
            alone.close()
        alone = small_env()
        alone.reset(seed=12)
        for step in range(60):
            observations, rewards, _, truncations, infos = env.step(actions(3, step))
            observation, reward, _, truncated, info = alone.step(act(step))
            np.testing.assert_array_equal(observations["pixels"][name][1], observation["pixels"][name])
            np.testing.assert_array_equal(observations["agent_pos"][1], observation["agent_pos"])
            np.testing.assert_array_equal(observations["joints"][1], observation["joints"])
            self.assertEqual((rewards[1], truncations[1], infos["steps"][1]), (reward, truncated, info["steps"]))
            for metric, value in info["metrics"].items():
                self.assertEqual(infos["metrics"][metric][1], value)
        self.assertEqual(env.state_hashes()[1], alone.state_hash())
        # The next one is the one that an env would draw.
        _, rewards, terminations, truncations, infos = env.step(actions(3, 0))
        self.assertFalse(terminations.any() or truncations.any() or rewards.any())
        self.assertEqual(infos["episode_index"][1], alone.reset()[1]["episode_index"])
        self.assertTrue((infos["steps"] == 0).all())
        self.assertEqual(env.state_hashes()[1], alone.state_hash())

    def test_same_step_gives_both_ends(self):
        env, late = make(autoreset="same_step"), make(autoreset=AutoresetMode.NEXT_STEP)
        env.reset(seed=1), late.reset(seed=1)
        (name,) = env.camera_names
        for step in range(59):
            *_, infos = env.step(actions(3, step))
            late.step(actions(3, step))
            self.assertNotIn("final_obs", infos)
        observations, rewards, terminations, truncations, infos = env.step(actions(3, 59))
        last, last_rewards, _, last_truncations, last_infos = late.step(actions(3, 59))
        self.assertTrue(truncations.all() and last_truncations.all())
        np.testing.assert_array_equal(rewards, last_rewards)
        for world in range(3):
            np.testing.assert_array_equal(infos["final_obs"][world]["pixels"][name], last["pixels"][name][world])
        self.assertTrue(infos["_final_obs"].all())
        np.testing.assert_equal(infos["final_info"]["metrics"], last_infos["metrics"])
        np.testing.assert_array_equal(infos["final_info"]["episode_index"], last_infos["episode_index"])
        self.assertTrue((infos["steps"] == 0).all())
        begun, *_ = late.step(actions(3, 0))
        np.testing.assert_array_equal(observations["pixels"][name], begun["pixels"][name])
        *_, infos = env.step(actions(3, 0))
        self.assertTrue((infos["steps"] == 1).all())
        self.assertNotIn("final_obs", infos)

    def test_disabled_waits_for_the_mask(self):
        env = make(autoreset="disabled")
        env.reset(seed=2, options={"episode": [3, 4, 5]})
        for step in range(60):
            *_, truncations, infos = env.step(actions(3, step))
        self.assertTrue(truncations.all())
        with self.assertRaises(vlaprobe.UsageError) as raised:
            env.step(actions(3, 0))
        self.assertSays(raised.exception, "world 0", "over")
        _, infos = env.reset(options={"reset_mask": np.array([True, False, True]), "episode": 7})
        np.testing.assert_array_equal(infos["_episode_index"], [True, False, True])
        self.assertEqual((infos["episode_index"][0], infos["episode_index"][2]), (7, 7))
        with self.assertRaises(vlaprobe.UsageError) as raised:
            env.step(actions(3, 0))
        self.assertSays(raised.exception, "world 1")
        env.reset(options={"reset_mask": np.array([False, True, False])})
        env.step(actions(3, 0))
        for mask in ([True, False], np.zeros(3, bool), np.ones(3)):
            with self.assertRaises(vlaprobe.UsageError):
                env.reset(options={"reset_mask": mask})

    def test_a_world_that_fails_is_invalid_and_the_others_go_on(self):
        for autoreset in ("next_step", "same_step"):
            env = vlaprobe.make_vec(
                sky_plan(), [TASK, "carrot_from_the_sky"], num_envs=2, threads=2, cameras=False, autoreset=autoreset
            )
            with self.assertRaises(vlaprobe.Error) as raised:
                env.reset(seed=0)
            self.assertSays(raised.exception, "world 1", "carrot_from_the_sky", "farther than 100 m")
            _, infos = env.reset(seed=0, options={"task": TASK})
            for step in range(60 if autoreset == "next_step" else 59):
                *_, infos = env.step(actions(2, step))
                self.assertNotIn("invalid", infos)
            for again in range(2):  # world 1 is given no other task
                _, rewards, terminations, truncations, infos = env.step(actions(2, 59))
                np.testing.assert_array_equal(infos["_invalid"], [False, True])
                self.assertSays(infos["invalid"][1], "world 1", "farther than 100 m")
                self.assertTrue(truncations[1] and not terminations[1])
                self.assertEqual((rewards[1], infos["is_success"][1]), (0, False))
                # The episode that ended before counts, although the next one could not begin.
                counted = autoreset == "same_step" and again == 0
                self.assertEqual("final_info" in infos, counted)
                if counted:
                    np.testing.assert_array_equal(infos["_final_info"], [True, True])
                    self.assertEqual(infos["final_info"]["steps"].tolist(), [60, 60])
                np.testing.assert_array_equal(infos["metrics"]["_success"], [True, False])
            self.assertIsNone(infos["invalid"][0])
            self.assertEqual(infos["steps"][0], 1)
            env.close()

    def test_several_tasks_share_one_batch(self):
        env = make(tasks="carrot_on_plate_lang_*", num_envs=4, cameras=False)
        _, infos = env.reset(seed=0)
        self.assertEqual([task in env.tasks for task in infos["task"]], [True] * 4)
        self.assertEqual(env.call("task"), tuple(infos["task"]))
        self.assertEqual(list(infos["prompt"]), [suite_plan().tasks[task].instruction for task in infos["task"]])
        env.reset(options={"task": env.tasks[0], "episode": 1})
        self.assertEqual(env.call("task"), (env.tasks[0],) * 4)
        with self.assertRaises(vlaprobe.UsageError) as raised:
            env.reset(options={"task": "spoon_on_towel"})
        self.assertSays(raised.exception, "spoon_on_towel")
        every = make(tasks=["carrot_*", "spoon_*"], num_envs=2, cameras=False)  # more tasks than worlds
        seen = {task for seed in range(4) for task in every.reset(seed=seed * 10)[1]["task"]}
        self.assertGreater(len(seen), 2)

    def test_bad_input_is_refused_by_name(self):
        env = make()
        for call, kind, words in [
            (lambda: env.step(actions(3, 0)), vlaprobe.UsageError, ["reset"]),
            (lambda: env.reset(seed=[1, 2]), vlaprobe.UsageError, ["2 seeds", "3 worlds"]),
            (lambda: env.reset(options={"episode": [1, 2]}), vlaprobe.UsageError, ["2 values"]),
            (lambda: env.reset(options={"episode": 24}), vlaprobe.UsageError, ["24"]),
            (lambda: env.reset(options={"epsiode": 24}), vlaprobe.UsageError, ["epsiode"]),
            (lambda: env.reset(options={"episode": 1.7}), vlaprobe.UsageError, ["episode", "1.7"]),
            (lambda: env.reset(options=["episode"]), vlaprobe.UsageError, ["dict", "['episode']"]),
            (lambda: env.reset(seed=1.5), vlaprobe.UsageError, ["seed", "1.5"]),
            (lambda: make(width=64.5), vlaprobe.UsageError, ["width", "64.5"]),
            (lambda: make(num_envs=2.5), vlaprobe.UsageError, ["num_envs", "2.5"]),
            (lambda: make(threads="2"), vlaprobe.UsageError, ["threads", "'2'"]),
            (lambda: make(cameras=3), vlaprobe.UsageError, ["cameras", "3"]),
            (lambda: make(autoreset="sometimes"), vlaprobe.UsageError, ["sometimes", "next_step"]),
            (lambda: make(num_envs=0), vlaprobe.UsageError, ["0"]),
            (lambda: make(num_envs=5000), vlaprobe.UsageError, ["5000", "4096"]),
            (lambda: make(threads=-1), vlaprobe.UsageError, ["-1"]),
            (lambda: make(tasks="nothing"), vlaprobe.UsageError, ["nothing"]),
            (lambda: make(tasks="*"), vlaprobe.UsageError, ["carrot_on_plate", "put_eggplant_in_basket", "cameras"]),
            (lambda: make(episode=99), vlaprobe.UsageError, ["99"]),
            (lambda: pickle.dumps(env), vlaprobe.UsageError, ["threads"]),
            (lambda: env.set_attr("task", "x"), vlaprobe.UsageError, ["task"]),
        ]:
            with self.assertRaises(kind) as raised:
                call()
            self.assertSays(raised.exception, *words)
        env.reset(seed=0)
        hashes = env.state_hashes()
        bad = actions(3, 0)
        bad[2, 4] = np.nan
        for given, kind, words in [
            (actions(2, 0), ValueError, ["(3, 7)", "(2, 7)"]),
            (bad, vlaprobe.UsageError, ["world 2", "number 4"]),
            ([None] * 3, TypeError, ["list"]),
        ]:
            with self.assertRaises(kind) as raised:
                env.step(given)
            self.assertSays(raised.exception, *words)
        self.assertEqual(env.state_hashes(), hashes)
        env.close()
        env.close()
        self.assertTrue(env.closed)
        with self.assertRaises(vlaprobe.ClosedError):
            env.reset()

    def test_without_copies_the_arrays_are_the_worlds_own(self):
        env = make(copy=False)
        observations, _ = env.reset(seed=0)
        (name,) = env.camera_names
        view = observations["pixels"][name]
        self.assertFalse(view.flags.writeable or view.flags.owndata)
        later, *_ = env.step(actions(3, 0))
        self.assertEqual(later["pixels"][name].ctypes.data, view.ctypes.data)


if __name__ == "__main__":
    unittest.main()
