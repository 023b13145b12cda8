"""Counts of the tries and failures of each action in the plans that were tried, and the reasons."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.experience.stream_statistics import Experience, FailureRecord
from tamp.symbolic.algorithms.optimistic.optimistic_facts import PLACEHOLDER_MARK
from tamp.symbolic.pddl.relations import SAMPLE_PREFIX
from tamp.symbolic.pddl.structs import Fact

MAX_SKELETONS = 100
"""So many plans, the latest, are looked at: the user waits for the answer."""


@dataclass
class FailureCount:
    """The calls of one stream for one action with its objects, over all plans that were tried.

    Attributes:
        action: "place mug on shelf_2"; the objects are those of the problem.
        stream: Its name.
        tries: Results asked for.
        successes: Those that came, or held.
        reasons: Why the others did not.
        in_the_way: The objects that they hit or that blocked them, counted.
        objects: Those of the problem that the action is about.
        bodies: The objects that the reasons name, counted.
    """

    action: str
    stream: str
    tries: int = 0
    successes: int = 0
    reasons: Counter[str] = field(default_factory=Counter[str])
    in_the_way: Counter[str] = field(default_factory=Counter[str])
    objects: tuple[str, ...] = ()
    bodies: Counter[str] = field(default_factory=Counter[str])

    @property
    def failures(self) -> int:
        """Count the tries without a result."""
        return self.tries - self.successes

    @property
    def always_failed(self) -> bool:
        """Return whether all tries failed."""
        return self.tries > 0 and self.successes == 0

    def text(self) -> str:
        """Describe it in one line."""
        reasons = ", ".join(f"{count} {reason}" for reason, count in self.reasons.most_common(3))
        how = "never worked" if self.always_failed else f"worked {self.successes} times"
        return f"{self.action}: {self.stream} {how} in {self.tries} tries: {reasons}"


def failure_counts(
    skeletons: Sequence[Skeleton], experience: Experience, names: Mapping[str, object]
) -> tuple[FailureCount, ...]:
    """Count what was tried by action and stream: what never worked first, then by failures.

    Args:
        skeletons: The plans that were tried, in order.
        experience: What binding them has taught.
        names: The values of the problem's objects: those that are their own names stand for things.
    """
    records: dict[Fact, list[FailureRecord]] = {
        fact: [record] for fact, record in experience.facts.items()
    }
    for (fact, _), record in experience.nogoods.items():
        records.setdefault(fact, []).append(record)

    made: dict[tuple[str, str], FailureCount] = {}
    counted: set[tuple[str, str, Fact]] = set()
    for skeleton in skeletons[-MAX_SKELETONS:]:
        users = _users(skeleton)
        labels: dict[int, tuple[str, tuple[str, ...]]] = {}
        for node, user in zip(skeleton.nodes, users, strict=True):
            if node.fact not in records:
                continue
            if user not in labels:
                labels[user] = _label(skeleton, user, users, names)
            label, objects = labels[user]
            key = (label, node.stream.name)
            if (*key, node.fact) in counted:
                continue
            counted.add((*key, node.fact))
            tally = made.setdefault(key, FailureCount(*key, objects=objects))
            for record in records[node.fact]:
                tally.tries += record.successes + record.failures
                tally.successes += record.successes
                tally.reasons.update(record.reasons)
                tally.in_the_way.update(record.in_the_way)
                tally.bodies.update(record.bodies)

    rows = [tally for tally in made.values() if tally.tries]
    return tuple(sorted(rows, key=lambda row: (not row.always_failed, -row.failures)))


def blocking_objects(
    rows: Sequence[FailureCount], names: Mapping[str, object]
) -> tuple[tuple[str, int], ...]:
    """Count the things of the problem that were hit or that blocked a way; most first."""
    counts: Counter[str] = Counter()
    for row in rows:
        for name, count in row.in_the_way.items():
            if isinstance(names.get(name.lower()), str):
                counts[name.lower()] += count
    return tuple(counts.most_common())


def _users(skeleton: Skeleton) -> list[int]:
    """Find for each call the step that shares most objects with it; the first of those."""
    steps: dict[str, list[int]] = defaultdict(list)
    for number, step in enumerate(skeleton.steps):
        for word in dict.fromkeys(step.arguments):
            steps[word].append(number)
    users: list[int] = []
    for node in skeleton.nodes:
        shared: dict[int, int] = {}
        for word in {*node.guess[0], *node.guess[1]}:
            for number in steps.get(word, ()):
                shared[number] = shared.get(number, 0) + 1
        users.append(
            min(shared, key=lambda number: (-shared[number], number)) if shared else node.step
        )
    return users


def _label(
    skeleton: Skeleton, number: int, users: Sequence[int], names: Mapping[str, object]
) -> tuple[str, tuple[str, ...]]:
    """Describe an action with the things that it and its values' sources concern; list those."""
    if number >= len(skeleton.steps):
        return "the goal", ()

    step = skeleton.steps[number]
    things = _things(step.arguments, names)
    text = " ".join([step.name, *things])
    for node, user in zip(skeleton.nodes, users, strict=True):
        if user == number and not set(node.guess[1]).isdisjoint(step.arguments):
            further = [thing for thing in _things(node.guess[0], names) if thing not in things]
            if further:
                relation = node.stream.name.removeprefix(SAMPLE_PREFIX)
                text += (
                    f" {relation} {' '.join(further)}"
                    if relation != node.stream.name
                    else f" {' '.join(further)}"
                )
                things += further

    if things or number + 1 >= len(skeleton.steps):
        return text, tuple(things)
    purpose, further = _label(skeleton, number + 1, users, names)
    return f"{text}, to {purpose}", (*things, *further)


def _things(words: Iterable[str], names: Mapping[str, object]) -> list[str]:
    return [
        word
        for word in words
        if not word.startswith(PLACEHOLDER_MARK) and isinstance(names.get(word), str)
    ]
