"""What was tried for each action of the plans that were tried, and why it failed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from tamp.algorithms.optimistic import MARK
from tamp.algorithms.skeleton import Node, Skeleton
from tamp.algorithms.statistics import Experience, Record
from tamp.algorithms.stream import ADVISORY


@dataclass
class Tally:
    """The calls of one stream for one action with its objects, over all plans that were tried.

    Attributes:
        action: "place mug on shelf_2"; the objects are those of the problem.
        stream: Its name.
        tries: Results asked for.
        successes: Those that came, or held.
        reasons: Why the others did not.
    """

    action: str
    stream: str
    tries: int = 0
    successes: int = 0
    reasons: Counter[str] = field(default_factory=Counter[str])

    @property
    def failures(self) -> int:
        """Tries without a result."""
        return self.tries - self.successes

    @property
    def never(self) -> bool:
        """Whether all tries failed."""
        return self.tries > 0 and self.successes == 0

    def text(self) -> str:
        """One line."""
        reasons = ", ".join(f"{count} {reason}" for reason, count in self.reasons.most_common(3))
        how = "never worked" if self.never else f"worked {self.successes} times"
        return f"{self.action}: {self.stream} {how} in {self.tries} tries: {reasons}"


def tallies(skeletons: Iterable[Skeleton], experience: Experience, names: Mapping[str, object]) -> tuple[Tally, ...]:
    """What was tried by action and stream: what never worked first, then by failures.

    Args:
        skeletons: The plans that were tried.
        experience: What binding them has taught.
        names: The values of the problem's objects: those that are their own names stand for things.
    """
    records: dict[str, list[Record]] = {}
    for fact, record in experience.facts.items():
        records.setdefault(" ".join(fact), []).append(record)
    for (fact, _), record in experience.nogoods.items():
        records.setdefault(" ".join(fact), []).append(record)
    made: dict[tuple[str, str], Tally] = {}
    counted: set[tuple[str, str, str]] = set()
    for skeleton in skeletons:
        labels = [_label(skeleton, number, names) for number in range(len(skeleton.steps))]
        for node in skeleton.nodes:
            fact = " ".join(node.fact)
            label = labels[_user(skeleton, node)] if labels else "the goal"
            key = (label, node.stream.name)
            if (*key, fact) in counted:
                continue
            counted.add((*key, fact))
            tally = made.setdefault(key, Tally(*key))
            for record in records.get(fact, ()):
                tally.tries += record.successes + record.failures
                tally.successes += record.successes
                tally.reasons.update(record.reasons)
    rows = [tally for tally in made.values() if tally.tries]
    return tuple(sorted(rows, key=lambda row: (not row.never, -row.failures)))


def in_the_way(rows: Sequence[Tally], names: Mapping[str, object]) -> tuple[tuple[str, int], ...]:
    """The things of the problem that reasons name as hit or blocking, and how often; most first."""
    counts: Counter[str] = Counter()
    for row in rows:
        for reason, count in row.reasons.items():
            if "hits " in reason or "blocked by " in reason:
                words = reason.replace(",", " ").lower().split()
                counts.update({word: count for word in words if isinstance(names.get(word), str)})
    return tuple(counts.most_common())


def _user(skeleton: Skeleton, node: Node) -> int:
    """The step with which a call has most objects in common; the first of those that need it."""
    own = {*node.guess[0], *node.guess[1]}
    shared = [len(own.intersection(step.arguments)) for step in skeleton.steps]
    return max(range(len(shared)), key=lambda number: (shared[number], -number)) if max(shared) else node.step


def _label(skeleton: Skeleton, number: int, names: Mapping[str, object]) -> str:
    """An action with the things that it concerns: those among its arguments, and where its values come from."""
    step = skeleton.steps[number]
    things = _things(step.arguments, names)
    text = " ".join([step.name, *things])
    for node in skeleton.nodes:
        if set(node.guess[1]) & set(step.arguments) and _user(skeleton, node) == number:
            further = [thing for thing in _things(node.guess[0], names) if thing not in things]
            if further:
                relation = node.stream.name.removeprefix(ADVISORY)
                text += f" {relation} {' '.join(further)}" if relation != node.stream.name else f" {' '.join(further)}"
                things += further
    if things or number + 1 >= len(skeleton.steps):
        return text
    return f"{text}, to {_label(skeleton, number + 1, names)}"


def _things(words: Iterable[str], names: Mapping[str, object]) -> list[str]:
    return [word for word in words if not word.startswith(MARK) and isinstance(names.get(word), str)]
