"""Probing tasks for vision-language-action policies: compile, step, evaluate, read results.

::

    import vlaprobe
    plan = vlaprobe.compile("suite/intact.probe")
    env = vlaprobe.make(plan, "carrot_on_plate", episode=3)
    observation, info = env.reset()
    observation, reward, terminated, truncated, info = env.step([0, 0, 0.01, 0, 0, 0, 1])

Lengths are metres, angles radians, quaternions w, x, y, z; pictures are uint8 (height, width, 3) with rows from the top.
"""

from ._vlaprobe import __version__
from .asking import AnswerRows, Answers, ask, open_answers
from .env import Env, make
from .errors import ClosedError, CompileError, Error, StoppedError, UsageError
from .plan import Episode, Episodes, Placement, Plan, Suite, Task, compile, from_bytes, load
from .policies import Policy
from .registry import register_envs, suite_file
from .runs import Comparison, Results, Run, compare, evaluate, open_run, report
from .vec import VectorEnv, make_vec

__all__ = [
    "AnswerRows",
    "Answers",
    "ClosedError",
    "Comparison",
    "CompileError",
    "Env",
    "Episode",
    "Episodes",
    "Error",
    "Placement",
    "Plan",
    "Policy",
    "Results",
    "Run",
    "StoppedError",
    "Suite",
    "Task",
    "UsageError",
    "VectorEnv",
    "__version__",
    "ask",
    "compare",
    "compile",
    "evaluate",
    "from_bytes",
    "load",
    "make",
    "make_vec",
    "open_answers",
    "open_run",
    "register_envs",
    "report",
    "suite_file",
]
