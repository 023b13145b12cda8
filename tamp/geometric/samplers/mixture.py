"""Mixture of the generators of one relation, allocating work as a bandit does: the chosen one, and
the hand-made one that it can only help.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tamp.geometric.samplers.sampler import Generator
from tamp.system.deadline import Deadline

WASTED_POSE_WORK = 20.0
"""Work, in proposals judged, of a pose that was passed on and asked for anew: grasps, reaches and
tests in vain."""

PRIOR_WORK = 20.0
"""Work with one success that every generator is credited with before its first proposal."""

EXPECTED_SUCCESSES = 4.0
"""A generator without a success is sidelined when the other one would have had this many from the
same work."""

FREE_SECONDS = 0.1
"""Seconds that a generator beside the hand-made one may take in a run whatever comes of it."""

SHARE_OF_TIME = 0.1
"""Further seconds for each second of the run so far."""

MEMORY_PREFIX = "ledger of "
"""What the ledgers are called in the memory of a run."""


@dataclass(frozen=True)
class Mixture:
    """The generators that propose the poses of a relation, the chosen generator first.

    Attributes:
        names: Of the generators.
        generators: One, alone; or two, of which the second is hand-made and trusted.
    """

    names: tuple[str, ...]
    generators: tuple[Generator, ...]


@dataclass
class SamplerRecord:
    """The account of one generator's proposals in one run.

    Attributes:
        judged: Proposals that were looked at.
        kept: Poses passed on and, as far as is known, of use: nobody asked for another one in their
            place.
        work: Proposals judged, and WASTED_POSE_WORK for each pose that was passed on in vain.
        seconds: Inside the generator; only an outer limit looks at it.
        stale: Batches that repeated what had been proposed.
        reasons: Why proposals were of no use.
        out: Why it is asked no more, or None.
    """

    name: str
    judged: int = 0
    kept: int = 0
    work: float = 0.0
    seconds: float = 0.0
    stale: int = 0
    reasons: Counter[str] = field(default_factory=Counter[str])
    out: str | None = None

    @property
    def work_per_success(self) -> float:
        """Work per acceptance: whoever has the least is next, so that work is shared in proportion
        to acceptance.
        """
        return self.work * (self.work + PRIOR_WORK) / (self.kept + 1.0)


class SamplerStatistics:
    """The accounts of a mixture in one run. Counted work divides the shares, never the clock: a
    seed repeats a plan.

    Args:
        relation: For messages.
        mixture: Whose accounts they are.
    """

    def __init__(self, relation: str, mixture: Mixture) -> None:
        self.relation = relation
        self.accounts = [SamplerRecord(name) for name in mixture.names]
        self._pending: dict[tuple[str, ...], SamplerRecord] = {}

    @classmethod
    def of(cls, relation: str, mixture: Mixture, memory: dict[str, Any]) -> SamplerStatistics:
        """Return the run's ledger of a relation."""
        return memory.setdefault(f"{MEMORY_PREFIX}{relation}", cls(relation, mixture))

    def order(self) -> list[int]:
        """List indices of the generators that are still asked, the next one first."""
        usable = [index for index, account in enumerate(self.accounts) if account.out is None]
        return sorted(usable, key=lambda index: self.accounts[index].work_per_success)

    def asked(self, arguments: tuple[str, ...]) -> None:
        """Note that a pose is wanted for these arguments: the one that was passed on before has not
        served.
        """
        account = self._pending.pop(arguments, None)
        if account is not None:
            account.kept -= 1
            account.work += WASTED_POSE_WORK
            account.reasons["led nowhere"] += 1

    def accepted(self, account: SamplerRecord, arguments: tuple[str, ...]) -> None:
        """Note that a pose of this generator goes to the planner."""
        account.kept += 1
        self._pending[arguments] = account

    def judged(self, account: SamplerRecord, reason: str | None) -> None:
        """Note that a proposal was looked at; `reason` says why it is of no use."""
        account.judged += 1
        account.work += 1.0
        if reason is not None:
            account.reasons[reason] += 1

    def useless(self) -> SamplerRecord | None:
        """Find a chosen generator that has shown to be useless beside the hand-made one; it is
        asked no more from now on.
        """
        if len(self.accounts) < 2:
            return None
        chosen, trusted = self.accounts[0], self.accounts[-1]
        if chosen.out is not None or chosen.kept > 0 or trusted.kept == 0:
            return None
        if trusted.kept / trusted.work * chosen.work < EXPECTED_SUCCESSES:
            return None
        most, count = chosen.reasons.most_common(1)[0]
        chosen.out = (
            f"none of its {chosen.judged} proposals was of use (most often, {count} times: {most})"
        )
        return chosen

    def allowance(self, account: SamplerRecord, deadline: Deadline) -> float:
        """Return the seconds that a generator beside the trusted one may still take; infinite for
        the only or the trusted one.
        """
        if len(self.accounts) < 2 or account is self.accounts[-1]:
            return float("inf")
        return FREE_SECONDS + SHARE_OF_TIME * deadline.elapsed() - account.seconds

    def sideline(self, account: SamplerRecord, reason: str) -> None:
        """Ask this generator no more in this run."""
        account.out = reason


def sidelined(relation: str, account: SamplerRecord, others: Sequence[str]) -> str:
    """Return the sentence for the user."""
    out = f"sampler '{account.name}' for '{relation}' is sidelined: {account.out}"
    return f"{out}; {', '.join(others)} goes on without it"


def accounts(memory: Mapping[str, object]) -> dict[str, tuple[SamplerRecord, ...]]:
    """Return the accounts of all relations in the memory of a run."""
    return {
        item.relation: tuple(item.accounts)
        for item in memory.values()
        if isinstance(item, SamplerStatistics)
    }
