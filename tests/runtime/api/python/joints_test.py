"""Robots that are told their joints, from Python: as many numbers as the arm has joints and one more."""

import functools
import os
import unittest

import numpy as np
import vlaprobe
from common import SOURCE, Case

TOLD, STEPPED = "told_carrot_on_plate", "stepped_carrot_on_plate"


@functools.lru_cache(maxsize=None)
def plan() -> vlaprobe.Plan:
    return vlaprobe.compile(os.path.join(SOURCE, "examples", "joint_arm.probe"), suite="joint_arm")


class JointsTest(Case):
    def test_the_action_space_is_the_arms(self):
        env = vlaprobe.make(plan(), TOLD, cameras=False)
        self.addCleanup(env.close)
        self.assertEqual(env.action_space.shape, (8,))
        self.assertEqual(env.action_space.high[7], 1)
        # The Panda's fourth joint, as its description has it.
        self.assertAlmostEqual(float(env.action_space.low[3]), -3.0718, places=3)
        self.assertAlmostEqual(float(env.action_space.high[3]), -0.0698, places=3)
        observation, _ = env.reset(options={"episode": 0})
        stay = np.append(observation["joints"][:7], 1)
        observation, *_ = env.step(stay)
        np.testing.assert_allclose(observation["joints"][:7], stay[:7], atol=2e-3)
        with self.assertRaises(ValueError) as refused:
            env.step(np.zeros(7))
        self.assertSays(refused.exception, "(8,)", "(7,)")
        steps = vlaprobe.make(plan(), STEPPED, cameras=False)
        self.addCleanup(steps.close)
        self.assertEqual(steps.action_space.shape, (8,))
        self.assertAlmostEqual(float(steps.action_space.high[3]), 0.3)  # `most` of its law

    def test_worlds_of_one_batch_take_one_kind_of_action(self):
        with self.assertRaises(vlaprobe.UsageError) as refused:
            vlaprobe.make_vec(plan(), "*", num_envs=2, cameras=False)
        self.assertSays(refused.exception, TOLD, STEPPED, "do not fit one batch: their robots take other actions")
        worlds = vlaprobe.make_vec(plan(), TOLD, num_envs=2, cameras=False)
        self.addCleanup(worlds.close)
        self.assertEqual(worlds.action_space.shape, (2, 8))
        observations, _ = worlds.reset(seed=0)
        stay = np.concatenate([observations["joints"][:, :7], np.ones((2, 1))], axis=1)
        observations, *_ = worlds.step(stay)
        np.testing.assert_allclose(observations["joints"][:, :7], stay[:, :7], atol=2e-3)

    def test_a_callable_is_told_how_many_numbers_it_answers(self):
        sizes = set()

        def stay(batch):
            sizes.add(batch["action_size"])
            return np.concatenate([batch["joints"][:, :7], np.ones((len(batch["world"]), 1))], axis=1)

        run = vlaprobe.evaluate(stay, plan(), tasks=TOLD, episodes=0, out=self.folder() + "/run", progress=False)
        self.assertEqual((run.done, run.invalid, sizes), (1, 0, {8}))
        run = vlaprobe.evaluate(
            lambda batch: np.zeros((len(batch["world"]), 7)),
            plan(),
            name="seven",
            tasks=TOLD,
            episodes=0,
            out=self.folder() + "/run",
            progress=False,
        )
        self.assertEqual(run.invalid, 1)
        self.assertSays(run.results()[0]["invalid"], "(1, 7)", "(1, 8)")


if __name__ == "__main__":
    unittest.main()
