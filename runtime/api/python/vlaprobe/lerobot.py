"""Worlds as LeRobot's evaluation asks for them (lerobot 0.6: lerobot-eval, EnvHub).

The observations are those of ``vlaprobe export --format lerobot``, so that a policy that was trained on such a dataset is
asked what it was taught: pictures under observation.images.CAMERA, observation.state (x, y, z, roll, pitch, yaw, gripper)
and observation.joints. Needs gymnasium, as LeRobot does; LeRobot itself is not imported here.
"""

from __future__ import annotations

from typing import Any, Iterable, Optional, Union

import numpy as np

from ._gym import Box, Dict, batch_space
from .errors import Error
from .plan import PlanLike, Task, plan_of
from .vec import VectorEnv

#: Of observation.state, as datasets have it.
STATE_NAMES = ("x", "y", "z", "roll", "pitch", "yaw", "gripper")

#: What LeRobot's rollout says with a reset that begins episodes.
_NEW_ROLLOUT = "lerobot_new_rollout"


def state_of(agent_pos: np.ndarray) -> np.ndarray:
    """float64 (..., 7) of float64 (..., 8): place (m), roll, pitch, yaw (rad, Rz(yaw) Ry(pitch) Rx(roll)) and the gripper
    from 0 closed to 1 open, of place, quaternion w, x, y, z, and the gripper."""
    place, (w, x, y, z), gripper = agent_pos[..., :3], np.moveaxis(agent_pos[..., 3:7], -1, 0), agent_pos[..., 7:]
    down = 2 * (w * y - x * z)
    level = np.hypot(1 - 2 * (y * y + z * z), 2 * (x * y + w * z))
    # Straight up or down only the sum or difference of roll and yaw is defined.
    steep = level < 1e-9
    roll = np.where(steep, 0.0, np.arctan2(2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
    yaw = np.where(
        steep,
        np.arctan2(2 * (w * z - x * y), 1 - 2 * (x * x + z * z)),
        np.arctan2(2 * (x * y + w * z), 1 - 2 * (y * y + z * z)),
    )
    pitch = np.arctan2(down, level)
    return np.concatenate([place, np.stack([roll, pitch, yaw], -1), gripper], -1)


class LeRobotVectorEnv(VectorEnv):
    """The worlds of one task, as ``lerobot.scripts.lerobot_eval`` uses them.

    What is not as in vlaprobe.VectorEnv:
        agent_pos: float64 (n, 7), as state_of() has it.
        A seed s begins the start s modulo the number of starts: n episodes with seeds that follow one another see each
            start as often as any other.
        is_success is true in an episode's last step alone, where the verdict counts: LeRobot takes an episode for a success
            when any of its steps says so, and a thing that was put down and knocked off again is none.
        A world that cannot go on raises: LeRobot has no episodes that count neither way.
    """

    def __init__(self, plan: PlanLike, task: Union[str, Task], **options: Any) -> None:
        super().__init__(plan, task, autoreset="same_step", **options)
        hz = self._tasks[0].control_hz
        self.metadata["render_fps"] = int(hz) if hz == int(hz) else hz
        spaces = dict(self.single_observation_space.spaces)
        spaces["agent_pos"] = Box(-np.inf, np.inf, (len(STATE_NAMES),), np.float64)
        self.single_observation_space = Dict(spaces)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)

    def reset(self, *, seed: Any = None, options: Optional[dict] = None) -> tuple[dict, dict]:
        options = {name: value for name, value in (options or {}).items() if name != _NEW_ROLLOUT}
        if seed is not None and "episode" not in options and self._episode is None:
            seeds = [seed + i for i in range(self.num_envs)] if isinstance(seed, (int, np.integer)) else list(seed)
            count = self._tasks[0].episodes
            options["episode"] = [None if one is None else int(one) % count for one in seeds]
        return self._judged(super().reset(seed=seed, options=options))

    def step(self, actions: Any) -> tuple[dict, np.ndarray, np.ndarray, np.ndarray, dict]:
        return self._judged(super().step(actions))

    def _judged(self, told: tuple) -> tuple:
        infos = told[-1]
        if "invalid" in infos:
            world = int(np.flatnonzero(infos["_invalid"])[0])
            raise Error(f"world {world} of task `{self.tasks[0]}` cannot go on: {infos['invalid'][world]}", "world")
        infos["is_success"][:] = False
        if "final_info" in infos:
            infos["is_success"] |= infos["final_info"]["is_success"]
        return told

    def _observations(self, array: Any) -> dict:
        observations = super()._observations(array)
        observations["agent_pos"] = state_of(observations["agent_pos"])
        return observations


def make_envs(
    plan: PlanLike, tasks: Union[str, Task, Iterable[Union[str, Task]]] = "*", n_envs: int = 1, **options: Any
) -> dict[str, dict[int, LeRobotVectorEnv]]:
    """As LeRobot's make_env() returns environments: {name of the task: {0: worlds}}. Worlds are made when they are reset.

    Args:
        plan: a Plan, or the path of a .plan or .probe file.
        tasks: a glob, a task or several.
        n_envs: worlds of each.
        options: of vlaprobe.make_vec(): threads, cameras, width, height, episode.
    """
    whole = plan_of(plan)
    return {task.name: {0: LeRobotVectorEnv(whole, task, num_envs=n_envs, **options)} for task in whole.select(tasks)}
