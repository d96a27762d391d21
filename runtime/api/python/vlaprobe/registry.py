"""Tasks under gymnasium's names: gymnasium.make("vlaprobe/carrot_on_plate-v0")."""

from __future__ import annotations

import os
from typing import Any, Iterable, Optional, Union

from . import _gym
from .env import Env
from .errors import UsageError
from .plan import PlanLike, Task, plan_of
from .vec import VectorEnv


def suite_file(name: str = "intact") -> str:
    """Path of a suite that comes with the package: "intact", "kitchen", "panda", "questions", ..."""
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "suite")
    path = os.path.join(folder, name + ".probe")
    if not os.path.isfile(path):
        there = sorted(file[: -len(".probe")] for file in os.listdir(folder) if file.endswith(".probe"))
        raise UsageError(f"no suite `{name}` comes with the package; there are {', '.join(there)}")
    return path


def make_registered(**options: Any) -> Env:
    """What gymnasium.make() calls."""
    return Env(**options)


def make_registered_vec(task: str, num_envs: int = 1, **options: Any) -> VectorEnv:
    """What gymnasium.make_vec() calls."""
    return VectorEnv(tasks=task, num_envs=num_envs, **options)


def register_envs(
    plan: Optional[PlanLike] = None,
    tasks: Union[str, Task, Iterable[Union[str, Task]]] = "*",
    *,
    namespace: str = "vlaprobe",
    version: int = 0,
    **options: Any,
) -> list[str]:
    """Tells gymnasium of a plan's tasks: make() and make_vec() know them then as ``vlaprobe/TASK-v0``.

    ``gymnasium.make(id, **options)`` takes the options of vlaprobe.make(), ``gymnasium.make_vec(id, num_envs=n, **options)``
    those of vlaprobe.make_vec(): worlds are stepped side by side by threads, unless another vectorization_mode is asked for.
    Episodes end by themselves at the task's horizon, so that no time limit is registered.

    Args:
        plan: a Plan, or the path of a .plan or .probe file; None: the suite `intact` that comes with the package.
        tasks: of these alone, see Plan.select().
        namespace, version: NAMESPACE/TASK-vVERSION. A second call with the same names replaces the first.
        options: of every environment that is made: cameras, width, height, ...

    Returns:
        the names.

    Raises:
        UsageError: gymnasium is not installed.
    """
    if _gym.gymnasium is None:
        raise UsageError("register_envs() tells gymnasium of tasks, which is not installed; make() works without it")
    from gymnasium.envs.registration import register, registry

    whole = plan_of(suite_file() if plan is None else plan)
    names = []
    for task in whole.select(tasks):
        name = f"{namespace}/{task.name}-v{version}"
        registry.pop(name, None)  # gymnasium warns of one that it knows
        register(
            name,
            entry_point="vlaprobe.registry:make_registered",
            vector_entry_point="vlaprobe.registry:make_registered_vec",
            kwargs={"plan": whole, "task": task.name, **options},
        )
        names.append(name)
    return names
