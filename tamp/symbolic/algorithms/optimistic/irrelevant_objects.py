"""Irrelevant objects, which no way to the goal need touch: excluded from the task at first."""

from __future__ import annotations

from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.pddl.structs import Fact, Task


def irrelevant_objects(task: Task) -> frozenset[str]:
    """Return the objects of the state that the goal does not name, though others of their kind.

    Objects are of a kind when their types and the unary static facts about them are the same.
    """
    named = {term for atom in atoms(task.goal) for term in atom.terms}
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


def objects_with_failures(objects: frozenset[str], experience: Experience) -> frozenset[str]:
    """Return those of the objects that something failed at."""
    failed: list[Fact] = [fact for fact, record in experience.facts.items() if record.failures]
    for fact, present in experience.nogoods:
        failed += [fact, *present]
    return objects.intersection(name for fact in failed for name in fact[1:])
