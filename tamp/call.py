"""What a stream's function is given beside its inputs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from tamp.clock import Deadline


@dataclass(frozen=True, slots=True)
class Call:
    """The circumstances of one stream call.

    Attributes:
        rng: A numpy.random.Generator of this stream instance's own, seeded by the run's seed and the instance.
        deadline: When the run ends; long computations give up before.
        fluents: The state's facts of the predicates that the stream names in `:fluents`, with values in the place of
            objects: ("at-pose", "mug", Pose(...)).
    """

    rng: Any
    deadline: Deadline
    fluents: Sequence[tuple[Any, ...]] = ()
