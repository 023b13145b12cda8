"""Goals that can be reached one by one and not together."""

from __future__ import annotations

from dataclasses import replace

from tamp.clock import Deadline
from tamp.pddl.structs import Fact
from tamp.search.forward import Reason, search
from tamp.search.operators import Goal, Grounded

LIMIT = 5000
"""States that a search may expand in the attempt to prove that some of the goals alone are too many."""


def conflict(grounded: Grounded, deadline: Deadline) -> tuple[Fact, ...]:
    """The goals of an unsolvable task without those that its being unsolvable does not depend on; sorted.

    One goal after the other is left out; it stays out when the others are proven unsolvable without it. Goals that must
    not hold are given as ("not", ...). Within LIMIT and the time: what cannot be proven stays in.
    """
    goal = _opened(grounded)
    kept = [*sorted(goal.positive), *sorted(("not", *fact) for fact in goal.negative)]
    for fact in sorted(kept, key=lambda fact: fact[0] not in grounded.meanings):  # the parts say more than the whole
        rest = [other for other in kept if other != fact]
        if not rest or deadline.passed:
            break
        found = search(replace(grounded, goal=_goal(goal, rest)), search="greedy", limit=LIMIT, deadline=deadline)
        if found.reason is Reason.UNSOLVABLE:
            kept = rest
    return tuple(kept)


def _opened(grounded: Grounded) -> Goal:
    """The goal and what each rule for one of its auxiliary facts asks for, where those stand for conjunctions."""
    goal = grounded.goal
    for fact in sorted(goal.positive):
        rules = [axiom for axiom in grounded.axioms if axiom.head == fact]
        if fact[0] in grounded.meanings and rules:
            positive = {part for part in rules[0].positive if all(part in rule.positive for rule in rules)}
            negative = {part for part in rules[0].negative if all(part in rule.negative for rule in rules)}
            goal = Goal(goal.positive | positive, goal.negative | negative, goal.static)
    return goal


def _goal(goal: Goal, facts: list[Fact]) -> Goal:
    positive = frozenset(fact for fact in facts if fact[0] != "not")
    return Goal(positive, frozenset(fact[1:] for fact in facts if fact[0] == "not"), goal.static)
