"""Equal outputs: whether a plan may need values of different calls that turn out to be equal.

A placeholder stands for the output of one call, so that a condition over two of them is not seen to
hold. Where equal values are one object (PDDLStream's semantics) it may; streams that look at the
state cannot be asked beforehand, so nothing is proven then.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.atoms import atoms
from tamp.symbolic.pddl.structs import Atom, Task

Position = tuple[str, int]
"""A predicate and the index of one of its terms."""


def equal_outputs_may_meet(task: Task, streams: Iterable[BoundStream]) -> bool:
    """Check whether some condition asks two facts for one and the same output of a fluent stream.

    Outputs are followed through derived predicates, effects and other streams, by the names of
    variables alone: it may be said of conditions that no two calls can meet in, never the opposite.

    Args:
        task: Gives goal, actions and derived predicates.
        streams: All of the problem.
    """
    bound = tuple(streams)
    declared = [stream.declaration for stream in bound]
    held = {
        (atom.predicate, index)
        for stream in bound
        if stream.is_fluent
        for atom in stream.declaration.certified
        for index, term in enumerate(atom.terms)
        if term in stream.declaration.outputs
    }
    if not held:
        return False

    rules = [(tuple(atoms(rule.body)), (rule.head,)) for rule in task.domain.derived]
    rules += [(stream.domain, stream.certified) for stream in declared]
    for action in task.domain.actions:
        conditions = (action.precondition, *(effect.condition for effect in action.effects))
        body = tuple(atom for one in conditions for atom in atoms(one))
        rules.append((body, tuple(effect.atom for effect in action.effects if effect.adds)))
    rules.append((tuple(atoms(task.goal)), ()))

    before = 0
    while before < len(held):
        before = len(held)
        for body, heads in rules:
            met = Counter(_outputs(body, held))
            equal = any(atom.predicate == "=" and {*atom.terms} <= met.keys() for atom in body)
            if equal or max(met.values(), default=0) > 1:
                return True
            held |= {
                (head.predicate, index)
                for head in heads
                for index, term in enumerate(head.terms)
                if term in met
            }
    return False


def _outputs(body: Iterable[Atom], held: set[Position]) -> Iterator[str]:
    """Yield the terms of a condition that stand where outputs may, once for each place."""
    for atom in dict.fromkeys(body):
        for index, term in enumerate(atom.terms):
            if (atom.predicate, index) in held:
                yield term
