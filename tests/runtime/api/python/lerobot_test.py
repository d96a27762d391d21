"""What LeRobot's evaluation reads of an environment. Its rollout is written here after lerobot 0.6; where lerobot can be
imported, its own code is run too."""

import contextlib
import importlib.util
import io
import json
import os
import unittest

import numpy as np
import vlaprobe
import vlaprobe.lerobot
from common import SOURCE, TASK, Case, act, program, sky_plan, suite_plan
from vlaprobe._gym import AutoresetMode

try:
    import lerobot.envs
    import torch
except ImportError:
    lerobot = None
needs_lerobot = unittest.skipIf(lerobot is None, "lerobot is not installed")

SMALL = dict(width=48, height=32)


class ExpertVector:
    """The program's expert in each world of a vector: actions that succeed."""

    def __init__(self, worlds: int, starts: list):
        self.envs = [vlaprobe.make(suite_plan(), TASK, cameras=False, episode=start) for start in starts]
        self.policies = [vlaprobe.Policy("expert") for _ in range(worlds)]
        for env, policy in zip(self.envs, self.policies):
            env.reset()
            policy.begin(env)

    def actions(self) -> np.ndarray:
        said = np.array([policy.act(env) for env, policy in zip(self.envs, self.policies)])
        for env, action in zip(self.envs, said):
            env.step(action)
        return said


def rollout(env, act, seeds) -> np.ndarray:
    """As lerobot_eval.rollout() and eval_policy() read successes: a world has succeeded if any step says so."""
    observation, info = env.reset(seed=seeds, options={"lerobot_new_rollout": True})
    successes, done = [], np.zeros(env.num_envs, bool)
    for step in range(env.call("_max_episode_steps")[0]):
        observation, reward, terminated, truncated, info = env.step(act(step))
        told = info["final_info"]["is_success"] if "final_info" in info else info["is_success"]
        successes.append(np.where(done, False, told))
        done |= terminated | truncated
    assert done.all()
    return np.any(successes, axis=0)


class LeRobotTest(Case):
    def test_observations_are_those_of_the_dataset_that_was_exported(self):
        folder = self.folder()
        run = vlaprobe.evaluate("expert", suite_plan(), tasks=TASK, episodes=3, out=folder + "/run", progress=False)
        told = program("export", run.folder, "--format", "robomimic", "-o", folder + "/data")
        self.assertEqual(told.returncode, 0, told.stderr)
        import h5py

        env = vlaprobe.lerobot.LeRobotVectorEnv(suite_plan(), TASK, num_envs=2, threads=1)
        self.addCleanup(env.close)
        with h5py.File(folder + "/data/demos.hdf5") as file:
            demo = file["data/demo_0"]
            observation, _ = env.reset(seed=[3, 3])
            for step in range(40):
                self.assertIn(observation, env.observation_space)
                for world in range(2):
                    np.testing.assert_allclose(
                        observation["agent_pos"][world], demo["obs/state"][step], rtol=0, atol=1e-7, err_msg=str(step)
                    )
                    np.testing.assert_array_equal(
                        observation["joints"][world].astype(np.float32), demo["obs/joints"][step].astype(np.float32)
                    )
                    (camera,) = env.camera_names
                    np.testing.assert_array_equal(observation["pixels"][camera][world], demo[f"obs/{camera}"][step])
                observation, *_ = env.step(np.tile(demo["actions"][step], (2, 1)))

    def test_attributes_are_those_that_are_asked_for(self):
        env = vlaprobe.lerobot.LeRobotVectorEnv(suite_plan(), TASK, num_envs=2, **SMALL)
        self.addCleanup(env.close)
        self.assertEqual(env.call("task_description"), ("put carrot on plate",) * 2)
        self.assertEqual(env.call("task"), (TASK, TASK))
        self.assertEqual(env.call("_max_episode_steps"), (60, 60))
        self.assertEqual((env.unwrapped.metadata["render_fps"], type(env.metadata["render_fps"])), (5, int))
        self.assertEqual(env.metadata["autoreset_mode"], AutoresetMode.SAME_STEP)
        observation, info = env.reset(seed=[0, 1])
        for picture in observation["pixels"].values():
            self.assertEqual((picture.shape, picture.dtype), ((2, 32, 48, 3), np.uint8))
        self.assertEqual(observation["agent_pos"].shape, (2, 7))
        self.assertEqual(info["is_success"].dtype, bool)
        np.testing.assert_array_equal(np.stack(env.call("render")), next(iter(observation["pixels"].values())))

    def test_seeds_that_follow_one_another_see_each_start_once(self):
        env = vlaprobe.lerobot.LeRobotVectorEnv(suite_plan(), TASK, num_envs=8, cameras=False, render_mode=None)
        self.addCleanup(env.close)
        seen = []
        for first in (1000, 1008, 1016):
            _, info = env.reset(seed=list(range(first, first + 8)), options={"lerobot_new_rollout": True})
            seen += info["episode_index"].tolist()
        self.assertEqual(sorted(seen), list(range(24)))

    def test_success_is_the_verdict_at_the_end(self):
        env = vlaprobe.lerobot.LeRobotVectorEnv(suite_plan(), TASK, num_envs=2, cameras=False, render_mode=None)
        self.addCleanup(env.close)
        expert = ExpertVector(2, [3, 5])
        self.assertEqual(rollout(env, lambda step: expert.actions(), [3, 5]).tolist(), [True, True])
        # One that takes the carrot away again has not succeeded, whatever held in between.
        expert = ExpertVector(2, [3, 5])

        def spoils(step):
            said = expert.actions()
            if step >= 40:
                said[0] = [0, 0, -0.05 if step < 46 else 0.02, 0, 0, 0, 1 if step < 46 else -1]
            return said

        inner = []
        step_of = vlaprobe.VectorEnv.step

        def watched(self, actions):
            told = step_of(self, actions)
            inner.append(told[-1]["is_success"].copy())
            return told

        vlaprobe.VectorEnv.step = watched
        self.addCleanup(setattr, vlaprobe.VectorEnv, "step", step_of)
        self.assertEqual(rollout(env, spoils, [3, 5])[1], True)
        inner = np.array(inner)
        self.assertTrue(inner[30:-1, 1].any())  # true before the end, which LeRobot is not told

    def test_a_world_that_cannot_go_on_is_no_failed_episode(self):
        env = vlaprobe.lerobot.LeRobotVectorEnv(
            sky_plan(), "carrot_from_the_sky", num_envs=2, cameras=False, render_mode=None
        )
        self.addCleanup(env.close)
        with self.assertRaises(vlaprobe.Error) as raised:
            env.reset(seed=[0, 1])
        self.assertSays(raised.exception, "carrot_from_the_sky", "100 m")

    def test_make_envs_has_a_group_a_task(self):
        envs = vlaprobe.lerobot.make_envs(suite_plan(), "spoon_on_towel*", n_envs=2, cameras=False)
        self.assertEqual(list(envs), [task.name for task in suite_plan().select("spoon_on_towel*")])
        self.assertEqual({type(group[0]) for group in envs.values()}, {vlaprobe.lerobot.LeRobotVectorEnv})
        for group in envs.values():
            group[0].close()

    def test_envhub_file_makes_what_a_hub_repository_makes(self):
        path = os.path.join(SOURCE, "examples", "lerobot", "env.py")
        spec = importlib.util.spec_from_file_location("hub_env_someone_vlaprobe", path)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)

        class Config:
            task = TASK

        envs = module.make_env(n_envs=2, use_async_envs=False, cfg=Config())
        self.assertEqual(list(envs), [TASK])
        observation, _ = envs[TASK][0].reset(seed=[0, 1])
        self.assertEqual(len(observation["agent_pos"]), 2)
        envs[TASK][0].close()
        self.assertEqual(len(module.make_env()), len(vlaprobe.compile(vlaprobe.suite_file()).tasks))


@needs_lerobot
class WithLeRobotTest(Case):
    def test_plug_in_is_found_and_its_environments_are_evaluated(self):
        from lerobot.envs import EnvConfig, make_env, make_env_config, preprocess_observation
        from lerobot.envs.utils import check_env_attributes_and_types, close_envs, env_to_policy_features
        from lerobot.utils.import_utils import register_third_party_plugins

        register_third_party_plugins()
        self.assertIn("vlaprobe", EnvConfig.get_known_choices())
        config = make_env_config("vlaprobe", task=TASK, observation_width=48, observation_height=32)
        self.assertEqual((config.type, config.fps), ("vlaprobe", 5))
        features = env_to_policy_features(config)
        self.assertEqual(features["observation.images.third_view"].shape, (3, 32, 48))
        self.assertEqual(features["observation.state"].shape, (7,))
        self.assertEqual(features["action"].shape, (7,))
        envs = make_env(config, n_envs=2)
        (env,) = envs[TASK].values()
        check_env_attributes_and_types(env)
        observation, _ = env.reset(seed=[0, 1], options={"lerobot_new_rollout": True})
        batch = preprocess_observation(observation)
        self.assertEqual(set(batch), {key for key in features if key != "action"})
        for key, feature in features.items():
            if key != "action":
                self.assertEqual(tuple(batch[key].shape[1:]), feature.shape)
                self.assertEqual(batch[key].dtype, torch.float32)
        close_envs(envs)

    def test_rollout_and_eval_policy_run(self):
        try:
            from lerobot.scripts import lerobot_eval
        except ImportError as error:
            self.skipTest(f"lerobot_eval cannot be imported: {error}")
        from lerobot.envs import make_env, make_env_config

        class Expert(lerobot_eval.PreTrainedPolicy if isinstance(lerobot_eval.PreTrainedPolicy, type) else torch.nn.Module):
            config_class, name = None, "expert"

            def __init__(self):
                torch.nn.Module.__init__(self)

            def reset(self):
                self.worlds = ExpertVector(2, [1000 % 24, 1001 % 24])

            def select_action(self, batch):
                assert batch["task"] == ["put carrot on plate"] * 2
                assert batch["observation.state"].shape == (2, 7)
                return torch.from_numpy(self.worlds.actions())

            forward = predict_action_chunk = get_optim_params = select_action

        Expert.__abstractmethods__ = frozenset()
        envs = make_env(make_env_config("vlaprobe", task=TASK, observation_width=48, observation_height=32), n_envs=2)
        same = lambda batch: batch  # noqa: E731
        frames = []
        lerobot_eval.write_video = lambda path, pictures, fps: frames.append((pictures.shape, fps))
        with contextlib.redirect_stderr(io.StringIO()):
            told = lerobot_eval.eval_policy_all(
                envs, Expert(), same, same, same, same, n_episodes=2, max_episodes_rendered=2,
                videos_dir=__import__("pathlib").Path(self.folder()), start_seed=1000,
            )
        self.assertEqual(told["overall"]["pc_success"], 100.0)
        self.assertEqual(told["overall"]["avg_sum_reward"], 1.0)
        self.assertEqual(told["per_group"][TASK]["n_episodes"], 2)
        self.assertEqual(frames, [((60, 32, 48, 3), 5)] * 2)
        json.dumps(told)


if __name__ == "__main__":
    unittest.main()
