"""Asking models that see and read what a plan's questions ask, and reading what they answered."""

from __future__ import annotations

import html
import json
import os
import traceback
from typing import Any, Callable, Iterable, Optional, Union

from . import _given, _vlaprobe
from ._given import flag, pair, text, text_or_none, texts, whole
from .errors import UsageError
from .plan import Path, Plan, PlanLike, Task, compile, plan_of
from .runs import IF_CHANGED, glob_of, name_of, named, reason, teller

ModelCallable = Callable[[dict], str]


def _checked(model: ModelCallable) -> Callable[[dict], tuple[bool, str]]:
    """What the library asks: an answer, or the sentence why there is none."""

    def answer(asked: dict) -> tuple[bool, str]:
        try:
            said = model(asked)
        except Exception as error:
            # From the callable on: the frame of this function says nothing.
            trace = "".join(traceback.format_exception(type(error), error, error.__traceback__.tb_next))
            return False, reason(f"the callable raised {type(error).__name__}: {error}", trace.rstrip())
        if not isinstance(said, str):
            return False, f"the callable returned a {type(said).__name__}; a str was wanted, the model's words"
        if "\0" in said:
            return False, "the callable returned words with a zero byte"
        return True, said

    return answer


class AnswerRows(list):
    """Answers, a dict each with the keys of ``vlaprobe results --json``: question_id, start_id, rotation, arm, episode,
    seed, set, family, task, model, text (all words that were sent), expected, raw (what came), verdict (read, unclear,
    refused or empty), right (None where the row is invalid), invalid (why, or None), ... Every row is read again from its
    words; one that does not follow is invalid.

    Attributes:
        model, plan_root, suite: what the answers are of.
        notes: sentences that a reader of the numbers should know.
        scores: a dict a question ("SET.FAMILY") and arm: question, arm, right_in_every_order and right_in_one_order (dicts
            of right, asked, and a 95 % interval low, high, clustered by place), likeliest_in_every_order,
            likeliest_in_one_order (the same by the likeliest letter, None where the server gave no log-probabilities),
            luck_in_every_order, luck_in_one_order (0 to 1, or None), rows, unclear, cut, refused, empty, invalid,
            incomplete.
        left_out: a dict a question and reason: question, why, count: what pictures do not show is not asked of them.
    """

    def __init__(self, told: dict) -> None:
        super().__init__(told["rows"])
        self.model: str = told["model"]
        self.plan_root: str = told["plan_root"]
        self.suite: str = told["suite"]
        self.notes: list[str] = told["notes"]
        self.scores: list[dict] = told["scores"]
        self.left_out: list[dict] = told["left_out"]

    @property
    def valid(self) -> list[dict]:
        """Rows that count."""
        return [row for row in self if row["invalid"] is None]

    def counts(self, arm: str = "picture") -> dict[str, tuple[int, int]]:
        """By question: (starts answered rightly in every order of the options, starts with a verdict)."""
        return {
            row["question"]: (row["right_in_every_order"]["right"], row["right_in_every_order"]["asked"])
            for row in self.scores
            if row["arm"] == arm
        }

    def to_pandas(self) -> Any:
        """The rows as a pandas.DataFrame; needs pandas."""
        try:
            import pandas
        except ImportError:
            raise UsageError("to_pandas() needs pandas, which is not installed; the rows are dicts") from None
        return pandas.DataFrame(list(self))

    def __repr__(self) -> str:
        return f"<answers of {self.model}: {len(self)}, {len(self) - len(self.valid)} invalid>"

    def _repr_html_(self) -> str:
        """For notebooks: the scores."""

        def rate(told: dict) -> str:
            if not told["asked"]:
                return ""
            return f"{told['right']} of {told['asked']} ({100 * told['low']:.0f} to {100 * told['high']:.0f} %)"

        rows = "".join(
            f"<tr><td>{html.escape(row['question'])}</td><td>{row['arm']}</td>"
            f"<td>{rate(row['right_in_every_order'])}</td><td>{rate(row['right_in_one_order'])}</td>"
            f"<td>{row['unclear'] + row['refused'] + row['empty']}</td><td>{row['invalid']}</td></tr>"
            for row in self.scores
        )
        notes = "".join(f"<p>{html.escape(note)}</p>" for note in self.notes)
        return (
            f"<p>{html.escape(self.model)}</p><table><tr><th>question</th><th>arm</th><th>right in every order</th>"
            f"<th>right in one order</th><th>not read</th><th>invalid</th></tr>{rows}</table>{notes}"
        )


class Answers:
    """A folder of answers. Made by ask(), or by open_answers() of one that is there. compare() takes two of them, and
    report() takes them beside runs.

    Attributes:
        folder: where it is.
        total, done, skipped, invalid, right, left_out: questions of the call of ask() that made this object: chosen, asked
            now, found in the folder or left out, without a valid answer, answered rightly, left out now because the picture
            does not show what is asked. None behind open_answers().
        notes: sentences that a reader of the answers should know.
    """

    def __init__(self, folder: Path, told: Optional[dict] = None) -> None:
        told = told or {}
        self.folder = os.fspath(folder)
        for name in ("total", "done", "skipped", "invalid", "right", "left_out"):
            setattr(self, name, told.get(name))
        self.notes: list[str] = told.get("notes", [])
        self.speed: str = told.get("speed", "")

    def results(self) -> AnswerRows:
        """The rows, each read again from its words, and the scores."""
        return AnswerRows(json.loads(_vlaprobe.answers(self.folder)))

    def why(
        self, task: Union[str, Task], episode: int, seed: Optional[int] = None, question: Optional[str] = None
    ) -> dict[str, Any]:
        """One start's answers explained: the dict of ``vlaprobe why ANSWERS ... --json``: task, episode, model, instruction,
        and questions, each with its text, how the right answer is known, where it was written, and its answers.

        Args:
            seed: of the recorded episode, for questions at an end; None: all.
            question: "SET.FAMILY" or the family's name; None: all.
        """
        return json.loads(
            _vlaprobe.why_answers(
                self.folder,
                name_of(task),
                whole(episode, "`episode`"),
                -1 if seed is None else whole(seed, "`seed`"),
                text_or_none(question, "`question`"),
            )
        )

    def __fspath__(self) -> str:
        return self.folder

    def __repr__(self) -> str:
        what = "" if self.total is None else f": {self.total} questions, {self.invalid} invalid"
        return f"<vlaprobe.Answers {self.folder}{what}>"


def open_answers(folder: Path) -> Answers:
    """A folder of answers that is there, made by ask() or by the program."""
    if not os.path.isdir(folder):
        raise UsageError(f"{os.fspath(folder)}: there is no such folder")
    return Answers(folder)


def _joined(words: Union[None, str, Iterable[str]], what: str) -> Optional[str]:
    return None if words is None else ",".join(texts(words, what))


def ask(
    plan: PlanLike,
    model: Union[str, ModelCallable],
    *,
    out: Path,
    tasks: Union[str, Task] = "*",
    questions: Union[None, str, Iterable[str]] = None,
    arms: Union[str, Iterable[str]] = "picture",
    episodes: Optional[Union[int, tuple[int, int], range]] = None,
    frames: Optional[Path] = None,
    name: Optional[str] = None,
    content: str = "",
    suite: Optional[str] = None,
    size: Optional[tuple[int, int]] = None,
    camera: Optional[str] = None,
    jobs: int = 1,
    shard: Optional[tuple[int, int]] = None,
    retries: int = 2,
    give_up_after: int = 5,
    insecure: bool = False,
    if_changed: str = "refuse",
    progress: Union[bool, Callable[[dict], None]] = True,
) -> Answers:
    """Puts every chosen question about every chosen start to a model once, into a folder, as ``vlaprobe ask`` does: the
    pictures that policies get, right answers that the compiler proved or that are read off the picture, and a second call
    that continues where the first one stopped.

    Args:
        plan: a Plan, or the path of a .plan or .probe file, with ``questions`` in its text.
        model: what stands behind --model ("openai://HOST:PORT?model=NAME", "https://...", "truth", "random", "first"), or
            a callable: ``model(asked) -> str``, the model's words. `asked` is a dict: prompt (str: all words that are
            sent, options and how to answer among them), picture (uint8 (height, width, 3), None where none is shown), png
            (bytes: the same as a file), question ("SET.FAMILY"), task (str), arm (str), episode, rotation (int).
            With `jobs` it is called from as many threads, each holding the GIL while it runs Python. What it raises, and
            what it returns that is no str, makes the row invalid with that reason (and the traceback); the next call asks
            it again.
        out: the folder; made if absent. One that holds another plan, model, content or build is refused.
        tasks: a glob over names, or one Task.
        questions: SET or SET.FAMILY, with * and ?; one or several; None: all.
        arms: of "picture", "blind" (the same words without one), "prior" (with another start's): one or several.
        episodes: a number, a tuple (first, last) with both included, or a range of step 1; None: all.
        frames: folder of a run: its ends are what questions at the end are about.
        name: what rows call the model; of a callable needed where it has no __name__ or is a lambda.
        content: of a callable, what its name does not say, such as its weights' hash: two contents are not one folder.
            Without it a callable that goes on with a folder is asked one stored question again, and refused if it answers
            otherwise.
        suite: default: the first that is asked something. Of a path to a text that suite alone is compiled.
        size: of a callable: (width, height) of its pictures; None: the camera's own. A server's are in its address.
        camera: of a callable: whose pictures; None: the task's first.
        jobs: questions at the model at a time, a thread each.
        shard: (I, N): this call's share, of 1 to N.
        retries: how often a question that a server failed is asked again at once.
        give_up_after: stop when a server failed that many questions in a row; 0: never.
        insecure: any certificate of an https:// server; stored and told.
        if_changed: "refuse", "fork" (write into OUT-2, ...) or "continue" (over another build).
        progress: True: a line on a terminal or in a notebook; False: none; or a callable that gets a dict of done, skipped,
            total and, but for the first, question, task, episode, raw, right, invalid.

    Raises:
        UsageError: what cannot work is refused before there is a folder.
        Error: the folder, the assets, or a server.
        KeyboardInterrupt: Ctrl-C: the questions at the model are waited for and stored; the same call continues.
    """
    compiled: Plan
    if suite is not None and not isinstance(plan, Plan) and os.fspath(plan).endswith(".probe"):
        compiled = compile(plan, suite=text(suite, "`suite`"))
    else:
        compiled = plan_of(plan)
    answer = None
    if not isinstance(model, str):
        if not callable(model):
            raise UsageError(f"a model is a callable or an address, found {model!r}")
        answer = _checked(model)
        name = named(model, name, "ask()")
    elif size is not None or camera is not None or content:
        raise UsageError("size, camera and content are of a callable; a server's stand in its address: ?size=WxH&camera=NAME")
    if not isinstance(if_changed, str) or if_changed not in IF_CHANGED:
        raise UsageError(f"if_changed is one of {', '.join(IF_CHANGED)}, found {if_changed!r}")
    options = {
        "out": os.fspath(out),
        "model": model if isinstance(model, str) else None,
        "name": text_or_none(name, "`name`"),
        "content": text(content, "`content`") or None,
        "suite": text_or_none(suite, "`suite`"),
        "tasks": glob_of(tasks),
        "questions": _joined(questions, "`questions`"),
        "arms": _joined(arms, "`arms`"),
        "frames": None if frames is None else os.fspath(frames),
        "camera": text_or_none(camera, "`camera`"),
        "episodes": _given.episodes(episodes),
        "shard": None if shard is None else pair(shard, "`shard`"),
        "size": None if size is None else pair(size, "`size`"),
        "jobs": whole(jobs, "`jobs`"),
        "retries": whole(retries, "`retries`"),
        "give_up_after": whole(give_up_after, "`give_up_after`"),
        "insecure": flag(insecure, "`insecure`"),
        "if_changed": IF_CHANGED[if_changed],
    }
    tell = teller(progress, "answers", "right")
    told = json.loads(_vlaprobe.ask(compiled._handle, options, answer, tell))
    return Answers(told["out"], told)
