"""The contract of a stream: what its function is given and what it gives. All that the two wings
know of each other.

The symbolic wing calls stream functions and moves names and facts; the geometric wing writes them
and moves poses and paths. Both import this file, and neither imports the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from tamp.system.deadline import Deadline


def _unheard(message: str) -> None:
    pass


def _unseen(value: Any, why: Rejection | str) -> None:
    pass


class LateGenerator:
    """A random generator that is seeded when it is first asked for: most tests draw nothing.

    Args:
        make: What makes it.
    """

    __slots__ = ("_made", "_make")

    def __init__(self, make: Callable[[], Any]) -> None:
        self._make: Callable[[], Any] | None = make
        self._made: Any = None

    @property
    def generator(self) -> Any:
        """Return it, the same one each time."""
        if self._make is not None:
            self._made, self._make = self._make(), None
        return self._made


@dataclass(frozen=True, slots=True)
class Call:
    """The circumstances of one stream call: what a stream's function is given beside its inputs.

    Attributes:
        source: A numpy.random.Generator of this stream instance's own, seeded by the run's seed and
            the instance, or what makes it; functions take `rng`.
        deadline: When the run ends; long computations give up before.
        fluents: The state's facts of the predicates that the stream names in `:fluents`, with
            values in the place of objects: ("at-pose", "mug", Pose(...)).
        memory: The run's: what streams of one run have learned so far, each under a name of its
            own.
        ahead: Whether values are drawn ahead of their use, so that being asked for another one says
            nothing about the last; else it was tried, and did not serve.
        warn: Tells the user something, once.
        refused: Told of each proposal that the stream looked at and did not take, and why: a
            Rejection, or a few words; for recordings.
    """

    source: Any
    deadline: Deadline
    fluents: Sequence[tuple[Any, ...]] = ()
    memory: dict[str, Any] = field(default_factory=dict[str, Any])
    ahead: bool = False
    warn: Callable[[str], None] = _unheard
    refused: Callable[[Any, Rejection | str], None] = _unseen

    @property
    def rng(self) -> Any:
        """Return the numpy.random.Generator of this stream instance's own."""
        source = self.source
        return source.generator if isinstance(source, LateGenerator) else source


class StreamKind(Enum):
    """The kinds of streams, by what they are asked for; what is told of time goes by these."""

    GRASPS = "grasps"
    PLACEMENTS = "placements"
    IK = "ik"
    TESTS = "tests"
    MOTION = "motion"
    OTHER = "other streams"


class RejectionKind(Enum):
    """The kinds of causes for which a stream gives no value; code decides by these, never by words.

    The values are the names under which files and recordings may list them.
    """

    COLLISION = "collision"
    """Something is hit: `bodies` are what was hit, fixed or movable."""
    BLOCKED = "blocked"
    """No path leads past `bodies`, all of them movable."""
    NO_MOTION = "no-motion"
    """No path was found among the fixed bodies alone; `bodies` are those straight ahead."""
    UNREACHABLE = "unreachable"
    """The arm does not get there."""
    NO_STANCE = "no-stance"
    """The base cannot stand there, or not leave."""
    UNSTABLE = "unstable"
    """The body does not rest there."""
    TOO_LARGE = "too-large"
    """The body does not fit there, or not into the hand."""
    NO_GRASP = "no-grasp"
    """No grasp of the body was found."""
    TOO_HEAVY = "too-heavy"
    """The robot cannot carry the body."""
    UNLIKELY = "unlikely"
    """A classifier says no, or cannot tell."""
    FAULT = "fault"
    """A function of a user's, or a learned one, did not keep its contract."""
    OTHER = "other"
    """Anything else; the words say what."""


@dataclass(frozen=True, slots=True)
class Rejection:
    """One try of a stream that produced no value, and why.

    Attributes:
        reason: In a few words, fit to be counted and printed: "out of reach", "hits cereal".
        blockers: Objects whose present fluent facts caused it, by name; the search learns to move
            them first. Empty when nothing that could be moved is to blame.
        given_up: Whether the stream ends here without having tried everything: that it ended then
            proves nothing.
        kind: The cause as data; BLOCKED for a rejection that names blockers and no kind.
        bodies: The objects that were met, by name, whether or not they could be moved; the blockers
            where nothing else is said.
    """

    reason: str
    blockers: tuple[str, ...] = ()
    given_up: bool = False
    kind: RejectionKind = RejectionKind.OTHER
    bodies: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.blockers and self.kind is RejectionKind.OTHER:
            object.__setattr__(self, "kind", RejectionKind.BLOCKED)
        if not self.bodies:
            object.__setattr__(self, "bodies", tuple(self.blockers))

    @property
    def in_the_way(self) -> tuple[str, ...]:
        """Return the objects that were hit or that block the way; empty for other causes."""
        met = self.kind in (RejectionKind.COLLISION, RejectionKind.BLOCKED)
        return self.bodies if met else ()

    @classmethod
    def hits(cls, *others: str, who: str = "", blockers: tuple[str, ...] = ()) -> Rejection:
        """Return the rejection for a collision of `who` (by default what is asked about) with any
        of the others, of which some may be moved away.
        """
        reason = f"{who} hits {' or '.join(others)}".lstrip()
        return cls(reason, blockers, kind=RejectionKind.COLLISION, bodies=others)


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
