"""Minimal sets of conflicting goals: each can be reached alone, and not together."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import combinations

from tamp.symbolic.algorithms.optimistic.optimistic_facts import PLACEHOLDER_MARK
from tamp.symbolic.pddl.structs import And, Fact, Formula, Not
from tamp.symbolic.search.goal_ways import goal_parts
from tamp.symbolic.search.instantiation.meanings import meaning_of
from tamp.symbolic.search.mutex import excluded
from tamp.symbolic.search.operators import Goal, InstantiatedTask, Meaning
from tamp.symbolic.search.search import Reason, search
from tamp.system.deadline import Deadline

MAX_STATES = 5000
"""States that a search may expand in the attempt to prove that some of the goals alone are too
many."""

MAX_PAIRS = 200
"""Pairs of conjuncts looked at where the goal is one formula with variables."""

InstantiateGoal = Callable[[Formula], InstantiatedTask]
"""Instantiates the task with another goal."""


def minimal_unsolvable_goals(
    instantiated: InstantiatedTask, deadline: Deadline, goal: Formula, instantiate: InstantiateGoal
) -> tuple[Meaning, ...]:
    """Find a minimal conflict: goals that cannot be reached together, sorted by their texts.

    Pairs of facts that exclude each other say it at once. Where they do not, one goal after the
    other is left out; it stays out when the others are proven unsolvable without it, within
    MAX_STATES and the time.

    Args:
        instantiated: The task.
        deadline: When to look no further.
        goal: The goal as it was written.
        instantiate: Instantiates the task with another goal.
    """
    found = excluded(instantiated, deadline)
    if found is not None:
        odd = any(_has_placeholder(fact) or fact[0] in instantiated.meanings for fact, _ in found)
    else:
        found = _searched(instantiated, deadline)
        odd = any(_has_placeholder(fact) for fact, _ in found)

    # nobody wrote the goal so: an auxiliary fact, or one about a placeholder
    if odd:
        return _conjuncts(goal, instantiate, deadline) or _meanings(instantiated, found)
    return _meanings(instantiated, found)


def _has_placeholder(fact: Fact) -> bool:
    return any(word.startswith(PLACEHOLDER_MARK) for word in fact)


def _conjuncts(
    goal: Formula, instantiate: InstantiateGoal, deadline: Deadline
) -> tuple[Meaning, ...]:
    """Find the fewest conjuncts of a goal with variables that exclude each other; else all."""
    parts = goal.parts if isinstance(goal, And) else (goal,)
    denied = {part.body for part in parts if isinstance(part, Not)}
    for part in parts:
        if part in denied:
            return _sorted((meaning_of(part), meaning_of(Not(part))))
    fewer = [(part,) for part in parts] + list(combinations(parts, 2))[:MAX_PAIRS]
    for some in fewer:
        if deadline.passed or len(some) == len(parts):
            break
        if excluded(instantiate(And(some)), deadline) is not None:
            return tuple(meaning_of(part) for part in some)
    return tuple(meaning_of(part) for part in parts)


def _searched(instantiated: InstantiatedTask, deadline: Deadline) -> tuple[tuple[Fact, bool], ...]:
    kept = [part.literal for part in goal_parts(instantiated)]
    # the parts say more than the whole
    for literal in sorted(kept, key=lambda one: one[0][0] not in instantiated.meanings):
        others = [other for other in kept if other != literal]
        if not others or deadline.passed:
            break
        left = replace(instantiated, goal=_goal(instantiated.goal, others))
        found = search(left, search="greedy", limit=MAX_STATES, deadline=deadline)
        if found.reason is Reason.UNSOLVABLE:
            kept = others
    return tuple(kept)


def _goal(goal: Goal, literals: Iterable[tuple[Fact, bool]]) -> Goal:
    positive = frozenset(fact for fact, wanted in literals if wanted)
    return Goal(positive, frozenset(fact for fact, wanted in literals if not wanted), goal.static)


def _meanings(
    instantiated: InstantiatedTask, literals: Iterable[tuple[Fact, bool]]
) -> tuple[Meaning, ...]:
    meant: list[Meaning] = []
    for fact, wanted in literals:
        meaning = instantiated.meanings.get(fact[0])
        text, terms = f"({' '.join(fact)})", fact[1:]
        if meaning is not None:
            text, terms = meaning.text, meaning.terms
        # what an auxiliary universal fact stands for is the formula that holds where the fact does
        # not
        negated = not wanted and not (meaning is not None and fact[0].startswith("forall "))
        meant.append(Meaning(f"(not {text})" if negated else text, terms))
    return _sorted(meant)


def _sorted(goals: Iterable[Meaning]) -> tuple[Meaning, ...]:
    return tuple(sorted(goals, key=lambda goal: goal.text))
