"""Plans: compiled from .probe text or opened, and what is in them."""

from __future__ import annotations

import difflib
import html
import json
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Iterable, Iterator, Optional, Union

from . import _vlaprobe
from ._given import text_or_none
from ._picture import Picture, image_tag
from .errors import Error, UsageError

Path = Union[str, "os.PathLike[str]"]
# Where meshes and robots lie: a folder, or several; the first that has a thing gives it.
Folders = Union[Path, Sequence[Path]]


def _pattern(glob: str) -> "re.Pattern[str]":
    """As the program's --tasks: * and ?, nothing else is special."""
    return re.compile(re.escape(glob).replace(r"\*", ".*").replace(r"\?", "."), re.DOTALL)


def _absent(path: Optional[Path]) -> Optional[str]:
    return None if path is None else os.fspath(path)


def _lines(folders: Optional[Folders]) -> Optional[str]:
    if folders is None or isinstance(folders, (str, os.PathLike)):
        return _absent(folders)
    return "\n".join(os.fspath(folder) for folder in folders)


@dataclass(frozen=True)
class Task:
    """A task of a plan.

    Attributes:
        name: unique within the plan.
        instruction: what a policy is told, word for word.
        index: its place in the plan.
        baseline: name of the task that this one is a variant of, None of an original.
        episodes: how many starts it has, numbered from 0.
        horizon: control steps of an episode that nothing ends before.
        control_hz: control steps a second.
    """

    name: str
    instruction: str
    index: int
    baseline: Optional[str]
    episodes: int
    horizon: int
    control_hz: float
    _plan: "Plan"

    def _repr_html_(self) -> str:
        """For notebooks: what is said, and what is seen at the first start."""
        variant = f", a variant of {html.escape(self.baseline)}" if self.baseline else ""
        return (
            f"<p><b>{html.escape(self.name)}</b>{variant}: {html.escape(self.instruction)}<br>{self.episodes} episodes of "
            f"{self.horizon} steps, {self.control_hz:g} a second</p>{_picture_tag(self._plan.episodes(self)[0])}"
        )

    def describe(self) -> dict[str, Any]:
        """All that the plan says of it: the dict of ``vlaprobe show PLAN TASK --json`` (metres, degrees)."""
        return json.loads(self._plan._handle.describe(self.index))

    def __reduce__(self) -> Any:
        return (_task_of, (self._plan, self.name))

    def __repr__(self) -> str:
        return f"<task {self.name}: {self.instruction!r}, {self.episodes} episodes of {self.horizon} steps>"


def _task_of(plan: "Plan", name: str) -> Task:
    return plan.tasks[name]


@dataclass(frozen=True)
class Placement:
    """Where an object is put before it falls and settles: its model frame in the world.

    Attributes:
        object: its name in the plan.
        position: x, y, z in metres.
        rotation: unit quaternion w, x, y, z.
    """

    object: str
    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float]


@dataclass(frozen=True)
class Episode:
    """A start of a task.

    Attributes:
        task: name of the task.
        index: number of the start within the task, from 0.
        instruction: what a policy is told.
        episode_id: 64 hexadecimal digits; equal where start, words, scene and rule are.
        start_id: the same of the start alone.
        placements: of the task's objects, in their order.
    """

    task: str
    index: int
    instruction: str
    episode_id: str
    start_id: str
    placements: tuple[Placement, ...]
    _plan: "Plan" = field(repr=False, compare=False)

    def picture(self, camera: Optional[str] = None, width: Optional[int] = None, height: Optional[int] = None) -> "Picture":
        """What a policy sees first: uint8 (height, width, 3), which shows itself in a notebook. Makes a world for it.

        Args:
            camera: by name; None: the first.
            width, height: both; None: the camera's own.

        Raises:
            Error: the start cannot be used: its instruction does not hold once things have settled.
        """
        from .env import Env

        env = Env(self._plan, self._plan.tasks[self.task], episode=self.index, width=width, height=height)
        try:
            env.reset()
            return env.picture(camera)
        finally:
            env.close()

    def _repr_html_(self) -> str:
        """For notebooks: what is said and seen first."""
        return (
            f"<p><b>{html.escape(self.task)}</b> episode {self.index}: {html.escape(self.instruction)}</p>"
            + _picture_tag(self)
        )


def _picture_tag(episode: Episode, most: int = 320) -> str:
    """A start's picture within HTML, or why there is none."""
    words = f"{episode.task} episode {episode.index}"
    try:
        return image_tag(episode.picture(), words, most)
    except Error as error:
        return f"<p>{html.escape(words)}: {html.escape(str(error))}</p>"


class Tasks(Mapping):
    """The tasks of a plan by name, in the plan's order; a suite's prefix may stand before a name."""

    def __init__(self, plan: "Plan") -> None:
        rows = [plan._handle.task(i) for i in range(plan._handle.task_count)]
        names = [row[0] for row in rows]
        self._plan = plan
        self._tasks = {
            name: Task(name, words, i, None if baseline < 0 else names[baseline], episodes, horizon, hz, plan)
            for i, (name, words, baseline, episodes, horizon, hz, _cameras, _joints) in enumerate(rows)
        }
        self._names = names

    def __getitem__(self, name: str) -> Task:
        if name in self._tasks:
            return self._tasks[name]
        if not isinstance(name, str):
            raise KeyError(name)
        try:
            return self._tasks[self._names[self._plan._handle.find_task(name)]]
        except UsageError as error:
            raise KeyError(str(error)) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._tasks)

    def __len__(self) -> int:
        return len(self._tasks)

    def __repr__(self) -> str:
        return f"<{len(self)} tasks: {', '.join(self._names[:4])}{', ...' if len(self) > 4 else ''}>"


@dataclass(frozen=True)
class Suite:
    """A suite of a plan: names of its tasks, and the seeds that policies which draw are run with."""

    name: str
    prefix: str
    tasks: tuple[str, ...]
    seeds: tuple[int, ...]


class Episodes(Sequence):
    """Episodes of a plan, each read when it is looked at: a million cost no memory.

    A sequence of Episode; slices are Episodes again.
    """

    def __init__(self, plan: "Plan", rows: Sequence[tuple[Task, int]]) -> None:
        self._plan = plan
        self._rows = rows

    def __len__(self) -> int:
        return len(self._rows)

    def __getitem__(self, at: Any) -> Any:
        if isinstance(at, slice):
            return Episodes(self._plan, self._rows[at])
        task, index = self._rows[at]
        episode_id, start_id, placements = self._plan._handle.episode(task.index, index)
        return Episode(
            task.name,
            index,
            task.instruction,
            episode_id,
            start_id,
            tuple(Placement(*each) for each in placements),
            self._plan,
        )

    def to_dicts(self) -> list[dict[str, Any]]:
        """A dict an episode: task, episode, instruction, episode_id, start_id, and OBJECT.x, OBJECT.y, OBJECT.z (m),
        OBJECT.qw ... OBJECT.qz of every object that is placed."""
        rows = []
        for episode in self:
            row: dict[str, Any] = {
                "task": episode.task,
                "episode": episode.index,
                "instruction": episode.instruction,
                "episode_id": episode.episode_id,
                "start_id": episode.start_id,
            }
            for placed in episode.placements:
                numbers = (*placed.position, *placed.rotation)
                for name, number in zip(("x", "y", "z", "qw", "qx", "qy", "qz"), numbers):
                    row[f"{placed.object}.{name}"] = number
            rows.append(row)
        return rows

    def to_pandas(self) -> Any:
        """The same as a pandas.DataFrame; needs pandas."""
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas() needs pandas, which is not installed; to_dicts() does not") from None
        return pandas.DataFrame(self.to_dicts())

    def _repr_html_(self) -> str:
        """For notebooks: the first few, as a policy sees them."""
        most = 6
        shown = "".join(_picture_tag(episode, 220) for episode in self[:most])
        more = f"<p>and {len(self) - most} more</p>" if len(self) > most else ""
        return f"<p>{len(self)} episodes</p>{shown}{more}"

    def __repr__(self) -> str:
        return f"<{len(self)} episodes>"


class _Rows(Sequence):
    """(task, index) of all starts of some tasks, without a list of them."""

    def __init__(self, tasks: Sequence[Task], keep: Optional[range] = None) -> None:
        self._tasks = tasks
        self._begins = [0]
        for task in tasks:
            self._begins.append(self._begins[-1] + task.episodes)
        self._keep = range(self._begins[-1]) if keep is None else keep

    def __len__(self) -> int:
        return len(self._keep)

    def __getitem__(self, at: Any) -> Any:
        if isinstance(at, slice):
            return _Rows(self._tasks, self._keep[at])
        import bisect

        number = self._keep[at]
        task = bisect.bisect_right(self._begins, number) - 1
        return self._tasks[task], number - self._begins[task]


class Plan:
    """A compiled, verified plan. Made by compile() or load(); two of equal ``root`` are the same.

    Pickles, with its bytes. May be used by several threads.

    Attributes:
        root: the content address, 64 hexadecimal digits: what a paper cites.
        tasks: Task by name.
        suites: Suite by name.
        warnings: the compiler's, rendered; "" where there are none.
        diagnostics: the same as dicts, see CompileError.
        assets: the folders that its files are taken from: those that were named and those beside its
            texts, as a tuple; None where all are found by themselves.
    """

    def __init__(self, handle: "_vlaprobe.Plan") -> None:
        self._handle = handle
        self.assets: Optional[tuple[str, ...]] = tuple(handle.assets.split("\n")) if handle.assets else None
        self.root: str = handle.root
        self.tasks = Tasks(self)
        names = list(self.tasks)
        self.suites: dict[str, Suite] = {
            name: Suite(name, prefix, tuple(names[i] for i in members), tuple(seeds))
            for name, prefix, members, seeds in handle.suites()
        }

    @property
    def warnings(self) -> str:
        return self._handle.warnings

    @property
    def diagnostics(self) -> list[dict[str, Any]]:
        return json.loads(self._handle.diagnostics)

    def select(self, tasks: Union[str, Task, Iterable[Union[str, Task]]] = "*") -> list[Task]:
        """The tasks that a glob (``*`` and ``?``), a Task, or several of these mean, in the plan's order.

        Raises UsageError naming what no task is called, with the nearest name.
        """
        if not isinstance(tasks, (str, Task)) and not isinstance(tasks, Iterable):
            raise UsageError(f"a task is asked for by its name or a glob, found {tasks!r}")
        asked = [tasks] if isinstance(tasks, (str, Task)) else list(tasks)
        if not asked:
            raise UsageError("no task was asked for")
        prefixes = [""] + [suite.prefix for suite in self.suites.values() if suite.prefix]
        chosen = set()
        for one in asked:
            glob = one.name if isinstance(one, Task) else one
            if not isinstance(glob, str):
                raise UsageError(f"a task is asked for by its name or a glob, found {glob!r}")
            pattern = _pattern(glob)
            found = [name for name in self.tasks if any(pattern.fullmatch(prefix + name) for prefix in prefixes)]
            if not found:
                near = difflib.get_close_matches(glob, list(self.tasks), 1)
                hint = f", did you mean `{near[0]}`?" if near else f"; the plan has {len(self.tasks)} tasks"
                raise UsageError(f"no task is called `{glob}`{hint}")
            chosen.update(found)
        return [task for name, task in self.tasks.items() if name in chosen]

    def episodes(self, tasks: Union[str, Task, Iterable[Union[str, Task]]] = "*") -> Episodes:
        """The starts of these tasks (see select()), in the plan's order, read when they are looked at."""
        return Episodes(self, _Rows(self.select(tasks)))

    def to_bytes(self) -> bytes:
        """The plan as a .plan file has it."""
        return self._handle.bytes()

    def save(self, path: Path) -> None:
        """Writes a .plan file."""
        with open(path, "wb") as file:
            file.write(self.to_bytes())

    def list(self) -> "list[dict[str, Any]]":
        """A dict a task: task, baseline, axes, categories, prompt, episodes; as ``vlaprobe list --json``."""
        return json.loads(self._handle.list())

    def load(self, tasks: Union[str, Task, Iterable[Union[str, Task]]] = "*") -> None:
        """Reads meshes and robots of these tasks now, so that their first environment is made quickly."""
        self._handle.load([task.index for task in self.select(tasks)])

    def __copy__(self) -> "Plan":
        return self

    def __deepcopy__(self, memo: Any) -> "Plan":
        return self  # nothing of it changes

    def __eq__(self, other: Any) -> bool:
        return isinstance(other, Plan) and self.root == other.root

    def __hash__(self) -> int:
        return hash(self.root)

    def __reduce__(self) -> Any:
        return (from_bytes, (self.to_bytes(), self.assets))

    def __repr__(self) -> str:
        return f"<plan {self.root[:12]}: {len(self.tasks)} tasks, {len(self.episodes())} episodes>"

    def _repr_html_(self) -> str:
        """For notebooks: a table of the tasks."""
        most = 100
        rows = "".join(
            f"<tr><td>{html.escape(task.name)}</td><td>{html.escape(task.instruction)}</td>"
            f"<td>{html.escape(task.baseline or '')}</td><td>{task.episodes}</td><td>{task.horizon}</td></tr>"
            for task in [*self.tasks.values()][:most]
        )
        more = f"<p>and {len(self.tasks) - most} more</p>" if len(self.tasks) > most else ""
        return (
            f"<p>plan <code>{self.root[:12]}</code></p><table><tr><th>task</th><th>instruction</th>"
            f"<th>variant of</th><th>episodes</th><th>steps</th></tr>{rows}</table>{more}"
        )


def compile(  # noqa: A001 - the design's name
    *files: Path,
    suite: Optional[str] = None,
    tasks: Optional[str] = None,
    assets: Optional[Folders] = None,
    std: Optional[Path] = None,
) -> Plan:
    """Compiles .probe files into a plan, as ``vlaprobe build`` does: same text and assets, same plan.

    Args:
        files: one or more paths.
        suite: the one suite to compile; None: all.
        tasks: a glob; only these tasks are compiled. For assets that do not serve every task.
        assets: folder of meshes and robots, or several, the first that has a thing giving it; None: beside
            the texts, then $VLAPROBE_ASSETS, else beside the library.
        std: folder that holds ``std/``; None: $VLAPROBE_STD, else beside the library.

    Raises:
        CompileError: the text has mistakes; rendered and as data.
        Error: a file or the assets cannot be read.
    """
    if not files:
        raise UsageError("compile() wants the path of a .probe file")
    folders = _lines(assets)
    paths = [os.fspath(file) for file in files]
    only = (text_or_none(suite, "`suite`"), text_or_none(tasks, "`tasks`"))
    return Plan(_vlaprobe.Plan.compile(paths, folders, _absent(std), *only))


def load(path: Path, assets: Optional[Folders] = None) -> Plan:
    """Opens a .plan file, verifying it whole. A path that ends in .probe is compiled instead."""
    name = os.fspath(path)
    if name.endswith(".probe"):
        return compile(name, assets=assets)
    return Plan(_vlaprobe.Plan.open(name, _lines(assets)))


def from_bytes(data: bytes, assets: Optional[Folders] = None) -> Plan:
    """A plan from the bytes of a .plan file."""
    return Plan(_vlaprobe.Plan.from_bytes(bytes(data), _lines(assets)))


PlanLike = Union[Plan, Path]


def plan_of(plan: PlanLike) -> Plan:
    """A Plan as it is; a path opened or compiled."""
    return plan if isinstance(plan, Plan) else load(plan)
