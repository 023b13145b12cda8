"""Record what streams drew and refused, for those who want to see it; planning stays the same."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from tamp.geometric.scene.pose import Pose
from tamp.geometric.values import Grasp
from tamp.stream import Call, Rejection, Wild
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.result import SkeletonAttempt, StreamTask

MAX_SAMPLES = 2000
"""Samples that are kept of a run, beside those of the plan,"""

MAX_SAMPLES_PER_BODY = 200
"""and of one stream for one body, refused by it or not, so that one that is hard to place leaves
room for others.
"""


@dataclass(eq=False)
class Sample:
    """A pose or a grasp that a stream drew or looked at.

    Attributes:
        stream: The one that drew it.
        arguments: Names of the objects that it was drawn for, the body first.
        value: T_world_body, or a grasp.
        refusals: Who said no to it, and why: (stream, reason), counted.
        met: The objects that each of these reasons names.
    """

    stream: str
    arguments: tuple[str, ...]
    value: Pose | Grasp
    refusals: Counter[tuple[str, str]] = field(default_factory=Counter[tuple[str, str]])
    met: dict[tuple[str, str], tuple[str, ...]] = field(
        default_factory=dict[tuple[str, str], tuple[str, ...]]
    )

    def refuse(self, stream: str, rejection: Rejection) -> None:
        """Count a refusal."""
        key = (stream, rejection.reason)
        self.refusals[key] += 1
        self.met[key] = tuple(dict.fromkeys((*self.met.get(key, ()), *rejection.bodies)))


@dataclass(frozen=True)
class Record:
    """A record of what was tried in a run.

    Attributes:
        samples: In the order in which they were drawn.
        dropped: How many more there were.
        attempts: The skeletons, in the order in which they were found.
    """

    samples: tuple[Sample, ...]
    dropped: int
    attempts: tuple[SkeletonAttempt, ...]


class Recorder:
    """Listens to a run's streams; of what they say nothing is changed."""

    def __init__(self, limit: int = MAX_SAMPLES, each: int = MAX_SAMPLES_PER_BODY) -> None:
        self.samples: list[Sample] = []
        self.dropped = 0
        self._limit, self._each = limit, each
        self._by_value: dict[Pose | Grasp, Sample] = {}
        self._dropped_by_value: dict[Pose | Grasp, Sample] = {}
        self._counts: Counter[tuple[str, str, bool]] = Counter()

    def watched(self, task: StreamTask) -> StreamTask:
        """Return the same task with streams that are listened to."""
        return replace(task, streams=tuple(self._watched(stream) for stream in task.streams))

    def record(self, attempts: tuple[SkeletonAttempt, ...], used: Iterable[object] = ()) -> Record:
        """Return what was heard, all of the values that the plan uses included."""
        late = [
            self._dropped_by_value[value]
            for value in used
            if isinstance(value, Pose | Grasp) and value in self._dropped_by_value
        ]
        return Record((*self.samples, *late), self.dropped - len(late), attempts)

    def _watched(self, stream: BoundStream) -> BoundStream:
        def function(*inputs: Any, call: Call) -> Any:
            made = stream.function(
                *inputs, call=replace(call, refused=partial(self._refused, stream.name, inputs))
            )
            if stream.is_test:
                self._heard(stream.name, inputs, made)
                return made
            return self._drawn(stream.name, inputs, made)

        return replace(stream, function=function)

    def _drawn(self, stream: str, inputs: tuple[Any, ...], made: Iterable[Any]) -> Iterator[Any]:
        for value in made:
            self._heard(stream, inputs, value)
            yield value

    def _heard(self, stream: str, inputs: tuple[Any, ...], value: Any) -> None:
        if isinstance(value, Wild):
            value = value.value
        if isinstance(value, Pose | Grasp):
            self._sample(stream, inputs, value, refused=False)
        elif isinstance(value, Rejection):
            for kind in (
                Pose,
                Grasp,
            ):  # the first one is what the stream is about, others are those in its way
                subject = next((part for part in inputs if isinstance(part, kind)), None)
                sample = (
                    None
                    if subject is None
                    else self._by_value.get(subject) or self._dropped_by_value.get(subject)
                )
                if sample is not None:
                    sample.refuse(stream, value)

    def _refused(
        self, stream: str, inputs: tuple[Any, ...], pose: Pose, why: Rejection | str
    ) -> None:
        """Note a generator's own proposal that its stream did not take."""
        sample = self._sample(stream, inputs, pose, refused=True)
        if sample is not None:
            sample.refuse(stream, Rejection(why) if isinstance(why, str) else why)

    def _sample(
        self, stream: str, inputs: tuple[Any, ...], value: Pose | Grasp, *, refused: bool
    ) -> Sample | None:
        if value in self._by_value:
            return self._by_value[value]
        names = tuple(part for part in inputs if isinstance(part, str))
        if not names:
            return None
        sample = Sample(stream, names, value)
        kind = (stream, names[0], refused)
        if len(self.samples) >= self._limit or self._counts[kind] >= self._each:
            self.dropped += 1
            if not refused:  # the plan may come to use it
                self._dropped_by_value[value] = sample
            return None
        self._counts[kind] += 1
        self._by_value[value] = sample
        self.samples.append(sample)
        return sample
