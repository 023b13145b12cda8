"""Interface of the engines for drop tests: one body at a time let go among standing ones."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Part

ENGINE_STEP_S = 1 / 240
"""Seconds of one step of the engine."""


@dataclass(frozen=True, eq=False)
class Item:
    """A rigid body by its geometry; keep and reuse it: the engine's shape is made once an item.

    Args:
        parts: Its convex parts in its own frame.
        mass: Kilograms.
        friction: Coulomb's coefficient.
    """

    parts: tuple[Part, ...]
    mass: float = 0.3
    friction: float = 0.5


@dataclass(frozen=True)
class Contact:
    """The contact of argument and obstacle: the distance in metres, negative when they lie in each
    other.
    """

    obstacle: int
    distance: float


class Drops(ABC):
    """An engine for drop tests; `tamp.simulation.engines.open_drops` makes one. Use it as a context
    manager.
    """

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @abstractmethod
    def close(self) -> None:
        """Give the engine's memory back."""

    @abstractmethod
    def set_up(self, body: Item, obstacles: Sequence[tuple[Item, Array]]) -> None:
        """Replace the scene: a body that can fall, and obstacles that stand still at their
        T_world_obstacle (4, 4).
        """

    @abstractmethod
    def contacts(self, T_world_body: Array, reach: float = 0.005) -> list[Contact]:
        """Find the obstacles that are nearer to the body at this pose than `reach` metres; the
        floor is obstacle -1.
        """

    @abstractmethod
    def drop(self, T_world_body: Array, seconds: float) -> Array:
        """Let the body go at rest; T_world_body (4, 4) afterwards. Ends early when it has come to
        rest.
        """
