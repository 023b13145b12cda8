"""The order in which a skeleton's stream calls are bound: what fails early comes first."""

from __future__ import annotations

from collections.abc import Sequence
from heapq import heapify, heappop, heappush

from tamp.symbolic.algorithms.binding.skeleton import CallNode, Term


def ordered(nodes: Sequence[CallNode]) -> tuple[CallNode, ...]:
    """Order the calls to fail early: tests once they can be, generators by step, motions last."""
    merged: dict[tuple[object, ...], CallNode] = {}
    same: dict[int, CallNode] = {}
    for node in nodes:
        key: tuple[object, ...] = (node.stream.name, node.inputs, node.outputs, node.fluents)
        same[id(node)] = merged.setdefault(key, node)

    calls = list(merged.values())
    places = {id(node): position for position, node in enumerate(calls)}
    makers = {
        variable: position for position, node in enumerate(calls) for variable in node.outputs
    }

    waits: list[set[int]] = []
    users: dict[int, list[int]] = {}
    for position, node in enumerate(calls):
        terms: list[Term] = [
            *node.inputs,
            *(term for (_, shown), _ in node.fluents for term in shown),
        ]
        waits.append({makers[term] for term in terms if isinstance(term, int)})
        waits[-1] |= {places[id(same[id(needed)])] for needed in node.needs} - {position}
        for maker in waits[-1]:
            users.setdefault(maker, []).append(position)

    ready = [(*_rank(node), position) for position, node in enumerate(calls) if not waits[position]]
    heapify(ready)
    order: list[CallNode] = []
    while ready:
        position = heappop(ready)[-1]
        order.append(calls[position])
        for user in users.get(position, ()):
            waits[user].discard(position)
            if not waits[user]:
                heappush(ready, (*_rank(calls[user]), user))

    if len(order) < len(calls):
        raise ValueError("the plan's stream calls depend on each other in a circle")
    return tuple(order)


def _rank(node: CallNode) -> tuple[int, int]:
    """Rank tests, then generators, then what depends on the whole state; each by its step."""
    return (0 if node.stream.is_test else 2 if node.stream.is_fluent else 1, node.step)
