"""Policies of the program's own, and of servers, for worlds that are stepped in Python."""

from __future__ import annotations

import numpy as np

from . import _vlaprobe
from ._given import text as checked_text
from ._given import whole
from .env import Env


class Policy:
    """What ``--policy TEXT`` is to ``vlaprobe run``: "expert", "noisy:0.01", "random", "openpi://HOST:PORT?profile=NAME".

    ::

        expert = vlaprobe.Policy("expert")
        env.reset(options={"episode": 3})
        expert.begin(env)
        env.step(expert.act(env))
    """

    def __init__(self, text: str) -> None:
        self.text = text
        self._policy = _vlaprobe.Policy(checked_text(text, "a policy"))

    def begin(self, env: Env, seed: int = 0) -> None:
        """Behind each env.reset() and env.restore(): the policy is told of the episode. `seed` is what it draws from, with
        the episode."""
        self._policy.begin(env._open(), whole(seed, "`seed`"))

    def act(self, env: Env) -> np.ndarray:
        """float64 (n,), 7 numbers unless the robot is told its joints: what the policy does about what the environment shows now.

        Raises:
            UsageError: the environment was reset or restored since begin(): what the policy keeps is of another episode.
        """
        return self._policy.act(env._open())

    def close(self) -> None:
        self._policy.close()

    def __repr__(self) -> str:
        return f"vlaprobe.Policy({self.text!r})"
