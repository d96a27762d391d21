"""How far a call is: a line that is redrawn, in notebooks and on terminals."""

from __future__ import annotations

import math
import sys
import time
from typing import Any, Callable


NOT_ATTEMPTED = "not attempted: "  # how `invalid` begins where a policy of ours has no skill for the task


def _display() -> Any:
    """A handle of a notebook's output; None elsewhere."""
    try:
        from IPython import get_ipython
        from IPython.display import display
    except ImportError:
        return None
    shell = get_ipython()
    if shell is None or "IPKernelApp" not in shell.config:
        return None
    return display("...", display_id=True)


class Line:
    """Progress on a terminal or in a notebook; elsewhere nothing.

    Args:
        what: is counted: "episodes".
        good: key of a row that is true where it went well.
    """

    def __init__(self, what: str, good: str, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock, self._begun, self._drawn = clock, clock(), -math.inf
        self._what, self._good = what, good
        self._display = _display()
        self._invalid = 0
        self._well = 0
        self._on_terminal = self._display is None and sys.stderr is not None and sys.stderr.isatty()

    def __call__(self, told: dict) -> None:
        reason = told.get("invalid")
        self._invalid += reason is not None and not reason.startswith(NOT_ATTEMPTED)
        self._well += bool(told.get(self._good))
        now, there = self._clock(), told["done"] + told["skipped"]
        is_last = there == told["total"]
        if now - self._drawn < 0.1 and not is_last:
            return
        self._drawn = now
        text = self._text(told, now)
        if self._display is not None:
            self._display.update(text)
        elif self._on_terminal:
            print(f"\r\033[K{text}", end="\n" if is_last else "", file=sys.stderr, flush=True)

    def _text(self, told: dict, now: float) -> str:
        done, there = told["done"], told["done"] + told["skipped"]
        text = f"{there} of {told['total']} {self._what}"
        if done:
            word = {"success": "succeeded"}.get(self._good, self._good)
            text += f", {self._well} of {done - self._invalid} {word}"
        if self._invalid:
            text += f", {self._invalid} invalid"
        left = (now - self._begun) / done * (told["total"] - there) if done else 0
        if left >= 3600:
            text += f", {left / 3600:.1f} h left"
        elif left >= 60:
            text += f", {left / 60:.0f} min left"
        elif left >= 1:
            text += f", {left:.0f} s left"
        return text
