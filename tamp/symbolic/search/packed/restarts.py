"""Greedy search that begins anew where it stalls, in another order, by another heuristic.

The first search goes on in turn with the others, so what it would find by itself is found, with a
constant factor more states; so is a proof that there is no plan.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import count
from random import Random

from tamp.symbolic.search.expansion import Plan, SearchSpace
from tamp.symbolic.search.packed.search import PackedSearch, Stalled

STALLED_STATES = 3000
"""Expanded states without progress after which the first search counts as stalled: one that goes
down steadily, if slowly, is not disturbed."""

SHORTEST_RESTART_STATES = 3000
"""Such states of the shortest restart."""


def luby(number: int) -> int:
    """Return an element, from 1 on, of 1, 1, 2, 1, 1, 2, 4, ... (Luby et al. 1993)."""
    k = number.bit_length()
    return 1 << k - 1 if number == (1 << k) - 1 else luby(number - (1 << k - 1) + 1)


def ways(names: Sequence[str]) -> list[tuple[tuple[str, ...], bool]]:
    """List what restarts take in turn: heuristics, and whether achievers are preferred."""
    found = [(tuple(names), False)]
    if "landmarks" in names:
        found.append((tuple(names), True))
    if len(names) > 1:
        found.append((("ff",), False))
    return found


def _turns(names: Sequence[str]) -> Iterator[tuple[tuple[str, ...], bool] | None]:
    """Yield the restarts' ways in turn, and None where the first search is to go on."""
    while True:
        yield from ways(names)
        yield None


def greedy_with_restarts(search: SearchSpace, names: Sequence[str], seed: int = 0) -> Plan | None:
    """Search greedily; where that stalls, begin anew in random order, with growing limits.

    Args:
        search: The task, its limits and counts.
        names: The heuristics of the first search.
        seed: Of the random orders.
    """
    first = PackedSearch(search, names, math.inf)
    try:
        return first.plan(STALLED_STATES)
    except Stalled:
        pass

    rng = Random(seed)
    for number, way in zip(count(1), _turns(names), strict=False):
        states = SHORTEST_RESTART_STATES * luby(number)
        try:
            if way is None:
                return first.plan(states)
            heuristics, achievers = way
            random = rng.getrandbits(60) | 1
            return PackedSearch(search, heuristics, math.inf, random, achievers).plan(states)
        except Stalled:
            continue
    return None
