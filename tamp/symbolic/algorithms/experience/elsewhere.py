"""What streams that look at the state have ruled out for good: a call, in a state that has just these facts."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.axioms import stratify
from tamp.symbolic.search.operators import Axiom, Facts, InstantiatedTask

ELSEWHERE = "(elsewhere)"
"""The predicate of derived facts that say that a state is another one; no PDDL name looks like it."""


def elsewhere(instantiated: InstantiatedTask, experience: Experience) -> InstantiatedTask:
    """The task in which everything that rests on a call that failed in a state is to be done in other states."""
    needs: dict[Fact, set[Fact]] = defaultdict(set)
    axioms: list[Axiom] = []
    none: Facts = frozenset()
    for number, ((fact, predicates), states) in enumerate(experience.exact.items()):
        changing = sorted(one for one in instantiated.reachable | instantiated.initial if one[0] in predicates)
        for place, state in enumerate(states):
            head = (ELSEWHERE, str(number), str(place))
            needs[fact].add(head)
            axioms += [Axiom(head, none, frozenset((one,))) for one in sorted(state)]
            axioms += [Axiom(head, frozenset((one,)), none) for one in changing if one not in state]
    if not needs:
        return instantiated

    def asked(static: Facts) -> Facts:
        return frozenset(head for fact in static for head in needs.get(fact, ()))

    operators = tuple(
        replace(
            operator,
            positive=operator.positive | asked(operator.static),
            conditional=tuple(
                replace(effect, positive=effect.positive | asked(effect.static)) for effect in operator.conditional
            ),
        )
        for operator in instantiated.operators
    )
    axioms += [replace(axiom, positive=axiom.positive | asked(axiom.static)) for axiom in instantiated.axioms]
    goal = replace(instantiated.goal, positive=instantiated.goal.positive | asked(instantiated.goal.static))
    reachable = instantiated.reachable | {axiom.head for axiom in axioms}
    return replace(instantiated, operators=operators, axioms=stratify(axioms), goal=goal, reachable=reachable)
