"""A plan step by step, with every static fact that it rests on: what the streams must really
certify.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.axioms import derive, supports
from tamp.symbolic.search.instantiation.lazy_guards import LazyGuards
from tamp.symbolic.search.operators import NO_FACTS, Facts, Guard, InstantiatedTask, Operator


@dataclass(frozen=True, slots=True)
class TracedStep:
    """One operator of a plan.

    Attributes:
        operator: What is applied.
        state: The fluent facts before it.
        static: What it rests on there: its static preconditions, the facts that waive its triggered
            guards, the static facts in the derivations of its derived preconditions and of the
            conditional effects that take place.
        derived: Those of the static facts that derivations rest on.
        read: The fluent facts that its preconditions, the effects that take place, and the
            derivations rest on.
        heads: The derived facts behind all that.
        added: What it makes true there.
        deleted: What of the state it makes false.
        guards: Those triggered there.
        unguarded: Those of the static facts that it rests on whether or not they lift a guard.
    """

    operator: Operator
    state: Facts
    static: Facts
    derived: Facts = NO_FACTS
    read: Facts = NO_FACTS
    heads: Facts = NO_FACTS
    added: Facts = NO_FACTS
    deleted: Facts = NO_FACTS
    guards: tuple[Guard, ...] = ()
    unguarded: Facts = NO_FACTS


@dataclass(frozen=True, slots=True)
class FinalState:
    """The state in the end, and what the goal rests on there: static facts, those of them in
    derivations, fluents.
    """

    state: Facts
    static: Facts
    derived: Facts
    read: Facts


@dataclass(frozen=True, slots=True)
class Trace:
    """All steps and the end; whether something that they rest on could be derived in another way as
    well.
    """

    steps: tuple[TracedStep, ...]
    end: FinalState
    open: bool = False


def trace(
    instantiated: InstantiatedTask,
    operators: Iterable[Operator],
    price: Mapping[Fact, float] | None = None,
) -> Trace:
    """Replay a plan's operators from the initial state.

    Args:
        instantiated: The task.
        operators: The plan.
        price: Of static facts; what is derived rests on the cheapest ones.

    Raises:
        ValueError: An operator is not applicable, or the goal does not hold in the end.
    """
    state = instantiated.initial
    steps: list[TracedStep] = []
    ways = Counter(axiom.head for axiom in instantiated.axioms)
    several = frozenset(head for head, count in ways.items() if count > 1)
    open_ = False
    for operator in operators:
        step, state = _applied(instantiated, operator, state, price)
        steps.append(step)
        open_ = open_ or not several.isdisjoint(step.heads)
    why = derive(instantiated.axioms, state, price)
    holds = state | why.keys()
    if not instantiated.goal.positive <= holds or not instantiated.goal.negative.isdisjoint(holds):
        raise ValueError("the goal does not hold in the end")
    goal = supports(why, instantiated.goal.positive)
    end = FinalState(state, instantiated.goal.static | goal.static, goal.static, goal.read)
    return Trace(tuple(steps), end, open_ or not several.isdisjoint(goal.heads))


def replayed(
    instantiated: InstantiatedTask, actions: Iterable[tuple[str, tuple[str, ...]]]
) -> bool:
    """Check that actions, by name and arguments, lead from the initial state to the goal."""
    operators: dict[tuple[str, tuple[str, ...]], list[Operator]] = {}
    for operator in instantiated.operators:
        operators.setdefault((operator.name, operator.arguments), []).append(operator)
    states = {instantiated.initial}
    for action in actions:
        after: set[Facts] = set()
        for state in states:  # several where the condition is a disjunction
            for operator in operators.get(action, ()):
                try:
                    after.add(_applied(instantiated, operator, state)[1])
                except ValueError:
                    continue
        states = after
    goal = instantiated.goal
    holding = (state | derive(instantiated.axioms, state).keys() for state in states)
    return any(goal.positive <= holds and goal.negative.isdisjoint(holds) for holds in holding)


def _applied(
    instantiated: InstantiatedTask,
    operator: Operator,
    state: Facts,
    price: Mapping[Fact, float] | None = None,
) -> tuple[TracedStep, Facts]:
    """Apply the operator in a state; return its step and the state after it. ValueError where it
    is not applicable.
    """
    why = derive(instantiated.axioms, state, price)
    holds = state | why.keys()
    if not operator.positive <= holds or not operator.negative.isdisjoint(holds):
        raise ValueError(f"{operator} is not applicable")
    derived, read, heads = supports(why, operator.positive)
    static = set(operator.static)
    lifting: set[Fact] = set()
    guards = triggered(operator, state)

    for guard in guards:
        if guard.waived_by is None:
            raise ValueError(f"{operator} is forbidden while {sorted(guard.facts)} hold")
        lifting.add(guard.waived_by)

    added, deleted = operator.added, operator.deleted

    for effect in operator.conditional:
        if effect.positive <= holds and effect.negative.isdisjoint(holds):
            added |= effect.added
            deleted |= effect.deleted
            static |= effect.static
            more = supports(why, effect.positive)
            derived, read, heads = derived | more.static, read | more.read, heads | more.heads

    after = (state - deleted) | added
    gone = state - after
    own = frozenset(static | derived)

    return TracedStep(
        operator, state, own | lifting, derived, read, heads, added, gone, guards, own
    ), after


def triggered(operator: Operator, state: Facts) -> tuple[Guard, ...]:
    """Return the operator's guards whose facts the state contains."""
    if isinstance(operator.guards, LazyGuards):
        return operator.guards.triggered(state)
    return tuple(guard for guard in operator.guards if guard.facts <= state)
