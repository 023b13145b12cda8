"""Action elimination: plans without their useless actions."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from tamp.symbolic.search.successors import State, Successors

GoalPricing = Callable[[State], float]
"""What the goal's derivation costs in a state without derived facts, in which the goal holds."""


def free_goal(state: State) -> float:
    """Price the goal at nothing: whatever it is derived from."""
    return 0.0


def eliminate_actions(
    successors: Successors, plan: Sequence[int], goal_price: GoalPricing = free_goal
) -> tuple[list[int], float]:
    """Drop operators as long as the rest is a plan that costs no more (action elimination, Nakhost
    and Mueller 2010).

    Each operator is dropped together with the later ones that no longer apply without it.

    Args:
        successors: The task.
        plan: Numbers of operators that lead from the initial state to the goal.
        goal_price: Counts beside the operators: without an action whose effect the goal rests on
            it may still hold, by a dearer derivation.

    Returns:
        The remaining operators and their cost with prices, without the goal's.
    """
    s = successors
    remaining = list(plan)
    left = _run(s, s.initial, remaining, goal_price)[1]
    kept: list[int] = []
    state, cost = s.initial, 0.0
    while remaining:
        shorter, reduced = _run(s, state, remaining[1:], goal_price)
        if shorter is not None and reduced <= left + 1e-9:
            remaining, left = shorter, reduced
            continue
        step = s.step_cost(remaining[0], state)
        kept.append(remaining[0])
        state, cost, left = s.apply(remaining[0], state, s.closure(state)), cost + step, left - step
        remaining = remaining[1:]
    return kept, cost


def _run(
    s: Successors, state: State, plan: list[int], goal_price: GoalPricing
) -> tuple[list[int] | None, float]:
    """Apply a plan's operators, leaving out those that do not apply; return them and what they and
    the goal cost, None without the goal.
    """
    cost = 0.0
    remaining: list[int] = []
    for operator in plan:
        closed = s.closure(state)
        if closed & s.before[operator] == s.before[operator] and not closed & s.absent[operator]:
            cost += s.step_cost(operator, state)
            state = s.apply(operator, state, closed)
            remaining.append(operator)
    if cost == math.inf or not s.holds_goal(s.closure(state)):
        return None, math.inf
    return remaining, cost + goal_price(state)
