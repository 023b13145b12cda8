"""Open lists of lazy search: turns, the boost of preferred operators, the order among equals."""

from __future__ import annotations

import math

from tamp.symbolic.search.heuristics.registry import Estimate
from tamp.symbolic.search.open_lists import GOAL_ENTRY, Expanded, OpenLists

INITIAL = 1


def parent(*values: float) -> Expanded:
    return Expanded(INITIAL, 0.0, tuple(map(Estimate, values)), values)


def popped(lists: OpenLists) -> list[int]:
    """All states that are left, in the order in which they are popped."""
    found: list[int] = []
    while (entry := lists.pop()) is not None:
        found.append(entry[3])
    return found


def begun(count: int, weight: float) -> OpenLists:
    """Lists whose initial entries are taken out."""
    lists = OpenLists(INITIAL, count, weight)
    assert popped(lists) == [INITIAL] * count
    return lists


def test_a_successor_waits_in_the_lists_of_all_heuristics() -> None:
    lists = begun(2, math.inf)
    lists.push(parent(3.0, 5.0), 0, 2, 1.0, 1.0, 0, False)
    assert popped(lists) == [2, 2]


def test_progress_has_preferred_successors_go_first() -> None:
    for boosted, expected in ((True, [3, 4, 5, 2, 3, 4, 5]), (False, [3, 4, 2, 5, 3, 4, 5])):
        lists = begun(1, math.inf)
        if boosted:
            lists.boost((2.0,))
        lists.push(parent(1.0), 0, 2, 1.0, 1.0, 0, False)
        for state in (3, 4, 5):
            lists.push(parent(2.0), 0, state, 1.0, 1.0, state, True)
        assert popped(lists) == expected


def test_costs_count_but_in_greedy_search() -> None:
    for weight, expected in ((math.inf, [2, 3]), (1.0, [3, 2])):
        lists = begun(1, weight)
        lists.push(parent(1.0), 0, 2, 9.0, 9.0, 0 if weight == math.inf else None, False)
        lists.push(parent(2.0), 1, 3, 1.0, 1.0, 1 if weight == math.inf else None, False)
        assert popped(lists) == expected


def test_a_priced_goal_waits_for_what_is_cheaper() -> None:
    lists = begun(1, 1.0)
    lists.push_goal(7, 5.0, 4.0)
    lists.push(parent(1.0), 0, 2, 3.0, 3.0, None, False)
    first, entry = lists.pop(), lists.pop()
    assert first is not None and first[3] == 2
    assert entry is not None and entry[3] == 7 and entry[5] == GOAL_ENTRY
    assert lists.pop() is None
