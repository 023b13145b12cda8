"""Irrelevant bodies, which no way to the goal need touch: nothing is imagined of them at first."""

from __future__ import annotations

from collections.abc import Iterator

from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.pddl.structs import And, Atom, Exists, Fact, Forall, Formula, Not, Or, Task


def bystanders(task: Task) -> frozenset[str]:
    """Return the objects of the state that the goal does not name, though others of their kind.

    Objects are of a kind when their types and the unary static facts about them are the same.
    """
    named = set(_named(task.goal))
    changing = task.domain.fluent_predicates
    static: dict[str, set[str]] = {name: set() for name in task.objects}
    moved: set[str] = set()
    for fact in task.initial:
        if fact[0] in changing:
            moved.update(fact[1:])
        elif len(fact) == 2 and fact[1] in static:
            static[fact[1]].add(fact[0])
    kinds = {
        name: (frozenset(task.objects[name]), frozenset(facts)) for name, facts in static.items()
    }
    wanted = {kinds[name] for name in named if name in kinds}
    return frozenset(
        name
        for name, kind in kinds.items()
        if name in moved and name not in named and kind in wanted
    )


def blamed(objects: frozenset[str], experience: Experience) -> frozenset[str]:
    """Return those of the objects that something failed at."""
    failed: list[Fact] = [fact for fact, record in experience.facts.items() if record.failures]
    for fact, present in experience.nogoods:
        failed += [fact, *present]
    return objects.intersection(name for fact in failed for name in fact[1:])


def _named(formula: Formula) -> Iterator[str]:
    match formula:
        case Atom():
            yield from formula.terms
        case Not(body) | Exists(_, body) | Forall(_, body):
            yield from _named(body)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _named(part)
