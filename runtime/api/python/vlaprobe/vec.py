"""Several worlds at a time as a gymnasium vector environment, stepped by threads of the library."""

from __future__ import annotations

from typing import Any, Iterable, Optional, Union

import numpy as np

from . import _gym, _vlaprobe
from ._given import whole, whole_or_none
from ._gym import AutoresetMode, batch_space
from .env import Cameras, action_space, check_options, choose_cameras, observation_space
from .errors import ClosedError, UsageError
from .plan import Plan, PlanLike, Task, plan_of

_MODES = {
    "next_step": (AutoresetMode.NEXT_STEP, _vlaprobe.NEXT_STEP),
    "same_step": (AutoresetMode.SAME_STEP, _vlaprobe.SAME_STEP),
    "disabled": (AutoresetMode.DISABLED, _vlaprobe.DISABLED),
}


def _mode(autoreset: Any) -> tuple[AutoresetMode, int]:
    for word, (mode, number) in _MODES.items():
        if autoreset in (word, mode):
            return mode, number
    raise UsageError(f"autoreset is one of {', '.join(_MODES)}, found {autoreset!r}")


class VectorEnv(_gym.VectorEnv):
    """Worlds side by side, after gymnasium's conventions for vector environments.

    Observations, actions, rewards and episodes are those of vlaprobe.Env, one row a world; ``infos`` has its keys as
    arrays, each with a mask ``_key``, and ``invalid`` (str) where a world could not go on: its episode is truncated then,
    counts neither as success nor as failure, and the world's next step begins another one.

    A world is given one of several tasks by turns: with no more tasks than worlds, world i keeps task i modulo their
    number; with more, it draws among the tasks i, i + num_envs, ... Episodes are drawn by each world's own seed, as Env
    draws them.

    Autoreset: "next_step": the step behind an episode's last one ignores its action and returns the next one's first
    observation, reward 0 and both flags false. "same_step": the last step returns the next episode's first observation;
    infos["final_obs"] (object array of observations) and infos["final_info"] (arrays) have what the episode ended with.
    "disabled": reset(options={"reset_mask": bool array}) begins the next ones; stepping before that raises.

    Attributes:
        tasks: names of the tasks that the worlds are given.
        plan: their plan.
        camera_names, metric_names: in the order of the arrays.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 5}

    def __init__(
        self,
        plan: PlanLike,
        tasks: Union[str, Task, Iterable[Union[str, Task]]] = "*",
        *,
        num_envs: int = 1,
        threads: int = 0,
        autoreset: Any = "next_step",
        episode: Optional[int] = None,
        cameras: Cameras = True,
        width: Optional[int] = None,
        height: Optional[int] = None,
        copy: bool = True,
        render_mode: Optional[str] = "rgb_array",
    ) -> None:
        self._batch: Optional[_vlaprobe.Batch] = None
        if render_mode not in (None, "rgb_array"):
            raise UsageError(f"render_mode is None or 'rgb_array', found {render_mode!r}")
        self.plan: Plan = plan_of(plan)
        self._tasks = self.plan.select(tasks)
        self.tasks = [task.name for task in self._tasks]
        mode, number = _mode(autoreset)
        self.num_envs = whole(num_envs, "`num_envs`")
        size = (whole_or_none(width, "`width`") or 0, whole_or_none(height, "`height`") or 0)
        self._copy = copy
        self._mode = mode
        self.render_mode = render_mode
        self._episode = episode
        pools = [self._tasks[i % len(self._tasks) :: self.num_envs] for i in range(self.num_envs)] if num_envs > 0 else []
        if len(self._tasks) <= self.num_envs:
            pools = [[self._tasks[i % len(self._tasks)]] for i in range(self.num_envs)]
        self._pools = pools
        self._batch = _vlaprobe.Batch(
            self.plan._handle,
            [task.index for task in self._tasks],
            self.num_envs,
            whole(threads, "`threads`"),
            *size,
            cameras is not False,
            number,
        )
        all_names = self._batch.cameras()
        self._shown = choose_cameras(all_names, cameras)
        self.camera_names: list[str] = [all_names[i] for i in self._shown]
        self._metrics = self._batch.metrics()
        self.metric_names: list[str] = [name for name, _ in self._metrics]
        sizes = []
        for i in self._shown:
            _, high, wide, _ = self._batch.array(_vlaprobe.FIELD_RGB, i, False).shape
            sizes.append((all_names[i], high, wide))
        joints = self._batch.array(_vlaprobe.FIELD_JOINTS, 0, False).shape[1]
        self.single_observation_space = observation_space(sizes, joints)
        self.single_action_space = action_space(self._batch.action_space())
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self.metadata = dict(self.metadata, render_fps=self._tasks[0].control_hz, autoreset_mode=mode)
        self._randoms: list[Optional[np.random.Generator]] = [None] * self.num_envs
        self._success = np.zeros(self.num_envs, bool)
        self._over = np.zeros(self.num_envs, bool)
        self._has_begun = False
        self._next: Optional[list[tuple[int, int]]] = None
        if episode is not None:
            for task in self._tasks:
                self._check_episode(task, episode)

    # ---- gymnasium

    def reset(self, *, seed: Any = None, options: Optional[dict] = None) -> tuple[dict, dict]:
        """Begins an episode in every world, or in those of the mask. Returns (observations, infos).

        Args:
            seed: s gives world i the seed s + i; or one a world, None among them to leave it.
            options: {"episode": number or one a world, "task": name or one a world, "reset_mask": bool (num_envs,)}.
        """
        batch = self._open()
        options = check_options(options, ["episode", "task", "reset_mask"])
        mask = self._mask(options.get("reset_mask"))
        seeds = [None] * self.num_envs if seed is None else seed
        if isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + i for i in range(self.num_envs)]
        if not hasattr(seeds, "__len__"):
            raise UsageError(f"a seed is a whole number, or one a world, found {seed!r}")
        if len(seeds) != self.num_envs:
            raise UsageError(f"{len(seeds)} seeds for {self.num_envs} worlds")
        for i, own in enumerate(seeds):
            if own is not None:
                self._randoms[i] = _gym.new_random(own)[0]
        episodes, tasks = self._each(options, "episode"), self._each(options, "task")
        starts = []
        for i in range(self.num_envs):
            if not mask[i]:
                starts.append((self._tasks[0].index, 0))  # not read
            elif tasks[i] is None and episodes[i] is None:
                # What would have come next, unless another seed was given.
                starts.append(self._next[i] if self._next and seeds[i] is None else self._draw(i))
            else:
                starts.append(self._named(i, tasks[i], episodes[i]))
        batch.reset(None if mask.all() else mask.tolist(), starts)
        self._over[mask] = False
        self._has_begun = True
        if self._mode is not AutoresetMode.DISABLED:
            kept = self._next
            self._next = [self._draw(i) if kept is None or mask[i] else kept[i] for i in range(self.num_envs)]
        observations = self._observations(batch.array)
        self._success = self._flags(_vlaprobe.FIELD_SUCCESS)
        return observations, self._infos(batch.array, mask)

    def step(self, actions: Any) -> tuple[dict, np.ndarray, np.ndarray, np.ndarray, dict]:
        """One control step of every world: (observations, rewards float64 (n,), terminations bool (n,),
        truncations bool (n,), infos).

        Args:
            actions: numbers (num_envs, n), see ``single_action_space``.

        Raises:
            TypeError, ValueError: the actions are no such array, or not finite.
            UsageError: nothing was reset, or with autoreset "disabled" a world's episode is over.
        """
        batch = self._open()
        if not self._has_begun:
            raise UsageError("no episode has begun: reset first")
        batch.step(actions, self._next)
        terminations = self._flags(_vlaprobe.FIELD_TERMINATED)
        truncations = self._flags(_vlaprobe.FIELD_TRUNCATED)
        begun = self._flags(_vlaprobe.FIELD_BEGUN)
        success = self._flags(_vlaprobe.FIELD_SUCCESS)
        every = np.ones(self.num_envs, bool)
        faults = [batch.fault(i) for i in range(self.num_envs)]
        failed = np.array([fault is not None for fault in faults])
        ended = terminations | truncations
        at_end = np.zeros(self.num_envs, bool)
        if self._mode is AutoresetMode.SAME_STEP:
            at_end = self._flags(_vlaprobe.FIELD_ENDED)  # whether or not the next episode could begin
        achieved = success
        if at_end.any():
            final = batch.final(_vlaprobe.FIELD_SUCCESS, 0, True).astype(bool)
            achieved = np.where(at_end, final, success)
        rewards = achieved.astype(np.float64) - self._success
        rewards[(begun | failed) & ~at_end] = 0.0
        observations = self._observations(batch.array)
        infos = self._infos(batch.array, every)
        if failed.any():
            infos["invalid"] = np.array(faults, dtype=object)
            infos["_invalid"] = failed
        if at_end.any():
            self._add_final(infos, at_end)
        if self._next is not None:
            used = self._over | ended if self._mode is AutoresetMode.SAME_STEP else self._over
            self._next = [self._draw(i) if used[i] else self._next[i] for i in range(self.num_envs)]
        self._over = failed if self._mode is AutoresetMode.SAME_STEP else ended
        self._success = success
        return observations, rewards, terminations, truncations, infos

    def render(self) -> Optional[tuple[np.ndarray, ...]]:
        """What the first camera of each world sees: a tuple of uint8 (height, width, 3)."""
        if self.render_mode is None or not self._shown:
            return None
        return tuple(self._open().array(_vlaprobe.FIELD_RGB, 0, True))

    def close_extras(self, **kwargs: Any) -> None:
        batch, self._batch = self._batch, None
        if batch is not None:
            batch.close()

    # ---- as gymnasium's own vector environments

    def call(self, name: str, *args: Any, **kwargs: Any) -> tuple:
        """An attribute of every world: task_description, task, _max_episode_steps, spec; or `render`, called."""
        if name == "render":
            return self.render() or (None,) * self.num_envs
        values = self.get_attr(name)
        return tuple(value(*args, **kwargs) if callable(value) else value for value in values)

    def get_attr(self, name: str) -> tuple:
        per_world = {
            "task_description": lambda task: task.instruction,
            "task": lambda task: task.name,
            "_max_episode_steps": lambda task: task.horizon,
        }
        if name in per_world:
            by_index = {task.index: task for task in self._tasks}
            now = self._open().array(_vlaprobe.FIELD_TASK, 0, True)
            tasks = [by_index.get(int(task), self._pools[i][0]) for i, task in enumerate(now)]
            if not self._has_begun:
                tasks = [pool[0] for pool in self._pools]
            said = [per_world[name](task) for task in tasks]
            if name == "task_description" and self._has_begun:
                said = [self._open().instruction(i) or words for i, words in enumerate(said)]
            return tuple(said)
        return tuple(getattr(self, name) for _ in range(self.num_envs))

    def set_attr(self, name: str, values: Any) -> None:
        raise UsageError(f"a world's `{name}` cannot be set")

    def state_hashes(self) -> list[str]:
        """Of everything that moves in each world, as Env.state_hash()."""
        return [self._open().hash(i) for i in range(self.num_envs)]

    # ---- inside

    def _open(self) -> "_vlaprobe.Batch":
        if self._batch is None:
            raise ClosedError("the vector environment was closed")
        return self._batch

    @staticmethod
    def _check_episode(task: Task, episode: Any) -> None:
        if isinstance(episode, bool) or not isinstance(episode, (int, np.integer)):
            raise UsageError(f"an episode is a number from 0 to {task.episodes - 1}, found {episode!r}")
        if not 0 <= episode < task.episodes:
            raise UsageError(f"task `{task.name}` has no episode {episode}; it has {task.episodes}, from 0 on")

    def _mask(self, given: Any) -> np.ndarray:
        if given is None:
            return np.ones(self.num_envs, bool)
        mask = np.asarray(given)
        if mask.dtype != bool or mask.shape != (self.num_envs,):
            raise UsageError(
                f"reset_mask is a bool array of the shape ({self.num_envs},); found {mask.dtype} {mask.shape}"
            )
        if not mask.any():
            raise UsageError("reset_mask is false of every world")
        return mask

    def _each(self, options: dict, name: str) -> list:
        given = options.get(name)
        if given is None or isinstance(given, (str, int, np.integer, Task)):
            return [given] * self.num_envs
        if not hasattr(given, "__len__"):
            raise UsageError(f"option `{name}` is one value or one a world, found {given!r}")
        if len(given) != self.num_envs:
            raise UsageError(f"option `{name}` has {len(given)} values for {self.num_envs} worlds")
        return list(given)

    def _random(self, world: int) -> np.random.Generator:
        own = self._randoms[world]
        if own is None:
            own = self._randoms[world] = _gym.new_random()[0]
        return own

    def _draw(self, world: int) -> tuple[int, int]:
        pool = self._pools[world]
        task = pool[0] if len(pool) == 1 else pool[int(self._random(world).integers(len(pool)))]
        if self._episode is not None:
            return task.index, int(self._episode)
        return task.index, int(self._random(world).integers(task.episodes))

    def _named(self, world: int, task: Any, episode: Any) -> tuple[int, int]:
        chosen = self._pools[world][0]
        if task is not None:
            found = self.plan.select(task)
            if len(found) != 1 or found[0] not in self._tasks:
                raise UsageError(f"`{task}` is no task of this vector environment; it has {', '.join(self.tasks)}")
            chosen = found[0]
        if episode is None:
            episode = self._episode
        if episode is None:
            episode = int(self._random(world).integers(chosen.episodes))
        self._check_episode(chosen, episode)
        return chosen.index, int(episode)

    def _flags(self, field: int) -> np.ndarray:
        return self._open().array(field, 0, True).astype(bool)

    def _observations(self, array: Any) -> dict:
        observations: dict[str, Any] = {}
        if self._shown:
            observations["pixels"] = {
                name: array(_vlaprobe.FIELD_RGB, i, self._copy) for i, name in zip(self._shown, self.camera_names)
            }
        tool = array(_vlaprobe.FIELD_TOOL, 0, False)
        openness = array(_vlaprobe.FIELD_OPENNESS, 0, False)
        observations["agent_pos"] = np.concatenate([tool, openness[:, None]], axis=1)
        observations["joints"] = array(_vlaprobe.FIELD_JOINTS, 0, self._copy)
        return observations

    def _prompts(self, tasks: list[Any], is_now: bool) -> np.ndarray:
        """What policies are told; of an episode that has ended its first sentence."""
        told = [task.instruction if task else None for task in tasks]
        if is_now:
            told = [self._open().instruction(i) if task else None for i, task in enumerate(tasks)]
        return np.array(told, dtype=object)

    def _infos(self, array: Any, mask: np.ndarray, is_now: bool = True) -> dict:
        by_index = {task.index: task for task in self._tasks}
        tasks = [by_index.get(int(task)) for task in array(_vlaprobe.FIELD_TASK, 0, False)]
        values = array(_vlaprobe.FIELD_METRICS, 0, True)
        metrics: dict[str, Any] = {}
        for i, (name, is_truth) in enumerate(self._metrics):
            known = ~np.isnan(values[:, i]) & mask
            metrics[name] = np.where(known, values[:, i], 0).astype(bool if is_truth else np.float64)
            metrics["_" + name] = known
        infos: dict[str, Any] = {
            "metrics": metrics,
            "is_success": array(_vlaprobe.FIELD_SUCCESS, 0, True).astype(bool) & mask,
            "prompt": self._prompts(tasks, is_now),
            "task": np.array([task.name if task else None for task in tasks], dtype=object),
            "episode_index": array(_vlaprobe.FIELD_EPISODE, 0, True).astype(np.int64),
            "steps": array(_vlaprobe.FIELD_STEPS, 0, True).astype(np.int64),
            "decided": array(_vlaprobe.FIELD_DECIDED, 0, True).astype(bool) & mask,
        }
        for name in list(infos):
            infos["_" + name] = mask.copy()
        return infos

    def _add_final(self, infos: dict, at_end: np.ndarray) -> None:
        final = self._open().final
        last = self._observations(final)
        observations = np.full(self.num_envs, None, dtype=object)
        for i in np.flatnonzero(at_end):
            observations[i] = _row(last, i)
        infos["final_obs"], infos["_final_obs"] = observations, at_end.copy()
        infos["final_info"], infos["_final_info"] = self._infos(final, at_end, is_now=False), at_end.copy()

    def __reduce__(self) -> Any:
        raise UsageError("a vector environment has threads and cannot be pickled; pickle its plan, or an Env")

    def __del__(self) -> None:
        if getattr(self, "_batch", None) is not None:
            self.close_extras()

    def __repr__(self) -> str:
        state = "closed, " if self._batch is None else ""
        return f"<vlaprobe.VectorEnv {state}{self.num_envs} worlds, {len(self._tasks)} tasks>"


def _row(observations: Any, world: int) -> Any:
    if isinstance(observations, dict):
        return {name: _row(inner, world) for name, inner in observations.items()}
    return np.array(observations[world])


def make_vec(
    plan: PlanLike, tasks: Union[str, Task, Iterable[Union[str, Task]]] = "*", **options: Any
) -> VectorEnv:
    """Several worlds at a time: VectorEnv(plan, tasks, ...).

    Args:
        plan: a Plan, or the path of a .plan or .probe file.
        tasks: a glob, a task or several; they must show alike (cameras, joints) and take actions of one kind.
        num_envs: worlds.
        threads: that step them; 0: one a core.
        autoreset: "next_step", "same_step" or "disabled", or gymnasium's AutoresetMode.
        episode: the start of every episode that names none; None: drawn.
        cameras, width, height, render_mode: as of make().
        copy: False: arrays are views of memory that the next step writes.
    """
    return VectorEnv(plan, tasks, **options)
