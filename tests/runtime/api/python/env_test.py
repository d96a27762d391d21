"""One world from Python: gymnasium's rules, the same bits as the program's, and what is refused."""

import os
import pickle
import threading
import unittest

import numpy as np
import vlaprobe
from common import TASK, Case, act, sky_plan, small_env, suite_plan


class EnvTest(Case):
    # After gymnasium.utils.env_checker.check_env (1.x), which is not in Debian.
    def test_keeps_the_rules_of_check_env(self):
        env = small_env()
        self.addCleanup(env.close)
        for space in (env.observation_space, env.action_space):
            self.assertIn(space.sample(), space)
        self.assertEqual(env.observation_space, env.observation_space)
        self.assertEqual(env.unwrapped, env)
        self.assertEqual(env.metadata["render_modes"], ["rgb_array"])
        self.assertEqual(env.metadata["render_fps"], 5)
        # reset() with a seed: seeded, the same again, and another one otherwise.
        first, info = env.reset(seed=123)
        self.assertIsInstance(info, dict)
        self.assertIn(first, env.observation_space)
        state = env.np_random.bit_generator.state
        again, info_again = env.reset(seed=123)
        self.assertEqual(env.np_random.bit_generator.state, state)
        self.assertEqual(env.np_random_seed, 123)
        self.assertEqual(info["episode_index"], info_again["episode_index"])
        np.testing.assert_array_equal(first["pixels"]["camera"] if "camera" in first["pixels"] else
                                      next(iter(first["pixels"].values())), next(iter(again["pixels"].values())))
        episodes = {env.reset(seed=seed)[1]["episode_index"] for seed in range(6)}
        self.assertGreater(len(episodes), 1)
        # reset() with options, and step()'s five.
        env.reset(options={})
        env.reset(options={"episode": 5})
        env.action_space.seed(7)
        action = env.action_space.sample()
        answer = env.step(action)
        self.assertEqual(len(answer), 5)
        observation, reward, terminated, truncated, info = answer
        self.assertIn(observation, env.observation_space)
        self.assertIsInstance(reward, float)
        self.assertIs(type(terminated), bool)
        self.assertIs(type(truncated), bool)
        self.assertEqual(
            set(info), {"metrics", "is_success", "prompt", "task", "episode_index", "steps", "decided"}
        )
        self.assertEqual((info["prompt"], info["episode_index"], info["steps"]), ("put carrot on plate", 5, 1))
        frame = env.render()
        self.assertEqual((frame.shape, frame.dtype), ((48, 64, 3), np.uint8))
        # Equal seeds and actions, equal steps.
        other = small_env()
        self.addCleanup(other.close)
        env.reset(seed=9), other.reset(seed=9)
        left, right = env.step(action), other.step(action)
        np.testing.assert_equal(left, right)
        self.assertEqual(env.state_hash(), other.state_hash())
        # What was given is the caller's: a later step does not write it.
        kept = {name: array.copy() for name, array in left[0]["pixels"].items()}
        env.step(act(0))
        np.testing.assert_equal(left[0]["pixels"], kept)

    def test_is_a_class_of_gymnasium_where_that_is_installed(self):
        try:
            import gymnasium
        except ImportError:
            self.assertFalse(vlaprobe._gym.IS_GYMNASIUM)
            return
        from gymnasium.utils.env_checker import check_env

        env = small_env()
        self.assertIsInstance(env, gymnasium.Env)
        check_env(env)

    def test_the_expert_succeeds_and_rewards_sum_up_to_it(self):
        env = vlaprobe.make(suite_plan(), TASK, episode=3, cameras=False)
        expert = vlaprobe.Policy("expert")
        _, info = env.reset()
        expert.begin(env)
        self.assertFalse(info["is_success"])
        rewards, over = 0.0, False
        while not over:
            observation, reward, terminated, truncated, info = env.step(expert.act(env))
            rewards, over = rewards + reward, terminated or truncated
        self.assertTrue(info["is_success"])
        self.assertTrue(info["metrics"]["success"])
        self.assertEqual(rewards, 1.0)
        self.assertEqual((info["steps"], truncated), (60, True))
        self.assertNotIn("pixels", observation)
        self.assertIn(observation, env.observation_space)
        self.assertEqual(env.task_description, "put carrot on plate")
        self.assertEqual(env._max_episode_steps, 60)

    def test_a_policy_is_told_of_each_episode(self):
        env, expert = small_env(), vlaprobe.Policy("expert")
        env.reset(options={"episode": 0})
        expert.begin(env)
        env.step(expert.act(env))
        env.reset(options={"episode": 4})
        with self.assertRaises(vlaprobe.UsageError) as raised:
            expert.act(env)
        self.assertSays(raised.exception, "reset", "begin comes first")
        expert.begin(env)
        expert.act(env)

    def test_pictures_without_copies_are_views_of_the_world(self):
        env = small_env(copy=False)
        observation, _ = env.reset(options={"episode": 0})
        (name, view), = observation["pixels"].items()
        self.assertFalse(view.flags.writeable)
        self.assertFalse(view.flags.owndata)
        before = view.copy()
        for step in range(12):
            observation, *_ = env.step(act(step))
        self.assertEqual(observation["pixels"][name].ctypes.data, view.ctypes.data)
        self.assertTrue((before != view).any())
        env.close()
        self.assertEqual(view.sum(), observation["pixels"][name].sum())  # the memory is still there

    def test_pictures_of_every_kind(self):
        env = small_env()
        env.reset(options={"episode": 0})
        depth, ids = env.picture(kind="depth"), env.picture(kind="segmentation")
        self.assertEqual((depth.dtype, depth.shape), (np.float32, (48, 64)))
        self.assertEqual((ids.dtype, ids.shape), (np.uint16, (48, 64)))
        self.assertIn(1 + env.body_names.index("carrot"), ids)
        self.assertEqual(env.objects().shape, (len(env.object_names), 7))
        with self.assertRaises(vlaprobe.UsageError) as raised:
            env.picture("elsewhere")
        self.assertSays(raised.exception, "elsewhere")
        with self.assertRaises(vlaprobe.UsageError):
            env.picture(kind="heat")

    def test_goes_on_from_what_was_saved_in_another_process_too(self):
        env = small_env(episode=4)
        env.reset(seed=3)
        for step in range(10):
            env.step(act(step))
        copy = pickle.loads(pickle.dumps(env))
        saved = env.save()
        for step in range(10, 20):
            left, right = env.step(act(step)), copy.step(act(step))
            np.testing.assert_equal(left, right)
        self.assertEqual(env.state_hash(), copy.state_hash())
        self.assertEqual(env.np_random.integers(1000), copy.np_random.integers(1000))
        after = env.state_hash()
        _, info = env.restore(saved)
        self.assertEqual(info["steps"], 10)
        for step in range(10, 20):
            env.step(act(step))
        self.assertEqual(env.state_hash(), after)
        with self.assertRaises(vlaprobe.Error):
            env.restore(saved[:-1])
        self.assertEqual(env.state_hash(), after)  # what cannot be read changes nothing
        # Of another task it is refused.
        other = small_env(task="spoon_on_towel")
        with self.assertRaises(vlaprobe.Error):
            other.restore(saved)
        with self.assertRaises(vlaprobe.UsageError) as raised:
            other.step(act(0))
        self.assertSays(raised.exception, "reset")
        self.assertIsNone(pickle.loads(pickle.dumps(small_env()))._np_random)

    def test_bad_input_is_refused_by_name_and_nothing_moves(self):
        env = small_env()
        with self.assertRaises(vlaprobe.UsageError) as raised:
            env.step(act(0))
        self.assertSays(raised.exception, TASK, "reset")
        env.reset(options={"episode": 0})
        before = env.state_hash()
        tensor = type("CudaTensor", (), {"__len__": lambda self: 7})()
        for action, kind, words in [
            ([0] * 6, ValueError, ["(7,)", "(6,)"]),
            (np.zeros((1, 7)), ValueError, ["(1, 7)"]),
            ([0, 0, 0, float("nan"), 0, 0, 1], vlaprobe.UsageError, ["number 3", "not finite"]),
            ([0, 0, 0, 0, 0, 0, float("inf")], vlaprobe.UsageError, ["number 6"]),
            ([5000, 0, 0, 0, 0, 0, 1], vlaprobe.UsageError, ["number 0", "metres"]),
            (tensor, TypeError, ["CudaTensor"]),
            ("0000000", TypeError, ["str"]),
            (None, TypeError, ["NoneType"]),
        ]:
            with self.assertRaises(kind) as raised:
                env.step(action)
            self.assertSays(raised.exception, *words)
        for options, words in [
            (dict(width=64.5), ["width", "64.5"]),
            (dict(height=True), ["height", "True"]),
            (dict(width=2**40), ["width", str(2**40)]),
            (dict(cameras=7), ["cameras", "7"]),
        ]:
            with self.assertRaises(vlaprobe.UsageError) as raised:
                vlaprobe.make(suite_plan(), TASK, **options)
            self.assertSays(raised.exception, *words)
        for options, words in [
            ({"episode": 24}, ["no episode 24", "24"]),
            ({"episode": -1}, ["-1"]),
            ({"episode": 1.5}, ["1.5"]),
            ({"episode": True}, ["True"]),
            ({"epsiode": 1}, ["epsiode", "episode"]),
        ]:
            with self.assertRaises(vlaprobe.UsageError) as raised:
                env.reset(options=options)
            self.assertSays(raised.exception, *words)
        self.assertEqual(env.state_hash(), before)
        env.step(act(0))
        for make, words in [
            (lambda: small_env(task="carrot_on_plat"), ["carrot_on_plat", "did you mean"]),
            (lambda: small_env(task="carrot_*"), ["make_vec"]),
            (lambda: small_env(episode=99), ["99"]),
            (lambda: small_env(cameras=["elsewhere"]), ["elsewhere"]),
            (lambda: small_env(render_mode="human"), ["human"]),
            (lambda: vlaprobe.make(suite_plan(), TASK, width=100), ["width and height"]),
            (lambda: vlaprobe.make(suite_plan(), TASK, width=10**6, height=1), ["1000000"]),
        ]:
            with self.assertRaises(vlaprobe.UsageError) as raised:
                make()
            self.assertSays(raised.exception, *words)

    def test_an_episode_that_is_over_is_over(self):
        env = vlaprobe.make(suite_plan(), TASK, episode=0, cameras=False)
        env.reset()
        for step in range(60):
            *_, truncated, _ = env.step(act(step))
        self.assertTrue(truncated)
        with self.assertRaises(vlaprobe.UsageError) as raised:
            env.step(act(0))
        self.assertSays(raised.exception, "over", "60")
        env.reset()
        env.step(act(0))

    def test_a_start_that_fails_is_raised_with_its_place(self):
        env = vlaprobe.make(sky_plan(), "carrot_from_the_sky", cameras=False)
        with self.assertRaises(vlaprobe.Error) as raised:
            env.reset(options={"episode": 2})
        self.assertSays(raised.exception, "carrot_from_the_sky", "episode 2", "farther than 100 m")
        self.assertEqual(raised.exception.code, "world")
        for call in (lambda: env.step(act(0)), env.save, env.state_hash):
            with self.assertRaises(vlaprobe.UsageError) as raised:
                call()
            self.assertSays(raised.exception, "failed", "reset")

    def test_a_closed_env_says_so(self):
        env = small_env()
        env.reset(seed=0)
        env.close()
        env.close()
        for call in (env.reset, env.render, env.save, lambda: env.step(act(0)), env.state_hash, env.objects):
            with self.assertRaises(vlaprobe.ClosedError) as raised:
                call()
            self.assertSays(raised.exception, TASK, "closed")
        with self.assertRaises(vlaprobe.ClosedError):
            pickle.dumps(env)
        with small_env() as other:
            other.reset(seed=0)
        with self.assertRaises(vlaprobe.ClosedError):
            other.reset()

    def test_a_second_thread_on_one_env_is_refused_or_waits_for_nothing(self):
        env = vlaprobe.make(suite_plan(), TASK, episode=0, cameras=False)
        env.reset()
        refused, others = [], []

        def step():
            for _ in range(200):
                try:
                    env.step(act(0))
                except vlaprobe.UsageError as error:
                    (refused if "another thread" in str(error) else others).append(str(error))

        threads = [threading.Thread(target=step) for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        # Whatever was refused, nothing broke: the same env begins anew.
        self.assertTrue(all("over" in text for text in others))
        _, info = env.reset()
        self.assertEqual(info["steps"], 0)

    def test_closing_while_another_thread_steps_is_safe(self):
        env = vlaprobe.make(suite_plan(), TASK, episode=0, cameras=False)
        env.reset()
        errors = []

        def step():
            try:
                while True:
                    env.step(act(0))
            except vlaprobe.Error as error:
                errors.append(error)

        thread = threading.Thread(target=step)
        thread.start()
        env.close()
        thread.join()
        self.assertEqual(len(errors), 1)

    def test_a_forked_child_is_told_to_make_its_own(self):
        env = small_env(episode=0)
        env.reset()
        reader, writer = os.pipe()
        child = os.fork()
        if child == 0:
            try:
                env.step(act(0))
                told = b"stepped"
            except vlaprobe.UsageError as error:
                told = str(error).encode()
            env.close()
            os.write(writer, told)
            os._exit(0)
        os.waitpid(child, 0)
        self.assertIn("forked", os.read(reader, 1000).decode())
        env.step(act(0))  # the parent's is as it was


if __name__ == "__main__":
    unittest.main()
