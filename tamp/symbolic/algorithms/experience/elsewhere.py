"""States that streams which look at the state have ruled out for good, call by call."""

from __future__ import annotations

from dataclasses import replace

from tamp.symbolic.algorithms.experience.stream_statistics import Call, Experience
from tamp.symbolic.algorithms.optimistic.optimistic_instantiation import Guess, Optimism
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.axioms import stratify
from tamp.symbolic.search.operators import Axiom, Facts, InstantiatedTask

ELSEWHERE = "(elsewhere)"
"""The predicate of derived facts that say that a state is another one; no PDDL name looks like
it."""


NONE: Facts = frozenset()


def elsewhere(
    instantiated: InstantiatedTask, experience: Experience, optimism: Optimism
) -> InstantiatedTask:
    """Require other states for everything that rests on calls which all failed in a state.

    Where several calls certify a fact, it takes a state in which one of them has not failed.

    Args:
        instantiated: The task.
        experience: The calls that failed, and the states in which they did.
        optimism: Which calls certify what.
    """
    if not experience.exact:
        return instantiated
    axioms: list[Axiom] = []
    others: dict[Call, Facts] = {}
    for number, (call, (predicates, states)) in enumerate(experience.exact.items()):
        changing = sorted(
            one for one in instantiated.reachable | instantiated.initial if one[0] in predicates
        )
        heads = [(ELSEWHERE, str(number), str(place)) for place in range(len(states))]
        others[call] = frozenset(heads)
        for head, state in zip(heads, states, strict=True):
            axioms += [Axiom(head, NONE, frozenset((one,))) for one in sorted(state)]
            axioms += [Axiom(head, frozenset((one,)), NONE) for one in changing if one not in state]

    needs: dict[Fact, Facts] = {}
    for fact in dict.fromkeys(
        fact for guess in optimism.guesses if guess.call in others for fact in guess.certified
    ):
        makers = optimism.several.get(
            fact, [optimism.makers[fact]] if fact in optimism.makers else []
        )
        if not makers or any(maker.call not in others for maker in makers):
            continue  # known, or there is a call that has not failed in any state
        if len(makers) == 1:
            needs[fact] = others[makers[0].call]
            continue
        head = (ELSEWHERE, *fact)
        needs[fact] = frozenset((head,))
        axioms += [Axiom(head, others[maker.call], NONE) for maker in makers]
    if not needs:
        return instantiated

    def asked(static: Facts) -> Facts:
        return frozenset(head for fact in static for head in needs.get(fact, NONE))

    operators = tuple(
        replace(
            operator,
            positive=operator.positive | asked(operator.static),
            conditional=tuple(
                replace(effect, positive=effect.positive | asked(effect.static))
                for effect in operator.conditional
            ),
        )
        for operator in instantiated.operators
    )
    axioms += [
        replace(axiom, positive=axiom.positive | asked(axiom.static))
        for axiom in instantiated.axioms
    ]
    goal = replace(
        instantiated.goal, positive=instantiated.goal.positive | asked(instantiated.goal.static)
    )
    reachable = instantiated.reachable | {axiom.head for axiom in axioms}
    return replace(
        instantiated, operators=operators, axioms=stratify(axioms), goal=goal, reachable=reachable
    )


def choices(
    optimism: Optimism, experience: Experience, facts: Facts, state: Facts
) -> dict[Fact, Guess]:
    """Choose a call for each fact that several certify: the first not known to fail in the state.

    Args:
        optimism: Which calls certify what.
        experience: The calls that failed, and the states in which they did.
        facts: Those that something rests on.
        state: The fluent facts there.
    """
    chosen: dict[Fact, Guess] = {}
    for fact in sorted(facts & optimism.several.keys()):
        for guess in optimism.several[fact]:
            predicates, states = experience.exact.get(guess.call, ((), {}))
            if frozenset(one for one in state if one[0] in predicates) not in states:
                chosen[fact] = guess
                break
    return chosen
