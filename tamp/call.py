"""What a stream's function is given beside its inputs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from tamp.clock import Deadline


def _unheard(message: str) -> None:
    pass


def _unseen(value: Any, reason: str) -> None:
    pass


@dataclass(frozen=True, slots=True)
class Call:
    """The circumstances of one stream call.

    Attributes:
        rng: A numpy.random.Generator of this stream instance's own, seeded by the run's seed and the instance.
        deadline: When the run ends; long computations give up before.
        fluents: The state's facts of the predicates that the stream names in `:fluents`, with values in the place of
            objects: ("at-pose", "mug", Pose(...)).
        memory: The run's: what streams of one run have learned so far, each under a name of its own.
        ahead: Whether values are drawn ahead of their use, so that being asked for another one says nothing about the
            last; else it was tried, and did not serve.
        warn: Tells the user something, once.
        refused: Told of each proposal that the stream looked at and did not take, and why; for recordings.
    """

    rng: Any
    deadline: Deadline
    fluents: Sequence[tuple[Any, ...]] = ()
    memory: dict[str, Any] = field(default_factory=dict[str, Any])
    ahead: bool = False
    warn: Callable[[str], None] = _unheard
    refused: Callable[[Any, str], None] = _unseen
