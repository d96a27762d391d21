"""One world as a gymnasium environment."""

from __future__ import annotations

import math
from typing import Any, Optional, Sequence, Union

import numpy as np

from . import _gym, _vlaprobe
from ._given import texts, whole_or_none
from ._gym import Box, Dict
from ._picture import Picture, png_of
from .errors import ClosedError, UsageError
from .plan import Plan, PlanLike, Task, plan_of

#: What sampling draws an action from: a control step's share of what arms do. Larger actions are accepted.
_REACH = np.array([0.05, 0.05, 0.05, 0.25, 0.25, 0.25, 1.0], np.float32)

Cameras = Union[bool, Sequence[str]]


def action_space(told: tuple[int, np.ndarray, np.ndarray]) -> Box:
    """Of a robot whose tool is moved: x, y, z of a translation (m) and of a rotation vector (rad) in the robot's base frame,
    done within one control step, and the gripper from -1 closed to 1 open. Of one that is told its joints (``joint_delta``,
    ``joint_position``): a step or a position of each arm joint (rad, m), and the gripper. The bounds are what sample() draws
    from; positions have the joints' limits."""
    kind, low, high = told
    if kind == _vlaprobe.TOOL:
        return Box(-_REACH, _REACH, dtype=np.float32)
    return Box(low.astype(np.float32), high.astype(np.float32), dtype=np.float32)


def observation_space(cameras: Sequence[tuple[str, int, int]], joints: int) -> Dict:
    """Of one world; see Env."""
    spaces: dict[str, Any] = {}
    if cameras:
        spaces["pixels"] = Dict({name: Box(0, 255, (height, width, 3), np.uint8) for name, height, width in cameras})
    spaces["agent_pos"] = Box(-math.inf, math.inf, (8,), np.float64)
    spaces["joints"] = Box(-math.inf, math.inf, (joints,), np.float64)
    return Dict(spaces)


def choose_cameras(all_names: Sequence[str], wanted: Cameras) -> list[int]:
    """Indices of the cameras that are shown."""
    if wanted is True:
        return list(range(len(all_names)))
    if wanted is False or wanted is None:
        return []
    wanted = texts(wanted, "`cameras`")
    for name in wanted:
        if name not in all_names:
            raise UsageError(f"there is no camera `{name}`; the task has {', '.join(all_names)}")
    return [i for i, name in enumerate(all_names) if name in wanted]


def check_options(options: Optional[dict], known: Sequence[str]) -> dict:
    """The options of a reset; a name that means nothing is an error."""
    if options is None:
        return {}
    if not isinstance(options, dict):
        raise UsageError(f"the options of reset() are a dict, found {options!r}")
    for name in options:
        if name not in known:
            raise UsageError(f"reset() has no option `{name}`; it has {', '.join(known)}")
    return options


def metrics_dict(names: Sequence[tuple[str, bool]], values: Sequence[float]) -> dict[str, Any]:
    """By name: truths as bool, measures as float; None where a metric is not the task's."""
    return {
        name: None if value != value else bool(value) if is_truth else float(value)
        for (name, is_truth), value in zip(names, values)
    }


class Env(_gym.Env):
    """A task as an environment, after gymnasium's conventions; its subclass where gymnasium is installed.

    Observations are a dict:
        pixels: a dict by camera of uint8 (height, width, 3), rows from the top, red green blue. Not there without
            cameras.
        agent_pos: float64 (8,): the tool centre point in the robot's base frame, x, y, z (m) and the quaternion
            w, x, y, z; openness of the gripper from 0 closed to 1 open.
        joints: float64 (n,): the robot's, rad and m, in the plan's drive order; names in ``joint_names``.

    Actions are numbers of any dtype, 7 unless the robot is told its joints, see ``action_space``. A step is one control step of the plan's robot.

    The reward is what `success` is behind the step less what it was before, so that an episode's rewards sum up to its
    success: 1 or 0. Episodes terminate where the task's text ends them (``ends when``), and are truncated at the horizon.
    As in a run, an episode that has succeeded goes on until then: the verdict counts at its end.

    ``info`` has: metrics (a dict, truths as bool), is_success (bool), prompt (str: what a policy is told now), task (str), episode_index (int: the start,
    not `episode`, under which gymnasium's wrappers keep statistics), steps (int), decided (bool: no verdict can change any more).

    Which episode reset() begins: ``options={"episode": 3}`` if given, else the one the environment was made with, else
    one drawn by ``seed``. Worlds themselves draw nothing: the same episode and actions give the same bits.

    Used by one thread at a time. Not usable in a forked child; pickles with the episode it is in, bit for bit, so that a
    copy goes on in another process.

    Attributes:
        task_description: the instruction as it is now, as LeRobot asks for it.
        task: name of the task.
        plan: its plan.
        camera_names, joint_names, object_names, metric_names: in the order of the arrays.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 5}

    def __init__(
        self,
        plan: PlanLike,
        task: Union[str, Task],
        *,
        episode: Optional[int] = None,
        cameras: Cameras = True,
        width: Optional[int] = None,
        height: Optional[int] = None,
        copy: bool = True,
        render_mode: Optional[str] = "rgb_array",
    ) -> None:
        if render_mode not in (None, "rgb_array"):
            raise UsageError(f"render_mode is None or 'rgb_array', found {render_mode!r}")
        self.plan: Plan = plan_of(plan)
        chosen = self.plan.select(task)
        if len(chosen) != 1:
            raise UsageError(f"make() wants one task; `{task}` means {len(chosen)}: make_vec() takes several")
        self._task = chosen[0]
        self._made_with = dict(
            episode=episode, cameras=cameras, width=width, height=height, copy=copy, render_mode=render_mode
        )
        self._episode = episode
        self._copy = copy
        self.render_mode = render_mode
        size = (whole_or_none(width, "`width`") or 0, whole_or_none(height, "`height`") or 0)
        self._stage: Optional[_vlaprobe.Stage] = _vlaprobe.Stage(
            self.plan._handle, self._task.index, *size, cameras is not False or render_mode is not None
        )
        all_cameras = self._stage.cameras()
        self._shown = choose_cameras([name for name, _, _ in all_cameras], cameras)
        self._draws = bool(self._shown)
        self._has_pictures = cameras is not False or render_mode is not None
        self.camera_names: list[str] = [all_cameras[i][0] for i in self._shown]
        self.joint_names: list[str] = self._stage.joint_names()
        self.object_names: list[str] = self._stage.object_names()
        self._metrics = self._stage.metrics()
        self.metric_names: list[str] = [name for name, _ in self._metrics]
        _, _, _, _, _, _, _, joints = self.plan._handle.task(self._task.index)
        self.observation_space = observation_space([all_cameras[i] for i in self._shown], joints)
        self.action_space = action_space(self._stage.action_space())
        self.metadata = dict(self.metadata, render_fps=self._task.control_hz)
        self._max_episode_steps = self._task.horizon
        self._success = False
        self._has_begun = False
        if episode is not None:
            self._check_episode(episode)

    # ---- gymnasium

    def reset(self, *, seed: Optional[int] = None, options: Optional[dict] = None) -> tuple[dict, dict]:
        """Begins an episode. Returns (observation, info).

        Args:
            seed: what episodes are drawn from where none is named.
            options: {"episode": number}.

        Raises:
            UsageError: no such episode or option.
            Error: the start cannot be used: its instruction does not hold once things have settled.
        """
        stage = self._open()
        super().reset(seed=seed)
        episode = check_options(options, ["episode"]).get("episode", self._episode)
        if episode is None:
            episode = int(self.np_random.integers(self._task.episodes))
        self._check_episode(episode)
        stage.reset(int(episode))
        self._has_begun = True
        self._success = False
        observation, info, _, _ = self._look()
        self._success = info["is_success"]
        return observation, info

    def step(self, action: Any) -> tuple[dict, float, bool, bool, dict]:
        """One control step: (observation, reward, terminated, truncated, info).

        Raises:
            TypeError, ValueError: the action is no array of as many finite numbers as the action space has.
            UsageError: nothing was reset, or the episode is over.
            Error: the simulation cannot go on; only reset() is accepted then.
        """
        self._open().step(action)
        observation, info, terminated, truncated = self._look()
        reward = float(info["is_success"]) - float(self._success)
        self._success = info["is_success"]
        return observation, reward, terminated, truncated, info

    def render(self) -> Optional[np.ndarray]:
        """What the task's first camera sees now: uint8 (height, width, 3)."""
        if self.render_mode is None:
            return None
        return np.asarray(self.picture())

    def close(self) -> None:
        """Gives the world back. A second time it does nothing; anything else raises ClosedError from then on."""
        stage, self._stage = self._stage, None
        if stage is not None:
            stage.close()

    # ---- beyond gymnasium

    @property
    def task_description(self) -> str:
        return self._task.instruction if self._stage is None else self._stage.instruction()

    @property
    def task(self) -> str:
        return self._task.name

    def picture(self, camera: Optional[str] = None, kind: str = "rgb") -> np.ndarray:
        """What a camera sees now, an array of its own; one of colours shows itself in a notebook.

        Args:
            camera: by name; None: the first.
            kind: "rgb": uint8 (height, width, 3); "depth": float32 (height, width), m along the camera's axis, 0 beyond
                10 m; "segmentation": uint16 (height, width), 0 nothing, 1 + number of the body (``body_names``), 65535
                what has no body.
        """
        kinds = {"rgb": _vlaprobe.RGB, "depth": _vlaprobe.DEPTH, "segmentation": _vlaprobe.SEGMENTATION}
        if kind not in kinds:
            raise UsageError(f"a picture is rgb, depth or segmentation, found {kind!r}")
        stage = self._open()
        names = [name for name, _, _ in stage.cameras()]
        if camera is not None and camera not in names:
            raise UsageError(f"there is no camera `{camera}`; the task has {', '.join(names)}")
        stage.observe()
        picture = stage.picture(0 if camera is None else names.index(camera), kinds[kind], True)
        return picture.view(Picture) if kind == "rgb" else picture

    @property
    def body_names(self) -> list[str]:
        """Of what segmentation and contacts count: objects first."""
        return self._open().body_names()

    def objects(self) -> np.ndarray:
        """float64 (k, 7): position (m) and quaternion w, x, y, z of the objects' model frames in the world."""
        return self._open().objects()

    def state_hash(self) -> str:
        """Of everything that moves, 64 hexadecimal digits, as traces have it for each step."""
        return self._open().hash()

    def save(self) -> bytes:
        """The episode as it is now; restore() goes back to it, here or in another environment of the same plan and
        task, also in another process: what follows is the same bit for bit."""
        return self._open().save()

    def restore(self, saved: bytes) -> tuple[dict, dict]:
        """Goes back to what save() gave. Returns (observation, info) as reset() does."""
        self._open().restore(bytes(saved))
        self._has_begun = True
        observation, info, _, _ = self._look()
        self._success = info["is_success"]
        return observation, info

    # ---- inside

    def _open(self) -> "_vlaprobe.Stage":
        if self._stage is None:
            raise ClosedError(f"the environment of task `{self._task.name}` was closed")
        return self._stage

    def _check_episode(self, episode: Any) -> None:
        if isinstance(episode, bool) or not isinstance(episode, (int, np.integer)):
            raise UsageError(f"an episode is a number from 0 to {self._task.episodes - 1}, found {episode!r}")
        if not 0 <= episode < self._task.episodes:
            raise UsageError(
                f"task `{self._task.name}` has no episode {episode}; it has {self._task.episodes}, from 0 on"
            )

    def _look(self) -> tuple[dict, dict, bool, bool]:
        stage = self._open()
        observation: dict[str, Any] = {}
        if self._draws:
            stage.observe()
            observation["pixels"] = {
                name: stage.picture(i, _vlaprobe.RGB, self._copy) for i, name in zip(self._shown, self.camera_names)
            }
        episode, steps, terminated, truncated, decided, success, tool, joints, metrics = stage.state()
        observation["agent_pos"] = tool
        observation["joints"] = joints
        info = {
            "metrics": metrics_dict(self._metrics, metrics),
            "is_success": success,
            "prompt": stage.instruction(),
            "task": self._task.name,
            "episode_index": episode,
            "steps": steps,
            "decided": decided,
        }
        return observation, info, terminated, truncated

    def _repr_png_(self) -> Optional[bytes]:
        """For notebooks: what the first camera sees now."""
        if self._stage is None or not self._has_begun or not self._has_pictures:
            return None
        return png_of(np.asarray(self.picture()))

    def __getstate__(self) -> dict:
        stage = self._open()
        saved: Optional[bytes] = stage.save() if self._has_begun else None
        return {
            "plan": self.plan,
            "task": self._task.name,
            "made_with": self._made_with,
            "saved": saved,
            "success": self._success,
            "random": self._np_random,
            "random_seed": self._np_random_seed,
        }

    def __setstate__(self, state: dict) -> None:
        self.__init__(state["plan"], state["task"], **state["made_with"])  # type: ignore[misc]
        self._np_random, self._np_random_seed = state["random"], state["random_seed"]
        if state["saved"] is not None:
            self._open().restore(state["saved"])
            self._has_begun = True
            self._success = state["success"]

    def __del__(self) -> None:
        # A half-made one has no stage.
        if getattr(self, "_stage", None) is not None:
            self.close()

    def __repr__(self) -> str:
        state = "closed, " if self._stage is None else ""
        return f"<vlaprobe.Env {state}{self._task.name}: {self._task.instruction!r}>"


def make(plan: PlanLike, task: Union[str, Task], **options: Any) -> Env:
    """An environment of one task: Env(plan, task, ...).

    Args:
        plan: a Plan, or the path of a .plan or .probe file.
        task: its name.
        episode: the start of every reset() that names none; None: drawn.
        cameras: True: all; False: none, nothing is drawn and a step costs the physics alone; or names.
        width, height: of the pictures, both; None: each camera's own size.
        copy: False: pictures are views of the world's own memory, read-only, of no meaning behind the next step or reset.
        render_mode: "rgb_array", or None.
    """
    return Env(plan, task, **options)
