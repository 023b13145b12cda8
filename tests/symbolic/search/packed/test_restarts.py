"""Restarts in turn: which search goes on, with which heuristics, for how many states."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, ClassVar

import pytest

from tamp.symbolic.search.expansion import Plan, SearchSpace
from tamp.symbolic.search.operators import Guard
from tamp.symbolic.search.packed import restarts
from tamp.symbolic.search.packed.restarts import Way
from tamp.symbolic.search.packed.search import Stalled
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.packed.room import facts, operator, task

PLAN = Plan((), 1.0)


class Scripted:
    """In the place of packed searches: notes what is asked, finds a plan at the n-th question."""

    asked: ClassVar[list[tuple[int, tuple[str, ...], bool, int, int]]] = []
    made = 0
    found_at = 0

    def __init__(
        self, search: Any, names: Any, weight: float, random: int = 0, achievers: bool = False
    ) -> None:
        assert weight == math.inf
        Scripted.made += 1
        self._told = Scripted.made, tuple(names), achievers, random

    def plan(self, patience: int) -> Plan | None:
        Scripted.asked.append((*self._told, patience))
        if len(Scripted.asked) < Scripted.found_at:
            raise Stalled
        return PLAN


def asked(
    monkeypatch: pytest.MonkeyPatch, found_at: int, names: tuple[str, ...], seed: int = 0
) -> list[tuple[int, tuple[str, ...], bool, int, int]]:
    Scripted.asked, Scripted.made, Scripted.found_at = [], 0, found_at
    monkeypatch.setattr(restarts, "PackedSearch", Scripted)
    monkeypatch.setattr(restarts, "goal_agenda", lambda s, deadline: [1])
    monkeypatch.setattr(restarts, "guard_agenda", lambda s: [1])
    search = SimpleNamespace(successors=None, deadline=None)
    assert restarts.greedy_with_restarts(search, names, seed) is PLAN  # type: ignore[arg-type]
    return Scripted.asked


def test_luby_numbers() -> None:
    assert [restarts.luby(k) for k in range(1, 16)] == [1, 1, 2, 1, 1, 2, 4, 1, 1, 2, 1, 1, 2, 4, 8]


def test_without_a_stall_there_is_one_search(monkeypatch: pytest.MonkeyPatch) -> None:
    assert asked(monkeypatch, 1, ("ff",)) == [(1, ("ff",), False, 0, restarts.STALLED_STATES)]


def test_ways_of_two_heuristics_are_taken_in_turn_and_the_first_search_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    both = ("ff", "landmarks")
    found = asked(monkeypatch, 9, both)
    assert [(number, names, achievers) for number, names, achievers, _, _ in found] == [
        (1, both, False),
        (2, both, False), (3, both, True), (4, ("ff",), False), (1, both, False),
        (5, both, False), (6, both, True), (7, ("ff",), False), (1, both, False),
    ]  # fmt: skip
    unit = restarts.SHORTEST_RESTART_STATES
    assert [patience for *_, patience in found[1:]] == [
        unit, unit, 2 * unit, unit, unit, 2 * unit, 4 * unit, unit,
    ]  # fmt: skip
    randoms = [random for number, _, _, random, _ in found if number > 1]
    assert len(set(randoms)) == len(randoms) and all(random % 2 for random in randoms)


def test_the_seed_decides_the_orders(monkeypatch: pytest.MonkeyPatch) -> None:
    first, again, other = (asked(monkeypatch, 6, ("ff",), seed) for seed in (1, 1, 2))
    assert first == again != other


@pytest.mark.parametrize(
    ("names", "ways"),
    [
        (("ff",), [Way(("ff",))]),
        (("landmarks",), [Way(("landmarks",)), Way(("landmarks",), achievers=True)]),
    ],
)
def test_a_single_heuristic_has_fewer_ways(names: tuple[str, ...], ways: list[Way]) -> None:
    assert restarts.ways(names) == restarts.ways(names, [7]) == ways


def test_goals_by_their_order_come_first_where_they_have_one() -> None:
    names = ("ff", "landmarks")
    first, second, *others = restarts.ways(names, [1, 7])
    assert first == Way(names, agenda=(1, 7))
    assert second == Way(names, agenda=(1, 7), singly=True)
    assert others == restarts.ways(names) and len(others) == 3


def test_a_stalled_agenda_gives_way_to_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    taken: list[tuple[tuple[int, ...], bool]] = []

    def by_agenda(search: Any, way: Way, random: int, states: int) -> Plan:
        taken.append((way.agenda, way.singly))
        raise Stalled

    Scripted.asked, Scripted.made, Scripted.found_at = [], 0, 4
    monkeypatch.setattr(restarts, "PackedSearch", Scripted)
    monkeypatch.setattr(restarts, "by_agenda", by_agenda)
    monkeypatch.setattr(restarts, "goal_agenda", lambda s, deadline: [1, 3])
    monkeypatch.setattr(restarts, "guard_agenda", lambda s: [1])
    search = SimpleNamespace(successors=None, deadline=None)
    assert restarts.greedy_with_restarts(search, ("ff",)) is PLAN  # type: ignore[arg-type]
    assert [number for number, *_ in Scripted.asked] == [1, 2, 1, 3]
    assert taken == [((1, 3), False), ((1, 3), True)] * 2


def test_goals_that_guards_order_come_in_parts_from_the_start() -> None:
    """Where the front is full the back costs 9 more, and nothing empties it again: the back first."""
    guard = Guard(facts("front"), ("squeezed",))
    operators = [
        operator("near", "", "front"), operator("deep", "", "back", guards=(guard,)),
        *(operator(f"idle{k}", "", f"i{k}") for k in range(3)),
    ]  # fmt: skip
    s = Successors(task(operators, "front back"), {("squeezed",): 9.0})
    run = SearchSpace(s, [], None, None)
    plan = restarts.greedy_with_restarts(run, ("ff",))
    assert plan is not None
    assert [operator.name for operator in plan.operators] == ["deep", "near"]
    assert plan.cost == 2.0 and run.first == 2.0 and run.expanded == 4


def test_an_order_by_guards_into_a_dead_end_is_left() -> None:
    """Deep uses up the key that near needs, too."""
    guard = Guard(facts("front"), ("squeezed",))
    operators = [
        operator("near", "key", "front"), operator("deep", "key", "back", deleted="key", guards=(guard,)),
    ]  # fmt: skip
    s = Successors(task(operators, "front back", "key"), {("squeezed",): 9.0})
    assert len(restarts.guard_agenda(s)) == 2
    plan = restarts.greedy_with_restarts(SearchSpace(s, [], None, None), ("ff",))
    assert plan is not None and plan.cost == 11.0
    assert [operator.name for operator in plan.operators] == ["near", "deep"]
