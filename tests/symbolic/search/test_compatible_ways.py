"""One way for each goal such that all go together pair by pair, against all choices written out."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from random import Random

import pytest

from tamp.symbolic.search import compatible_ways
from tamp.symbolic.search.compatible_ways import Way, hold_together

Pairs = set[frozenset[int]]


def partners_of(facts: int, apart: Pairs) -> Callable[[Way], int]:
    """What goes with all facts of a way, by a list of the pairs that do not go together."""

    def partners(way: Way) -> int:
        return sum(
            1 << other
            for other in range(facts)
            if all(frozenset((one, other)) not in apart for one in way)
        )

    return partners


def asked(goals: Sequence[Sequence[Way]], apart: Sequence[tuple[int, int]], facts: int = 9) -> bool:
    return hold_together(goals, partners_of(facts, set(map(frozenset, apart))), lambda: None)


@pytest.mark.parametrize(
    ("goals", "apart", "together"),
    [
        ([], [], True),
        ([[]], [], False),
        ([[(0,)], []], [], False),
        ([[()], [()]], [], True),
        ([[(0,)], [(1,)]], [], True),
        ([[(0,)], [(1,)]], [(0, 1)], False),
        ([[(0,), (2,)], [(1,)]], [(0, 1)], True),
        ([[(0, 2)], [(1,)]], [(1, 2)], False),
        ([[(0,)], [(1, 2)]], [(0, 2)], False),
        ([[(0,)], [(0,)]], [], True),
    ],
)
def test_small_choices(
    goals: list[list[Way]], apart: list[tuple[int, int]], together: bool
) -> None:
    """No goals always hold; one without a way never does; a way without facts goes with all."""
    assert asked(goals, apart) is together


def test_three_goals_of_two_ways_each_that_only_go_together_two_by_two() -> None:
    """As colours of a triangle's corners, of which there are two: arc consistency leaves all ways."""
    red, blue = (0, 1, 2), (3, 4, 5)
    apart = [pair for colour in (red, blue) for pair in itertools.combinations(colour, 2)]
    assert not asked([[(0,), (3,)], [(1,), (4,)], [(2,), (5,)]], apart)
    assert asked([[(0,), (3,)], [(1,), (4,)], [(2,), (5,), (6,)]], apart)
    assert asked([[(0,), (3,)], [(1,), (4,)]], apart)


def brute_force(goals: Sequence[Sequence[Way]], apart: Pairs) -> bool:
    return any(
        all(
            frozenset((one, other)) not in apart
            for first, second in itertools.combinations(choice, 2)
            for one in first
            for other in second
        )
        for choice in itertools.product(*goals)
    )


def test_random_choices() -> None:
    """Facts of a way go together, as they do in the ways that are asked about."""
    told: list[bool] = []
    for seed in range(300):
        rng = Random(seed)
        facts = range(8)
        apart = {frozenset(p) for p in itertools.combinations(facts, 2) if rng.random() < 0.45}
        ways = [
            way
            for size in (1, 2)
            for way in itertools.combinations(facts, size)
            if frozenset(way) not in apart
        ]
        goals = [rng.sample(ways, min(len(ways), rng.randint(1, 4))) for _ in range(4)]
        told.append(hold_together(goals, partners_of(8, apart), lambda: None))
        assert told[-1] == brute_force(goals, apart)
    assert 50 < sum(told) < 250


def test_what_takes_too_many_choices_is_left_undecided(monkeypatch: pytest.MonkeyPatch) -> None:
    """Too few colours for a clique that no pair of corners excludes: false, if one may look long enough."""
    corners, colours = 5, 4
    number = {pair: i for i, pair in enumerate(itertools.product(range(corners), range(colours)))}
    goals = [[(number[corner, colour],) for colour in range(colours)] for corner in range(corners)]
    apart = [
        (number[a, colour], number[b, colour])
        for a, b in itertools.combinations(range(corners), 2)
        for colour in range(colours)
    ]
    assert not asked(goals, apart, len(number))
    monkeypatch.setattr(compatible_ways, "MAX_CHOICES", 20)
    assert asked(goals, apart, len(number))


def test_it_ends_when_the_time_is_up() -> None:
    def look() -> None:
        raise TimeoutError

    with pytest.raises(TimeoutError):
        hold_together([[(0,)], [(1,)]], partners_of(2, set()), look)
