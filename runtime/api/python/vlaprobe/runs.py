"""Evaluating policies into folders, and reading what such folders hold."""

from __future__ import annotations

import html
import json
import os
import traceback
from typing import Any, Callable, Iterable, Optional, Union

import numpy as np

from . import _given, _vlaprobe
from ._given import flag, number, text, text_or_none, texts, whole
from ._progress import NOT_ATTEMPTED, Line
from .errors import UsageError
from .plan import Path, Plan, PlanLike, Task, plan_of

IF_CHANGED = {"refuse": 0, "fork": 1, "continue": 2}
_VIDEOS = {"none": 0, "failures": 1, "all": 2}
_LONGEST_REASON = 8000  # characters of an invalid row
_BY_SEARCH = "chosen by a search"  # what `until` is of a folder whose episodes a search chose

PolicyCallable = Callable[[dict], Any]


def reason(summary: str, trace: str = "") -> str:
    text = summary if not trace else f"{summary}\n{trace}"
    if len(text) <= _LONGEST_REASON:
        return text
    half = _LONGEST_REASON // 2
    return f"{text[:half]}\n...\n{text[-half:]}"


def _checked(policy: PolicyCallable) -> Callable[[dict], Any]:
    """What the library asks: an array of actions, or the sentence why there is none."""

    def answer(batch: dict) -> Any:
        n, size = len(batch["world"]), batch["action_size"]
        try:
            said = policy(batch)
        except Exception as error:
            # From the callable on: the frame of this function says nothing.
            trace = "".join(traceback.format_exception(type(error), error, error.__traceback__.tb_next))
            return reason(f"the callable raised {type(error).__name__}: {error}", trace.rstrip())
        wanted = f"actions of the shape ({n}, {size}) were wanted, one row an observation"
        try:
            actions = np.asarray(said)
        except Exception as error:
            return reason(f"the callable returned a {type(said).__name__} that is no array: {error}; {wanted}")
        if actions.dtype.kind not in "biuf":
            return f"the callable returned a {type(said).__name__}, which is no array of numbers; {wanted}"
        if actions.shape != (n, size):
            return f"the callable returned the shape {actions.shape}; {wanted}"
        return np.ascontiguousarray(actions, np.float64)

    return answer


class Results(list):
    """Rows of a run, a dict an episode with the keys of ``vlaprobe results --json``: task, episode, seed, policy, each
    metric by its name (bool or float; None where the episode is invalid or the task has none such), steps, invalid (why,
    or None), hashes of what was seen and done, and the path of the trace.

    Attributes:
        policy, plan_root, suite: what the run is of.
        only_success: whether only episodes that succeeded were kept (``vlaprobe demos``), so that nothing is a rate.
        until: what the run stops by (``vlaprobe run --until``), so that how many rows there are depends on them: intervals and
            tests of a fixed number of episodes do not hold, those of ``vlaprobe results`` do. Empty: all episodes were run.
        refused: sentences, one an episode whose trace does not bear its row; such rows are not here.
    """

    def __init__(self, told: dict) -> None:
        super().__init__(told["rows"])
        self.policy: str = told["policy"]
        self.plan_root: str = told["plan_root"]
        self.suite: str = told["suite"]
        self.only_success: bool = any(row.get("only_success", False) for row in self)
        self.until: str = told.get("until", "")
        self.refused: list[str] = told["refused"]

    @property
    def valid(self) -> list[dict]:
        """Rows that count."""
        return [row for row in self if row["invalid"] is None]

    @property
    def metrics(self) -> list[str]:
        """Names of the metrics that rows have."""
        keys = list(self[0]) if self else []
        return keys[keys.index("policy") + 1 : keys.index("steps")] if keys else []

    def counts(self, metric: str = "success") -> dict[str, tuple[int, int]]:
        """By task: (valid episodes where the metric is true, valid episodes). Tasks without it are not there.

        Raises:
            UsageError: no task has the metric; or the folder is of ``vlaprobe demos``, which keeps successes alone: a rate
                of its policy cannot be told from it.
        """
        if self.only_success:
            raise UsageError("the folder holds successes alone, as `vlaprobe demos` keeps them: how often its policy "
                             "succeeds cannot be told")
        if self and metric not in self.metrics:
            raise UsageError(f"no task of the run has a metric `{metric}`; there are {', '.join(self.metrics)}")
        counts: dict[str, tuple[int, int]] = {}
        for row in self.valid:
            if row[metric] is not None:
                yes, all_of_them = counts.get(row["task"], (0, 0))
                counts[row["task"]] = (yes + bool(row[metric]), all_of_them + 1)
        return counts

    def to_pandas(self) -> Any:
        """The rows as a pandas.DataFrame; needs pandas."""
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas() needs pandas, which is not installed; the rows are dicts") from None
        return pandas.DataFrame(list(self))

    def _uncounted(self) -> list[str]:
        """What no metric counts, in words."""
        not_attempted = sum((row["invalid"] or "").startswith(NOT_ATTEMPTED) for row in self)
        invalid = len(self) - len(self.valid) - not_attempted
        return [f"{invalid} invalid"] + ([f"{not_attempted} not attempted"] if not_attempted else [])

    def __repr__(self) -> str:
        return f"<results of {self.policy}: {len(self)} episodes{''.join(f', {text}' for text in self._uncounted())}>"

    def _repr_html_(self) -> str:
        """For notebooks: successes by task."""
        if self.only_success:
            return f"<p>{html.escape(self.policy)}: {len(self)} episodes, successes alone</p>"
        counts = self.counts() if "success" in self.metrics else {}
        rows = "".join(
            f"<tr><td>{html.escape(task)}</td><td>{yes} of {count}</td></tr>" for task, (yes, count) in counts.items()
        )
        note = f"<p>not counted: {', '.join(self._uncounted())}</p>" if len(self.valid) < len(self) else ""
        if self.until:
            by = self.until if self.until == _BY_SEARCH else f"stops by {self.until}"
            note += f"<p>{html.escape(by)}: counts, not rates of all</p>"
        return f"<p>{html.escape(self.policy)}</p><table><tr><th>task</th><th>success</th></tr>{rows}</table>{note}"


def _seed_of(seed: Any) -> int:
    """As the extension takes it: -1 is the lowest that is stored."""
    if seed is None:
        return -1
    if whole(seed, "`seed`") < 0:
        raise UsageError(f"a seed is a whole number from 0 on, found {seed}")
    return whole(seed, "`seed`")


class Run:
    """A folder of a run. Made by evaluate(), or by open_run() of one that is there.

    Attributes:
        folder: where it is.
        total, done, skipped, invalid, not_attempted: episodes of the call of evaluate() that made this object: chosen,
            run now, found in the folder, invalid, without a skill for the task. None behind open_run().
        not_attempted_reasons: of these, the most frequent first: dicts of `reason` and `episodes`.
        notes: sentences that a reader of the results should know.
        until: of a call that stops early, sentences of what is known of the rates.
    """

    def __init__(self, folder: Path, told: Optional[dict] = None) -> None:
        told = told or {}
        self.folder = os.fspath(folder)
        self.total: Optional[int] = told.get("total")
        self.done: Optional[int] = told.get("done")
        self.skipped: Optional[int] = told.get("skipped")
        self.invalid: Optional[int] = told.get("invalid")
        self.not_attempted: Optional[int] = told.get("not_attempted")
        self.not_attempted_reasons: list[dict[str, Any]] = told.get("not_attempted_reasons", [])
        self.notes: list[str] = told.get("notes", [])
        self.until: list[str] = told.get("until", [])
        self.speed: str = told.get("speed", "")

    def results(self) -> Results:
        """The rows that their traces bear; reads every trace."""
        return Results(json.loads(_vlaprobe.results(self.folder)))

    def why(
        self, task: Union[str, Task], episode: int, seed: Optional[int] = None, metric: Optional[str] = None
    ) -> dict[str, Any]:
        """A verdict explained: the dict of ``vlaprobe why ... --json``: task, episode, seed, steps, invalid, metrics with
        their values, the step that decided, and the conditions by source line with what was measured there.

        Args:
            seed: None: the lowest stored.
            metric: this one alone; None: all.
        """
        which = (name_of(task), whole(episode, "`episode`"), _seed_of(seed))
        return json.loads(_vlaprobe.why(self.folder, *which, text_or_none(metric, "`metric`")))

    def replay(
        self,
        task: Union[str, Task],
        episode: int,
        seed: Optional[int] = None,
        *,
        verify: bool = True,
        video: Optional[Path] = None,
        png: Optional[Path] = None,
        step: int = 0,
        camera: Optional[str] = None,
    ) -> dict[str, Any]:
        """A stored episode again, from its actions, in a fresh world.

        Args:
            verify: compare every measurement and hash with the trace, bit for bit.
            video: an .mp4 to write.
            png: a picture to write, of what the policy saw at control step `step`.
            camera: the one that is shown; None: all, side by side.

        Returns:
            steps, seed, identical (None where nothing was compared), difference (the first, "" of none) and
            fingerprint_differences (what is not as it was when the episode was recorded).
        """
        as_text = [None if path is None else os.fspath(path) for path in (video, png)]
        which = (name_of(task), whole(episode, "`episode`"), _seed_of(seed))
        shown = (whole(step, "`step`"), text_or_none(camera, "`camera`"), flag(verify, "`verify`"))
        return json.loads(_vlaprobe.replay(self.folder, *which, None, *as_text, *shown))

    def report(self, out: Path, **options: Any) -> dict[str, Any]:
        """One page of this run: report([self], out, ...)."""
        return report([self], out, **options)

    def _repr_html_(self) -> str:
        """For notebooks: where it is, and its successes by task."""
        notes = "".join(f"<p>{html.escape(note)}</p>" for note in self.notes)
        return f"<p><code>{html.escape(self.folder)}</code></p>{self.results()._repr_html_()}{notes}"

    def __fspath__(self) -> str:
        return self.folder

    def __repr__(self) -> str:
        what = "" if self.total is None else f": {self.total} episodes, {self.invalid} invalid"
        return f"<vlaprobe.Run {self.folder}{what}>"


def open_run(folder: Path) -> Run:
    """A run that is there, made by evaluate() or by the program."""
    if not os.path.isdir(folder):
        raise UsageError(f"{os.fspath(folder)}: there is no such folder")
    return Run(folder)


class Comparison(dict):
    """What really differs between two runs: the dict of ``vlaprobe compare A B --json``. str() and notebooks show the words,
    then the numbers.

    Attributes:
        words: sentences, most important first.
        notes: sentences on rows that are in no number.
    """

    def __init__(self, told: dict) -> None:
        super().__init__(told["comparison"])
        self._text: str = told["text"]
        self.notes: list[str] = told["notes"]

    @property
    def words(self) -> list[str]:
        return self["words"]

    def __str__(self) -> str:
        return self._text

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self._text)}</pre>"


def compare(a: Union[Run, Path], b: Union[Run, Path], metrics: Iterable[str] = ()) -> Comparison:
    """Two runs, or two models' answers, on the same starts: which differences are real, and how large.

    Args:
        metrics: of these only; empty: those of the tables.
    """
    chosen = texts(metrics, "`metrics`")
    return Comparison(json.loads(_vlaprobe.compare(os.fspath(a), os.fspath(b), chosen)))


def report(
    folders: Iterable[Union[Run, Path]],
    out: Path,
    *,
    title: Optional[str] = None,
    floors: Optional[Path] = None,
    traces: bool = True,
    jobs: int = 0,
) -> dict[str, Any]:
    """One page of these runs, as ``vlaprobe report``: opens from disk, offline.

    Args:
        out: the page that is written.
        floors: CSV of floors and ceilings measured before, as suite/floors.csv.
        traces: False: without timelines and explained verdicts.
        jobs: threads that read traces; 0: one a core.

    Returns:
        out, policies, episodes, and notes: sentences that a reader of the page should know.
    """
    if isinstance(folders, (str, os.PathLike)):
        raise UsageError(f"a report is of several folders, in a list, found {folders!r}")
    paths = [os.fspath(folder) for folder in folders]
    file = None if floors is None else os.fspath(floors)
    of = (paths, os.fspath(out), text_or_none(title, "`title`"))
    return json.loads(_vlaprobe.report(*of, file, flag(traces, "`traces`"), whole(jobs, "`jobs`")))


def teller(progress: Any, what: str, good: str) -> Optional[Callable[[dict], None]]:
    """Whom `progress` means; None: nobody."""
    if progress is True:
        return Line(what, good)
    if progress is False:
        return None
    if not callable(progress):
        raise UsageError(f"`progress` is True, False or a callable, found {progress!r}")
    return progress


def named(of: Any, name: Optional[str], what: str) -> str:
    """What rows call a callable."""
    name = text_or_none(name, "`name`") or getattr(of, "__name__", None) or type(of).__name__
    if name == "<lambda>":
        raise UsageError(f"a lambda has no name for the rows: give {what} a `name`")
    return name


def name_of(task: Any) -> str:
    """Of one task of a folder, by name or as a Task."""
    return task.name if isinstance(task, Task) else text(task, "`task`")


def glob_of(tasks: Any) -> str:
    """What `tasks` means to the program: one glob."""
    if isinstance(tasks, Task):
        return tasks.name
    if not isinstance(tasks, str):
        raise UsageError(f"`tasks` is one Task, or a glob such as 'carrot_*', found {tasks!r}")
    return text(tasks, "`tasks`")


def evaluate(
    policy: Union[str, PolicyCallable],
    plan: PlanLike,
    *,
    out: Path,
    tasks: Union[str, Task] = "*",
    name: Optional[str] = None,
    content: str = "",
    suite: Optional[str] = None,
    originals: bool = False,
    episodes: Optional[Union[int, tuple[int, int], range]] = None,
    seeds: Optional[Iterable[int]] = None,
    draws: bool = False,
    jobs: int = 1,
    batch: int = 0,
    gather_s: float = 0.1,
    video: str = "none",
    if_changed: str = "refuse",
    until: Optional[str] = None,
    progress: Union[bool, Callable[[dict], None]] = True,
) -> Run:
    """Runs every chosen episode once into a folder, as ``vlaprobe run`` does: with traces, proofs, and a second call that
    continues where the first one stopped.

    Args:
        policy: a callable, or what stands behind --policy ("expert", "openpi://HOST:PORT?profile=NAME").
            A callable is asked for all worlds that wait at once: ``policy(batch) -> actions``, an array of numbers (n, 7),
            or (n, action_size) where the robot is told its joints, as of vlaprobe.Env. `batch` is a dict of one row an observation:
            pixels: by camera, uint8 (n, height, width, 3); agent_pos: float64 (n, 8) and joints: float64 (n, j), as of
            Env; action_size: int; prompt, task: lists of str; world, episode, seed, step, horizon: int32 (n,); draw_seed: uint64 (n,), for
            policies that draw. An observation whose step is 0 begins an episode of its world: what a policy keeps
            of an episode, it keeps by world.
            What it raises, and what it returns that is no such array, makes the episodes that asked invalid with that
            reason (and the traceback); numbers that are not finite only those that they are for. The run goes on.
        plan: a Plan, or the path of a .plan or .probe file.
        out: the folder; made if absent. One that holds another plan, policy, content or build is refused.
        tasks: a glob over names, or one Task.
        name: what rows call a callable; needed where it has no __name__, is a lambda, or is called as a policy of the
            program's is.
        content: of a callable, what its name does not say, such as its weights' hash: two contents are not one run. Without
            it a callable that continues a folder does a stored episode again first, and is refused where an action is not
            the stored one, bit for bit; one that draws needs it, from the first call on.
        suite: default: the plan's first.
        originals: only tasks that are no variant of another.
        episodes: a number, a tuple (first, last) with both included, or a range of step 1; None: all.
        seeds: whole numbers, each once; None: the suite's; of a policy that draws nothing the first of them alone.
        draws: of a callable: two seeds may give two different episodes.
        jobs: worlds at a time, a thread each.
        batch: most observations in a call of the callable; 0: as many as there are jobs.
        gather_s: how long (s) an observation waits for those of other worlds at most.
        video: "none", "failures" or "all": OUT/videos/TASK/EPISODE-SEED.mp4.
        if_changed: "refuse", "fork" (write into OUT-2, ...) or "continue" (over another build).
        until: when to stop early: "width 10%" (of each task's interval, at 95 %), "width 5% of all", "decided-against DIR"; "none" runs
            what such a rule has left. None: every chosen episode is run.
        progress: True: a line on a terminal or in a notebook; False: none; or a callable that gets a dict of done, skipped,
            total and, but for the first, task, episode, seed, steps, success, invalid.

    Raises:
        UsageError: what cannot work is refused before there is a folder.
        Error: the folder, the assets, or a policy server.
        KeyboardInterrupt: Ctrl-C: episodes under way are not stored; the same call continues.
    """
    compiled: Plan = plan_of(plan)
    answer = None
    if not isinstance(policy, str):
        if not callable(policy):
            raise UsageError(f"a policy is a callable or the name of one of the program's, found {policy!r}")
        answer = _checked(policy)
        name = named(policy, name, "evaluate()")
    for word, known, what in ((if_changed, IF_CHANGED, "if_changed"), (video, _VIDEOS, "video")):
        if not isinstance(word, str) or word not in known:
            raise UsageError(f"{what} is one of {', '.join(known)}, found {word!r}")
    options = {
        "out": os.fspath(out),
        "policy": policy if isinstance(policy, str) else None,
        "name": text_or_none(name, "`name`"),
        "content": text(content, "`content`") or None,
        "suite": text_or_none(suite, "`suite`"),
        "tasks": glob_of(tasks),
        "originals": flag(originals, "`originals`"),
        "episodes": _given.episodes(episodes),
        "seeds": _given.seeds(seeds),
        "jobs": whole(jobs, "`jobs`"),
        "if_changed": IF_CHANGED[if_changed],
        "videos": _VIDEOS[video],
        "draws": flag(draws, "`draws`"),
        "batch": whole(batch, "`batch`"),
        "gather_s": number(gather_s, "`gather_s`"),
        "until": text_or_none(until, "`until`"),
    }
    tell = teller(progress, "episodes", "success")
    told = json.loads(_vlaprobe.run(compiled._handle, options, answer, tell))
    return Run(told["out"], told)
