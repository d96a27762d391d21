"""gymnasium's own checks and wrappers on ours, where it is installed; what is said where it is not."""

import functools
import pickle
import unittest
import warnings

import numpy as np
import vlaprobe
from common import TASK, Case, suite_plan

try:
    import gymnasium
    from gymnasium.utils.env_checker import check_env
    from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv
except ImportError:
    gymnasium = None

SMALL = dict(width=48, height=32)
needs_gymnasium = unittest.skipIf(gymnasium is None, "gymnasium is not installed")


def make_one(episode=None, **options):
    return vlaprobe.make(suite_plan(), TASK, episode=episode, **{**SMALL, **options})


@unittest.skipIf(gymnasium is not None, "gymnasium is installed")
class WithoutTest(Case):
    def test_names_need_gymnasium_and_say_so(self):
        self.assertFalse(vlaprobe._gym.IS_GYMNASIUM)
        with self.assertRaises(vlaprobe.UsageError) as raised:
            vlaprobe.register_envs(suite_plan(), TASK)
        self.assertSays(raised.exception, "gymnasium", "not installed")


class SuiteFileTest(Case):
    def test_suites_come_with_the_package(self):
        self.assertEqual(vlaprobe.compile(vlaprobe.suite_file()).root, suite_plan().root)
        with self.assertRaises(vlaprobe.UsageError) as raised:
            vlaprobe.suite_file("intakt")
        self.assertSays(raised.exception, "intakt", "intact", "kitchen")


@needs_gymnasium
class GymnasiumTest(Case):
    def setUp(self):
        self.names = vlaprobe.register_envs(suite_plan(), TASK + "*", **SMALL)

    def test_check_env_finds_nothing(self):
        env = gymnasium.make("vlaprobe/carrot_on_plate-v0")
        self.addCleanup(env.close)
        self.assertIsInstance(env.unwrapped, vlaprobe.Env)
        self.assertIsInstance(env.unwrapped, gymnasium.Env)
        self.assertIsInstance(env.observation_space, gymnasium.spaces.Dict)
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            check_env(env.unwrapped)
        # Places and joints have no bounds that a simulation could promise.
        rest = [str(one.message) for one in told if "infinity" not in str(one.message)]
        self.assertEqual(rest, [])

    def test_registered_names_make_worlds_of_the_plan(self):
        self.assertIn("vlaprobe/carrot_on_plate-v0", self.names)
        self.assertEqual(vlaprobe.register_envs(suite_plan(), TASK), ["vlaprobe/carrot_on_plate-v0"])
        env = gymnasium.make("vlaprobe/carrot_on_plate-v0", episode=3, width=64, height=48)
        self.addCleanup(env.close)
        _, info = env.reset(seed=1)
        self.assertEqual(info["episode_index"], 3)
        self.assertIs(env.unwrapped.plan, suite_plan())  # its assets are read once
        self.assertEqual(env.render().shape, (48, 64, 3))
        for _ in range(60):
            *_, truncated, info = env.step(np.zeros(7, np.float32))
        self.assertTrue(truncated)
        own = vlaprobe.register_envs(suite_plan(), TASK, namespace="mine", version=3, cameras=False)
        self.assertEqual(own, ["mine/carrot_on_plate-v3"])
        other = gymnasium.make(own[0], render_mode=None)
        self.addCleanup(other.close)
        self.assertNotIn("pixels", other.reset()[0])

    def test_make_vec_steps_worlds_side_by_side(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            env = gymnasium.make_vec("vlaprobe/carrot_on_plate-v0", num_envs=3, threads=2, autoreset="same_step", **SMALL)
        self.addCleanup(env.close)
        self.assertIsInstance(env, vlaprobe.VectorEnv)
        self.assertIsInstance(env, gymnasium.vector.VectorEnv)
        self.assertEqual(env.metadata["autoreset_mode"], AutoresetMode.SAME_STEP)
        observations, _ = env.reset(seed=4)
        self.assertIn(observations, env.observation_space)
        self.assertEqual(env.spec.id, "vlaprobe/carrot_on_plate-v0")
        self.assertEqual([frame.shape for frame in env.call("render")], [(32, 48, 3)] * 3)
        env = gymnasium.make_vec("vlaprobe/carrot_on_plate-v0", num_envs=2, vectorization_mode="sync", **SMALL)
        self.addCleanup(env.close)
        self.assertIsInstance(env, SyncVectorEnv)
        env.reset(seed=4)

    def test_gives_what_gymnasiums_vector_of_single_ones_gives(self):
        for mode in AutoresetMode:
            theirs = SyncVectorEnv([functools.partial(make_one, 2), functools.partial(make_one, 5)], autoreset_mode=mode)
            ours = vlaprobe.make_vec(suite_plan(), TASK, num_envs=2, threads=2, autoreset=mode, **SMALL)
            self.assertEqual(ours.observation_space, theirs.observation_space)
            self.assertEqual(ours.action_space, theirs.action_space)
            self.assertEqual(ours.single_observation_space, theirs.single_observation_space)
            self.assertEqual(ours.metadata["autoreset_mode"], theirs.metadata["autoreset_mode"])
            starts = {"episode": [2, 5]}
            self.same(theirs.reset(seed=3), ours.reset(seed=3, options=starts))
            random = np.random.default_rng(0)
            for _ in range(60):
                actions = random.uniform(-0.02, 0.02, (2, 7)).astype(np.float32)
                left, right = theirs.step(actions), ours.step(actions)
                if not right[3].any():
                    self.same(left, right)
            # Theirs begin the same starts again, ours others: what is left is how the last one ended.
            self.assertEqual(right[3].tolist(), [True, True])
            for at in (1, 2, 3):
                self.same(left[at], right[at])
            if mode is AutoresetMode.SAME_STEP:
                self.assertEqual(left[4]["final_obs"].dtype, right[4]["final_obs"].dtype)
                for world in range(2):
                    self.same(left[4]["final_obs"][world], right[4]["final_obs"][world])
                self.same(left[4]["final_info"], right[4]["final_info"])
            else:
                self.same((left[0], left[4]), (right[0], right[4]))
            if mode is AutoresetMode.NEXT_STEP:
                _, rewards, terminations, truncations, _ = ours.step(np.full((2, 7), 9.0))
                self.assertFalse(rewards.any() or terminations.any() or truncations.any())
            if mode is AutoresetMode.DISABLED:
                mask = np.array([True, False])
                self.same(
                    theirs.reset(options={"reset_mask": mask})[0]["agent_pos"][0],
                    ours.reset(options={"reset_mask": mask, **starts})[0]["agent_pos"][0],
                )
            theirs.close(), ours.close()

    def same(self, left, right, where=""):
        """Equal to the last bit, types of arrays among it."""
        self.assertIs(type(left), type(right), where)
        if isinstance(left, dict):
            self.assertEqual(sorted(left), sorted(right), where)
            for key in left:
                self.same(left[key], right[key], f"{where}/{key}")
        elif isinstance(left, tuple):
            self.assertEqual(len(left), len(right))
            for at, (one, other) in enumerate(zip(left, right)):
                self.same(one, other, f"{where}/{at}")
        else:
            self.assertEqual(np.asarray(left).dtype, np.asarray(right).dtype, where)
            np.testing.assert_array_equal(left, right, err_msg=where)

    def test_wrappers_of_gymnasium_take_them(self):
        from gymnasium.wrappers import FlattenObservation, RecordEpisodeStatistics, TimeLimit
        from gymnasium.wrappers import vector as vectors

        env = RecordEpisodeStatistics(TimeLimit(FlattenObservation(make_one(cameras=False)), 3))
        self.addCleanup(env.close)
        env.reset(seed=1)
        for _ in range(3):
            *_, truncated, info = env.step(env.action_space.sample())
        self.assertTrue(truncated)
        self.assertEqual(info["episode"]["l"], 3)
        for autoreset in ("next_step", "same_step"):
            worlds = vlaprobe.make_vec(suite_plan(), TASK, num_envs=2, cameras=False, autoreset=autoreset)
            wrapped = vectors.DictInfoToList(vectors.RecordEpisodeStatistics(worlds))
            wrapped.reset(seed=1)
            wrapped.action_space.seed(1)
            for _ in range(60):
                *_, infos = wrapped.step(wrapped.action_space.sample())
            self.assertEqual([info["episode"]["l"] for info in infos], [60, 60])
            wrapped.close()

    def test_workers_of_other_processes_have_worlds_of_their_own(self):
        here = make_one()  # threads and a device of this process, which a fork must not touch
        self.addCleanup(here.close)
        here.reset(seed=0)
        for context in ("fork", "forkserver", "spawn"):
            env = AsyncVectorEnv([functools.partial(make_one, 1)] * 2, context=context)
            observations, _ = env.reset(seed=3)
            steps = env.step(np.zeros((2, 7), np.float32))
            alone = make_one(1)
            self.same(alone.reset(seed=3)[0]["agent_pos"], observations["agent_pos"][0])
            self.same(alone.step(np.zeros(7, np.float32))[0]["pixels"], {
                name: frames[0] for name, frames in steps[0]["pixels"].items()
            })
            self.assertEqual(env.call("task_description"), ("put carrot on plate",) * 2)
            env.close(), alone.close()
        here.step(np.zeros(7))

    def test_specs_are_copied_and_pickled(self):
        spec = gymnasium.spec("vlaprobe/carrot_on_plate-v0")
        env = gymnasium.make(pickle.loads(pickle.dumps(spec)))
        self.addCleanup(env.close)
        self.assertEqual(env.unwrapped.plan.root, suite_plan().root)


if __name__ == "__main__":
    unittest.main()
