"""Stream statistics and experience: what was tried, what it cost, and why it failed."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from tamp.stream import Rejection

CallKey = tuple[str, tuple[str, ...]]
"""A stream call: the stream's name, and its inputs."""


@dataclass
class StreamStatistics:
    """Counts of one stream's tries.

    Attributes:
        calls: Tries.
        successes: Tries that gave a value (for a test: that held).
        seconds: Wall-clock time inside its function.
        reasons: Why the others failed.
    """

    calls: int = 0
    successes: int = 0
    seconds: float = 0.0
    reasons: Counter[str] = field(default_factory=Counter[str])


@dataclass
class FailureRecord:
    """Successes and failures of one thing in a skeleton: a test's fact, a stream's instance.

    Attributes:
        successes: Tries that gave a value, or held.
        failures: The others.
        reasons: Why they failed, in words, counted.
        in_the_way: The objects that they hit or that blocked them, counted.
        bodies: All objects that the reasons name, counted.
    """

    successes: int = 0
    failures: int = 0
    reasons: Counter[str] = field(default_factory=Counter[str])
    in_the_way: Counter[str] = field(default_factory=Counter[str])
    bodies: Counter[str] = field(default_factory=Counter[str])

    @property
    def expected_failures(self) -> float:
        """Expected failures before a success: the mean of 1/p - 1, flat prior, 0 if untried."""
        return max(0.0, (self.failures + 1.0) / (self.successes + 1.0) - 1.0)

    @property
    def price(self) -> float:
        """Price of relying on it, in units of the actions' costs."""
        return PRICE_PER_FAILURE * self.expected_failures


PRICE_PER_FAILURE = 0.4
"""An expected failure costs this much of an action of cost 1: about ten failures outweigh moving a
body away."""


MOST_SKIPPED = 15
"""Searches that do without a cheap plan, at most, before one is looked for again."""


@dataclass
class Patience:
    """Patience with a search that ends in vain: one is skipped after the first, then 3, 7, 15."""

    most: int = 0
    skipped: int = 0

    def skips(self) -> bool:
        """Check whether the next search is skipped, and count it."""
        if self.skipped >= self.most:
            return False
        self.skipped += 1
        return True

    def note(self, in_vain: bool) -> None:
        """Note how a search ended."""
        self.most = min(2 * self.most + 1, MOST_SKIPPED) if in_vain else 0
        self.skipped = 0


class Experience:
    """Lessons of binding about the optimistic task's symbolic facts, priced for the next search.

    A test that fails blocks exactly the facts it read: `facts` prices the optimistic static facts
    that need it, and `nogoods` prices a static fact in the presence of named fluent facts. `exact`
    is final: to each call the predicates of the state that it is shown, and their facts in the
    states in which it gave nothing.
    """

    def __init__(self) -> None:
        self.facts: dict[tuple[str, ...], FailureRecord] = {}
        self.failing_states: dict[
            CallKey, tuple[tuple[str, ...], dict[frozenset[tuple[str, ...]], None]]
        ] = {}
        self.nogoods: dict[tuple[tuple[str, ...], frozenset[tuple[str, ...]]], FailureRecord] = {}
        self.patience = Patience()

    def record(self, fact: tuple[str, ...], rejection: Rejection | None) -> None:
        """Count a try of whatever certifies `fact`: a success, or a failure and its cause."""
        self._count(self.facts.setdefault(fact, FailureRecord()), rejection)

    def record_nogood(
        self, fact: tuple[str, ...], present: frozenset[tuple[str, ...]], rejection: Rejection
    ) -> None:
        """Count a failure to certify `fact` for which `present` facts are to blame."""
        self._count(self.nogoods.setdefault((fact, present), FailureRecord()), rejection)

    def record_failing_state(
        self, call: CallKey, predicates: tuple[str, ...], state: frozenset[tuple[str, ...]]
    ) -> None:
        """Note that a call gives nothing in states with just these facts of the predicates."""
        self.failing_states.setdefault(call, (predicates, {}))[1][state] = None

    def prices(self) -> dict[tuple[str, ...], float]:
        """Return the extra cost of an action that rests on a fact, where it is not zero."""
        return {fact: record.price for fact, record in self.facts.items() if record.price > 0.0}

    @staticmethod
    def _count(record: FailureRecord, rejection: Rejection | None) -> None:
        if rejection is None:
            record.successes += 1
        else:
            record.failures += 1
            record.reasons[rejection.reason] += 1
            record.in_the_way.update(rejection.in_the_way)
            record.bodies.update(rejection.bodies)
