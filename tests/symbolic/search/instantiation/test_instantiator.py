"""Facts that come along one after the other give the task that all at once give."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.search import cupboard
from tamp.symbolic.pddl.structs import Fact, Task
from tamp.symbolic.search.instantiation.instantiator import Instantiator, instantiate
from tamp.symbolic.search.instantiation.predicate_kinds import Assumed
from tamp.symbolic.search.operators import InstantiatedTask
from tests.symbolic.search.test_random_tasks import random_task

Objects = Mapping[str, tuple[str, ...]]


def plain(instantiated: InstantiatedTask) -> InstantiatedTask:
    """Guards that are made only when they are asked for, made."""
    operators = tuple(
        replace(one, guards=tuple(sorted(set(one.guards), key=str)))
        for one in instantiated.operators
    )
    return replace(instantiated, operators=operators)


def check(
    task: Task, facts: Sequence[Fact], objects: Objects, steps: int, assumed: Assumed
) -> Instantiator:
    """One instantiator that is told more and more, against a new one each time."""
    instantiator = Instantiator(task, assumed)
    for step in range(steps + 1):
        known = facts[: len(facts) * step // steps]
        named = {name for fact in known for name in fact[1:]}
        there = {name: types for name, types in objects.items() if name in named}
        expected = plain(instantiate(task, known, there, assumed=assumed))
        assert plain(instantiator.instantiate(known, there)) == expected
    return instantiator


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("tests", [True, False])
def test_the_cupboard(seed: int, tests: bool) -> None:
    task, known, objects = cupboard(3, 3, tests=tests)
    facts = sorted(known)
    Random(seed).shuffle(facts)
    assumed: Assumed = {} if tests else {"pose-clear": (), "reach-clear": ()}
    instantiator = check(task, facts, objects, 6, assumed)
    again = instantiator.instantiate(facts[5:], objects)  # five are taken back
    assert plain(again) == plain(instantiate(task, facts[5:], objects, assumed=assumed))


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, 10**6))
def test_random_tasks(seed: int) -> None:
    task = random_task(Random(seed))
    changed = {effect.atom.predicate for action in task.domain.actions for effect in action.effects}
    facts = sorted(fact for fact in task.initial if fact[0] not in changed)
    Random(seed).shuffle(facts)
    bare = replace(task, initial=frozenset(fact for fact in task.initial if fact[0] in changed))
    check(bare, facts, {}, 3, frozenset())
