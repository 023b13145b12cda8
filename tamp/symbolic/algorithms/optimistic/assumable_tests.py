"""Tests that may be assumed to hold, and the atoms of a task's conditions that tell which."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.structs import And, Atom, Exists, Forall, Formula, Not, Or, Task


def assumable(streams: Iterable[BoundStream], task: Task) -> dict[str, tuple[BoundStream, Atom]]:
    """Return the tests whose facts only lift a guard: under a negation in a derived rule.

    Such a test certifies one fact with all its inputs in it, and no other stream certifies or needs
    that predicate. It is asked of what streams give, or of types: where only given facts say what
    it may be asked of, they are looked up.
    """
    everything = list(streams)
    positive = {atom.predicate for atom, sign in atoms_of(task) if sign}
    positive |= {atom.predicate for stream in everything for atom in stream.declaration.domain}

    makers: dict[str, list[tuple[BoundStream, Atom]]] = defaultdict(list)
    for stream in everything:
        for atom in stream.declaration.certified:
            makers[atom.predicate].append((stream, atom))

    return {
        predicate: made[0]
        for predicate, made in makers.items()
        if len(made) == 1
        and made[0][0].is_test
        and len(made[0][0].declaration.certified) == 1
        and set(made[0][0].declaration.inputs) == set(made[0][1].terms)
        and predicate not in positive
        and all(
            atom.predicate in makers or atom.predicate in task.domain.types
            for atom in made[0][0].declaration.domain
        )
    }


def atoms_of(task: Task) -> Iterator[tuple[Atom, bool]]:
    """Yield the atoms of all conditions, each with whether it helps by holding.

    In an action's condition a negation counts as help, since only a derived rule's negation can
    become a guard.
    """
    stack: list[tuple[Formula, bool, bool]] = [(task.goal, True, False)]
    stack += [(action.precondition, True, False) for action in task.domain.actions]
    stack += [
        (effect.condition, True, False)
        for action in task.domain.actions
        for effect in action.effects
    ]
    stack += [(rule.body, True, True) for rule in task.domain.derived]
    while stack:
        formula, sign, in_rule = stack.pop()
        match formula:
            case Atom():
                yield formula, sign
            case And(parts) | Or(parts):
                stack += [(part, sign, in_rule) for part in parts]
            case Not(body):
                stack.append((body, sign != in_rule, in_rule))
            case Exists(_, body) | Forall(_, body):
                stack.append((body, sign, in_rule))
