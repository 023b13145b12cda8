"""A plan step by step, with every static fact that it rests on: what the streams must really certify."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tamp.search.axioms import derive, supports
from tamp.search.blocking import LazyGuards
from tamp.search.operators import Facts, Grounded, Guard, Operator


@dataclass(frozen=True, slots=True)
class Step:
    """One operator of a plan.

    Attributes:
        operator: What is applied.
        state: The fluent facts before it.
        static: What it rests on there: its static preconditions, the facts that lift its triggered guards, the static
            facts in the derivations of its derived preconditions and of the conditional effects that take place.
        guards: Those triggered there.
    """

    operator: Operator
    state: Facts
    static: Facts
    guards: tuple[Guard, ...] = ()


@dataclass(frozen=True, slots=True)
class Trace:
    """All steps, the state in the end, and the static facts that the goal rests on there."""

    steps: tuple[Step, ...]
    final: Facts
    goal: Facts


def trace(grounded: Grounded, operators: Iterable[Operator]) -> Trace:
    """Replay a plan's operators from the initial state.

    Raises:
        ValueError: An operator is not applicable, or the goal does not hold in the end.
    """
    state = grounded.initial
    steps: list[Step] = []
    for operator in operators:
        step, state = _applied(grounded, operator, state)
        steps.append(step)
    why = derive(grounded.axioms, state)
    holds = state | why.keys()
    if not grounded.goal.positive <= holds or not grounded.goal.negative.isdisjoint(holds):
        raise ValueError("the goal does not hold in the end")
    return Trace(tuple(steps), state, grounded.goal.static | supports(why, grounded.goal.positive))


def replayed(grounded: Grounded, actions: Iterable[tuple[str, tuple[str, ...]]]) -> bool:
    """Whether actions, by name and arguments, lead from the initial state to the goal."""
    operators: dict[tuple[str, tuple[str, ...]], list[Operator]] = {}
    for operator in grounded.operators:
        operators.setdefault((operator.name, operator.arguments), []).append(operator)
    states = {grounded.initial}
    for action in actions:
        after: set[Facts] = set()
        for state in states:  # several where the condition is a disjunction
            for operator in operators.get(action, ()):
                try:
                    after.add(_applied(grounded, operator, state)[1])
                except ValueError:
                    continue
        states = after
    goal = grounded.goal
    holding = (state | derive(grounded.axioms, state).keys() for state in states)
    return any(goal.positive <= holds and goal.negative.isdisjoint(holds) for holds in holding)


def _applied(grounded: Grounded, operator: Operator, state: Facts) -> tuple[Step, Facts]:
    """The operator's step in a state, and the state after it; ValueError where it is not applicable."""
    why = derive(grounded.axioms, state)
    holds = state | why.keys()
    if not operator.positive <= holds or not operator.negative.isdisjoint(holds):
        raise ValueError(f"{operator} is not applicable")
    static = set(operator.static | supports(why, operator.positive))
    guards = triggered(operator, state)
    for guard in guards:
        if guard.lifted_by is None:
            raise ValueError(f"{operator} is forbidden while {sorted(guard.facts)} hold")
        static.add(guard.lifted_by)
    added, deleted = operator.added, operator.deleted
    for effect in operator.conditional:
        if effect.positive <= holds and effect.negative.isdisjoint(holds):
            added |= effect.added
            deleted |= effect.deleted
            static |= effect.static | supports(why, effect.positive)
    return Step(operator, state, frozenset(static), guards), (state - deleted) | added


def triggered(operator: Operator, state: Facts) -> tuple[Guard, ...]:
    """The operator's guards whose facts the state contains."""
    if isinstance(operator.guards, LazyGuards):
        return operator.guards.triggered(state)
    return tuple(guard for guard in operator.guards if guard.facts <= state)
