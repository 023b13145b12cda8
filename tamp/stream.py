"""The contract of a stream: what its function is given and what it gives. All that the two wings
know of each other.

The symbolic wing calls stream functions and moves names and facts; the geometric wing writes them
and moves poses and paths. Both import this file, and neither imports the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from tamp.system.deadline import Deadline


def _unheard(message: str) -> None:
    pass


def _unseen(value: Any, reason: str) -> None:
    pass


@dataclass(frozen=True, slots=True)
class Call:
    """The circumstances of one stream call: what a stream's function is given beside its inputs.

    Attributes:
        rng: A numpy.random.Generator of this stream instance's own, seeded by the run's seed and
            the instance.
        deadline: When the run ends; long computations give up before.
        fluents: The state's facts of the predicates that the stream names in `:fluents`, with
            values in the place of objects: ("at-pose", "mug", Pose(...)).
        memory: The run's: what streams of one run have learned so far, each under a name of its
            own.
        ahead: Whether values are drawn ahead of their use, so that being asked for another one says
            nothing about the last; else it was tried, and did not serve.
        warn: Tells the user something, once.
        refused: Told of each proposal that the stream looked at and did not take, and why; for
            recordings.
    """

    rng: Any
    deadline: Deadline
    fluents: Sequence[tuple[Any, ...]] = ()
    memory: dict[str, Any] = field(default_factory=dict[str, Any])
    ahead: bool = False
    warn: Callable[[str], None] = _unheard
    refused: Callable[[Any, str], None] = _unseen


@dataclass(frozen=True, slots=True)
class Rejection:
    """One try of a stream that produced no value, and why.

    Attributes:
        reason: In a few words, fit to be counted and printed: "out of reach", "hits cereal".
        blockers: Objects whose present fluent facts caused it, by name; the search learns to move
            them first. Empty when nothing that could be moved is to blame.
        given_up: Whether the stream ends here without having tried everything: that it ended then
            proves nothing.
    """

    reason: str
    blockers: tuple[str, ...] = ()
    given_up: bool = False


@dataclass(frozen=True, slots=True)
class Wild:
    """One try of a stream, and further facts that it found to be true: what PDDLStream calls a wild
    output.

    Attributes:
        value: What the function would have yielded without them: outputs, a test's answer, a
            Rejection.
        facts: Static facts with values in the place of objects: ("Near", conf_a, conf_b).
    """

    value: Any
    facts: Sequence[tuple[Any, ...]]
