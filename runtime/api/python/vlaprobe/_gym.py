"""gymnasium's classes where it is installed, classes of the same shape where it is not.

Only what environments here need: names, signatures and behaviour are gymnasium's (1.x), so that code written for one
runs with the other.
"""

from __future__ import annotations

import enum
from typing import Any, Mapping, Optional, Sequence

import numpy as np

try:
    import gymnasium
    from gymnasium import Env, spaces
    from gymnasium.utils import seeding
    from gymnasium.vector import AutoresetMode, VectorEnv
    from gymnasium.vector.utils import batch_space

    IS_GYMNASIUM = True
    Box, Dict = spaces.Box, spaces.Dict

    def new_random(seed: Optional[int] = None) -> tuple[np.random.Generator, int]:
        return seeding.np_random(seed)

except ImportError:
    gymnasium = None
    IS_GYMNASIUM = False

    def new_random(seed: Optional[int] = None) -> tuple[np.random.Generator, int]:
        """A generator and the seed that it starts from; as gymnasium.utils.seeding.np_random."""
        if seed is not None and not (isinstance(seed, (int, np.integer)) and seed >= 0):
            raise ValueError(f"a seed is a whole number from 0 on, found {seed!r}")
        sequence = np.random.SeedSequence(None if seed is None else int(seed))
        return np.random.Generator(np.random.PCG64(sequence)), sequence.entropy

    class AutoresetMode(enum.Enum):
        """When an environment of a vector begins its next episode."""

        NEXT_STEP = "NextStep"
        SAME_STEP = "SameStep"
        DISABLED = "Disabled"

    class Space:
        """What observations or actions may be."""

        def __init__(self, shape: Optional[Sequence[int]] = None, dtype: Any = None, seed: Any = None) -> None:
            self._shape = None if shape is None else tuple(int(side) for side in shape)
            self.dtype = None if dtype is None else np.dtype(dtype)
            self._np_random: Optional[np.random.Generator] = None
            if seed is not None:
                self.seed(seed)

        @property
        def shape(self) -> Any:
            return self._shape

        @property
        def np_random(self) -> np.random.Generator:
            if self._np_random is None:
                self.seed()
            assert self._np_random is not None
            return self._np_random

        def seed(self, seed: Any = None) -> Any:
            self._np_random, used = new_random(seed)
            return used

        def sample(self) -> Any:
            raise NotImplementedError

        def contains(self, x: Any) -> bool:
            raise NotImplementedError

        def __contains__(self, x: Any) -> bool:
            return self.contains(x)

    class Box(Space):
        """Arrays of numbers, each within its bounds."""

        def __init__(self, low: Any, high: Any, shape: Any = None, dtype: Any = np.float32, seed: Any = None) -> None:
            dtype = np.dtype(dtype)
            if shape is None:
                shape = np.shape(low) or np.shape(high)
            super().__init__(shape, dtype, seed)
            self.low = np.broadcast_to(np.asarray(low, dtype), self._shape).copy()
            self.high = np.broadcast_to(np.asarray(high, dtype), self._shape).copy()
            self.bounded_below = self.low > -np.inf if dtype.kind == "f" else np.ones(self._shape, bool)
            self.bounded_above = self.high < np.inf if dtype.kind == "f" else np.ones(self._shape, bool)

        def is_bounded(self, manner: str = "both") -> bool:
            sides = {"below": [self.bounded_below], "above": [self.bounded_above]}
            sides["both"] = sides["below"] + sides["above"]
            return all(bool(np.all(side)) for side in sides[manner])

        def sample(self) -> np.ndarray:
            if self.dtype.kind != "f":
                return self.np_random.integers(self.low, self.high, dtype=self.dtype, endpoint=True)
            draw = self.np_random
            bounded = self.bounded_below & self.bounded_above
            numbers = draw.normal(size=self._shape)
            above, below = self.bounded_below & ~bounded, self.bounded_above & ~bounded
            numbers[above] = self.low[above] + draw.exponential(size=above.sum())
            numbers[below] = self.high[below] - draw.exponential(size=below.sum())
            numbers[bounded] = draw.uniform(self.low[bounded], self.high[bounded])
            return numbers.astype(self.dtype)

        def contains(self, x: Any) -> bool:
            if not isinstance(x, np.ndarray):
                try:
                    x = np.asarray(x, dtype=self.dtype)
                except (ValueError, TypeError):
                    return False
            return bool(
                np.can_cast(x.dtype, self.dtype)
                and x.shape == self._shape
                and np.all(x >= self.low)
                and np.all(x <= self.high)
            )

        def __eq__(self, other: Any) -> bool:
            return (
                isinstance(other, Box)
                and self._shape == other._shape
                and self.dtype == other.dtype
                and np.array_equal(self.low, other.low)
                and np.array_equal(self.high, other.high)
            )

        def __repr__(self) -> str:
            return f"Box({self.low.min()}, {self.high.max()}, {self._shape}, {self.dtype})"

    class Dict(Space, Mapping):
        """Spaces by name."""

        def __init__(self, spaces: Any = None, seed: Any = None, **more: Any) -> None:
            self.spaces = dict(spaces or {}, **more)
            super().__init__(None, None, seed)

        def seed(self, seed: Any = None) -> Any:
            if isinstance(seed, dict):
                return {name: self.spaces[name].seed(seed[name]) for name in self.spaces}
            super().seed(seed)
            draws = self.np_random.integers(np.iinfo(np.int32).max, size=len(self.spaces))
            return {name: space.seed(int(draw)) for (name, space), draw in zip(self.spaces.items(), draws)}

        def sample(self) -> dict:
            return {name: space.sample() for name, space in self.spaces.items()}

        def contains(self, x: Any) -> bool:
            return (
                isinstance(x, dict)
                and x.keys() == self.spaces.keys()
                and all(x[name] in space for name, space in self.spaces.items())
            )

        def __getitem__(self, name: str) -> Space:
            return self.spaces[name]

        def __iter__(self) -> Any:
            return iter(self.spaces)

        def __len__(self) -> int:
            return len(self.spaces)

        def __eq__(self, other: Any) -> bool:
            return isinstance(other, Dict) and self.spaces == other.spaces

        def __repr__(self) -> str:
            return "Dict(" + ", ".join(f"{name!r}: {space!r}" for name, space in self.spaces.items()) + ")"

    def batch_space(space: Space, n: int = 1) -> Space:
        """Of n values at a time."""
        if isinstance(space, Dict):
            return Dict({name: batch_space(inner, n) for name, inner in space.spaces.items()})
        assert isinstance(space, Box)
        return Box(
            np.broadcast_to(space.low, (n, *space.shape)),
            np.broadcast_to(space.high, (n, *space.shape)),
            dtype=space.dtype,
        )

    class _Seeded:
        _np_random: Optional[np.random.Generator] = None
        _np_random_seed: Optional[int] = None

        @property
        def np_random(self) -> np.random.Generator:
            if self._np_random is None:
                self._np_random, self._np_random_seed = new_random()
            return self._np_random

        @np_random.setter
        def np_random(self, value: np.random.Generator) -> None:
            self._np_random, self._np_random_seed = value, -1

        @property
        def np_random_seed(self) -> Optional[int]:
            if self._np_random_seed is None:
                self._np_random, self._np_random_seed = new_random()
            return self._np_random_seed

    class Env(_Seeded):
        """One environment; the methods are gymnasium.Env's."""

        metadata: dict[str, Any] = {"render_modes": []}
        render_mode: Optional[str] = None
        spec: Any = None
        action_space: Space
        observation_space: Space

        def reset(self, *, seed: Optional[int] = None, options: Optional[dict] = None) -> Any:
            if seed is not None:
                self._np_random, self._np_random_seed = new_random(seed)

        def close(self) -> None:
            pass

        @property
        def unwrapped(self) -> "Env":
            return self

        def has_wrapper_attr(self, name: str) -> bool:
            return hasattr(self, name)

        def get_wrapper_attr(self, name: str) -> Any:
            return getattr(self, name)

        def set_wrapper_attr(self, name: str, value: Any, *, force: bool = True) -> bool:
            if not force and not hasattr(self, name):
                return False
            setattr(self, name, value)
            return True

        def __enter__(self) -> "Env":
            return self

        def __exit__(self, *args: Any) -> bool:
            self.close()
            return False

    class VectorEnv(_Seeded):
        """Several environments at a time; the methods are gymnasium.vector.VectorEnv's."""

        metadata: dict[str, Any] = {}
        spec: Any = None
        render_mode: Optional[str] = None
        closed: bool = False
        observation_space: Space
        action_space: Space
        single_observation_space: Space
        single_action_space: Space
        num_envs: int

        def reset(self, *, seed: Any = None, options: Optional[dict] = None) -> Any:
            if seed is not None:
                self._np_random, self._np_random_seed = new_random(seed)

        def close(self, **kwargs: Any) -> None:
            if self.closed:
                return
            self.close_extras(**kwargs)
            self.closed = True

        def close_extras(self, **kwargs: Any) -> None:
            pass

        @property
        def unwrapped(self) -> "VectorEnv":
            return self

        def __enter__(self) -> "VectorEnv":
            return self

        def __exit__(self, *args: Any) -> bool:
            self.close()
            return False


__all__ = ["IS_GYMNASIUM", "AutoresetMode", "Box", "Dict", "Env", "VectorEnv", "batch_space", "gymnasium", "new_random"]
