"""Tests that may be assumed to hold, and the atoms of a task's conditions that tell which."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.atoms import atoms, signed_atoms
from tamp.symbolic.pddl.structs import Atom, Task


def assumable(streams: Iterable[BoundStream], task: Task) -> dict[str, tuple[BoundStream, Atom]]:
    """Return the tests whose facts only lift a guard: under a negation in a derived rule.

    Such a test certifies one fact with all its inputs in it, and no other stream certifies or needs
    that predicate. It is asked of what streams give, or of types: where only given facts say what
    it may be asked of, they are looked up.
    """
    everything = list(streams)
    positive = {atom.predicate for atom, sign in atoms_of(task) if sign}
    positive |= {atom.predicate for stream in everything for atom in stream.declaration.domain}

    producers: dict[str, list[tuple[BoundStream, Atom]]] = defaultdict(list)
    for stream in everything:
        for atom in stream.declaration.certified:
            producers[atom.predicate].append((stream, atom))

    return {
        predicate: made[0]
        for predicate, made in producers.items()
        if len(made) == 1
        and made[0][0].is_test
        and len(made[0][0].declaration.certified) == 1
        and set(made[0][0].declaration.inputs) == set(made[0][1].terms)
        and predicate not in positive
        and all(
            atom.predicate in producers or atom.predicate in task.domain.types
            for atom in made[0][0].declaration.domain
        )
    }


def atoms_of(task: Task) -> Iterator[tuple[Atom, bool]]:
    """Yield the atoms of all conditions, each with whether it helps by holding.

    In an action's condition a negation counts as help, since only a derived rule's negation can
    become a guard.
    """
    conditions = [task.goal]
    for action in task.domain.actions:
        conditions += [action.precondition, *(effect.condition for effect in action.effects)]
    for condition in conditions:
        yield from ((atom, True) for atom in atoms(condition))
    for rule in task.domain.derived:
        yield from signed_atoms(rule.body)
