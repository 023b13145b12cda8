"""States that streams which look at the state have ruled out for good, call by call."""

from __future__ import annotations

from dataclasses import replace

from tamp.symbolic.algorithms.experience.stream_statistics import CallKey, Experience
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts, OptimisticInstance
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.axioms import stratify
from tamp.symbolic.search.operators import NO_FACTS, Axiom, Facts, InstantiatedTask

OTHER_STATE_PREDICATE = "(elsewhere)"
"""The predicate of derived facts that say that a state is another one; no PDDL name looks like
it."""


def avoid_failing_states(
    instantiated: InstantiatedTask, experience: Experience, optimistic: OptimisticFacts
) -> InstantiatedTask:
    """Require other states for everything that rests on calls which all failed in a state.

    Where several calls certify a fact, it takes a state in which one of them has not failed.

    Args:
        instantiated: The task.
        experience: The calls that failed, and the states in which they did.
        optimistic: Which calls certify what.
    """
    if not experience.failing_states:
        return instantiated
    axioms, others = _other_states(instantiated, experience)
    needs, combined = _needs(optimistic, others)
    if not needs:
        return instantiated
    axioms += combined

    def asked(static: Facts) -> Facts:
        return frozenset(head for fact in static for head in needs.get(fact, NO_FACTS))

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


def _other_states(
    instantiated: InstantiatedTask, experience: Experience
) -> tuple[list[Axiom], dict[CallKey, Facts]]:
    """Derive for each call that it is in none of the states in which it failed."""
    axioms: list[Axiom] = []
    others: dict[CallKey, Facts] = {}
    for number, (call, (predicates, states)) in enumerate(experience.failing_states.items()):
        changing = sorted(
            one for one in instantiated.reachable | instantiated.initial if one[0] in predicates
        )
        heads = [(OTHER_STATE_PREDICATE, str(number), str(place)) for place in range(len(states))]
        others[call] = frozenset(heads)

        for head, state in zip(heads, states, strict=True):
            axioms += [Axiom(head, NO_FACTS, frozenset((one,))) for one in sorted(state)]
            axioms += [
                Axiom(head, frozenset((one,)), NO_FACTS) for one in changing if one not in state
            ]
    return axioms, others


def _needs(
    optimistic: OptimisticFacts, others: dict[CallKey, Facts]
) -> tuple[dict[Fact, Facts], list[Axiom]]:
    """Find what each fact takes that rests on failed calls alone: another state for one of them."""
    axioms: list[Axiom] = []
    needs: dict[Fact, Facts] = {}
    for fact in dict.fromkeys(
        fact
        for instance in optimistic.instances
        if instance.call in others
        for fact in instance.certified
    ):
        producers = optimistic.alternatives.get(
            fact, [optimistic.producers[fact]] if fact in optimistic.producers else []
        )
        if not producers or any(producer.call not in others for producer in producers):
            continue  # known, or there is a call that has not failed in any state
        if len(producers) == 1:
            needs[fact] = others[producers[0].call]
            continue

        head = (OTHER_STATE_PREDICATE, *fact)
        needs[fact] = frozenset((head,))
        axioms += [Axiom(head, others[producer.call], NO_FACTS) for producer in producers]
    return needs, axioms


def choose_instances(
    optimistic: OptimisticFacts, experience: Experience, facts: Facts, state: Facts
) -> dict[Fact, OptimisticInstance]:
    """Choose a call for each fact that several certify: the first not known to fail in the state.

    Args:
        optimistic: Which calls certify what.
        experience: The calls that failed, and the states in which they did.
        facts: Those that something rests on.
        state: The fluent facts there.
    """
    chosen: dict[Fact, OptimisticInstance] = {}
    for fact in sorted(facts & optimistic.alternatives.keys()):
        for instance in optimistic.alternatives[fact]:
            predicates, states = experience.failing_states.get(instance.call, ((), {}))
            if frozenset(one for one in state if one[0] in predicates) not in states:
                chosen[fact] = instance
                break
    return chosen
