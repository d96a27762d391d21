"""What callers give, as the extension takes it: another type is refused by the argument's name, and nothing is rounded,
cut or read as something else."""

from __future__ import annotations

import operator
from typing import Any, Iterable, Optional

import numpy as np

from .errors import UsageError

_MOST = 2**31 - 1  # of the extension's whole numbers


def whole(given: Any, what: str) -> int:
    """A whole number: no bool, no fraction, no text."""
    if not isinstance(given, (bool, np.bool_)):
        try:
            number = operator.index(given)
        except TypeError:
            pass
        else:
            if abs(number) <= _MOST:
                return number
            raise UsageError(f"{what} is a whole number of at most {_MOST}, found {number}")
    raise UsageError(f"{what} is a whole number, found {given!r}")


def whole_or_none(given: Any, what: str) -> Optional[int]:
    return None if given is None else whole(given, what)


def pair(given: Any, what: str) -> tuple[int, int]:
    """Two whole numbers in a tuple or list."""
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise UsageError(f"{what} are two whole numbers, found {given!r}")
    return whole(given[0], what), whole(given[1], what)


def number(given: Any, what: str) -> float:
    """A number, whole or not."""
    if isinstance(given, (bool, np.bool_, str, bytes)):
        raise UsageError(f"{what} is a number, found {given!r}")
    try:
        return float(given)
    except (TypeError, ValueError):
        raise UsageError(f"{what} is a number, found {given!r}") from None


def flag(given: Any, what: str) -> bool:
    if not isinstance(given, (bool, np.bool_)):
        raise UsageError(f"{what} is True or False, found {given!r}")
    return bool(given)


def text(given: Any, what: str) -> str:
    """Words that a text of C can hold."""
    if not isinstance(given, str):
        raise UsageError(f"{what} is a str, found {given!r}")
    if "\0" in given:
        raise UsageError(f"{what} has a zero byte: {given!r}")
    return given


def text_or_none(given: Any, what: str) -> Optional[str]:
    return None if given is None else text(given, what)


def texts(given: Any, what: str) -> list[str]:
    """One str or several."""
    if isinstance(given, str):
        return [text(given, what)]
    if not isinstance(given, Iterable) or isinstance(given, bytes):
        raise UsageError(f"{what} is a str or several, found {given!r}")
    return [text(one, f"one of {what}") for one in given]


def episodes(given: Any) -> Optional[tuple[int, int]]:
    """The first and the last of a number, a pair or a range; None of None."""
    if given is None:
        return None
    if isinstance(given, range):
        if given.step != 1 or not len(given):
            raise UsageError(f"episodes are a range without gaps, found {given}")
        return whole(given.start, "an episode"), whole(given.stop - 1, "an episode")
    if isinstance(given, tuple) and len(given) == 2:
        return whole(given[0], "an episode"), whole(given[1], "an episode")
    if isinstance(given, (str, bytes)) or isinstance(given, Iterable):
        # [0, 3] could be two episodes or four.
        raise UsageError(
            f"episodes are a number, a tuple (first, last) with both included, or a range of step 1, found {given!r}"
        )
    only = whole(given, "an episode")
    return only, only


def seeds(given: Any) -> list[int]:
    """Those that are named; of None none are."""
    if given is None:
        return []
    if isinstance(given, (str, bytes)) or not isinstance(given, Iterable):
        raise UsageError(f"seeds are a list of whole numbers, found {given!r}")
    named = [whole(seed, "a seed") for seed in given]
    if not named:
        raise UsageError("no seed is named; None means the suite's")
    for seed in named:
        if named.count(seed) > 1:
            raise UsageError(f"seed {seed} is named twice")
    return named
