"""What goes wrong, as exceptions. Every message names the thing and the place."""

from __future__ import annotations

import json
from typing import Any


class Error(Exception):
    """Of vlaprobe. Pickles, so that worker processes can raise it.

    Attributes:
        code: what kind of thing failed: "io", "plan", "asset", "world", ... as in vlaprobe.h.
        where: the place, "" where the message alone says it.
    """

    def __init__(self, message: str, code: str = "usage", where: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.where = where

    def __reduce__(self) -> Any:
        return (type(self), (str(self), self.code, self.where))


class UsageError(Error, ValueError):
    """What was asked for cannot be: a name, a number, an order of calls."""


class ClosedError(UsageError):
    """An environment, or what it was made of, was used after its close()."""


class StoppedError(Error):
    """A callback asked for the end."""


class CompileError(Error):
    """A .probe text has mistakes. str() is the compiler's own rendering, source lines and carets included.

    Attributes:
        diagnostics: one dict a mistake or warning, with the keys of ``vlaprobe check --json``: code, severity,
            message, file, line, column, end_line, end_column, labels, fix, label, helps, notes. Lines and
            columns count from 1, columns in characters, ends are exclusive.
    """

    def __init__(self, message: str, diagnostics: list[dict[str, Any]] | None = None) -> None:
        super().__init__(message, "text", "")
        self.diagnostics = diagnostics or []

    @property
    def rendered(self) -> str:
        """The same as str()."""
        return str(self)

    def __reduce__(self) -> Any:
        return (CompileError, (str(self), self.diagnostics))


def _from_code(code: str, message: str, where: str, diagnostics: str) -> Error:
    if code == "text":
        return CompileError(message, json.loads(diagnostics or "[]"))
    kinds = {"usage": UsageError, "stopped": StoppedError}
    return kinds.get(code, Error)(message, code, where)
