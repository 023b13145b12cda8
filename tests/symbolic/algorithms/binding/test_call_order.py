"""The order of stream calls against networkx: each after what it needs, and the first in rank of those ready."""

from __future__ import annotations

from random import Random

import networkx as nx
import pytest

from tamp.symbolic.algorithms.binding.call_order import ordered
from tamp.symbolic.algorithms.binding.skeleton import CallNode
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.structs import Stream

TEST, GENERATOR, FLUENT = 0, 1, 2


def node(
    kind: int, name: str, inputs: tuple[int | str, ...], outputs: tuple[int, ...], step: int = 0
) -> CallNode:
    """A call of a stream of one of the three kinds."""
    fluents = ("at",) if kind == FLUENT else ()
    declared = ("?o",) if kind == GENERATOR or outputs else ()
    stream = BoundStream(Stream(name, (), (), declared, (), fluents), lambda: None, (("object",),))
    assert stream.is_test == (kind == TEST) or kind == FLUENT
    return CallNode(stream, (tuple(map(str, inputs)), ()), inputs, outputs, step, (name,))


def rank(one: CallNode) -> tuple[int, int]:
    return (TEST if one.stream.is_test else FLUENT if one.stream.is_fluent else GENERATOR, one.step)


def test_random_calls_are_in_the_first_topological_order_by_rank() -> None:
    lengths = 0
    for seed in range(200):
        random = Random(seed)
        nodes: list[CallNode] = []
        for number in range(random.randint(1, 12)):
            made = [variable for one in nodes for variable in one.outputs]
            inputs = tuple(random.sample(made, min(len(made), random.randint(0, 2))))
            kind = random.choice((TEST, GENERATOR, GENERATOR, FLUENT))
            outputs = () if kind == TEST else (number,)
            one = node(kind, f"s{number}", inputs, outputs, random.randint(0, 3))
            one.needs = random.sample(nodes, min(len(nodes), random.randint(0, 1)))
            nodes.append(one)

        graph = nx.DiGraph()
        graph.add_nodes_from(range(len(nodes)))
        producer = {variable: place for place, one in enumerate(nodes) for variable in one.outputs}
        for place, one in enumerate(nodes):
            graph.add_edges_from(
                (producer[term], place) for term in one.inputs if isinstance(term, int)
            )
            graph.add_edges_from((nodes.index(needed), place) for needed in one.needs)

        first = nx.lexicographical_topological_sort(
            graph, key=lambda place: (*rank(nodes[place]), place)
        )
        assert ordered(nodes) == tuple(nodes[place] for place in first), seed
        lengths += len(nodes)
    assert lengths > 800


def test_calls_in_a_circle_are_an_error() -> None:
    first, second = node(GENERATOR, "a", (1,), (0,)), node(GENERATOR, "b", (0,), (1,))
    with pytest.raises(ValueError, match="circle"):
        ordered([first, second])


def test_the_same_call_is_kept_once_and_whoever_needs_it_comes_later() -> None:
    first, again = node(TEST, "t", ("x",), ()), node(TEST, "t", ("x",), ())
    again.stream, user = first.stream, node(TEST, "u", ("x",), (), -1)
    user.needs = [again]
    assert ordered([first, again, user]) == (first, user)


def test_a_call_may_need_itself_through_a_copy() -> None:
    first, again = node(TEST, "t", ("x",), ()), node(TEST, "t", ("x",), ())
    again.stream, first.needs = first.stream, [again]
    assert ordered([first, again]) == (first,)


def test_tests_come_as_soon_as_they_can_and_motions_last() -> None:
    motion = node(FLUENT, "plan", (0,), (2,), 0)
    pose, grasp = node(GENERATOR, "pose", (), (0,), 0), node(GENERATOR, "grasp", (), (1,), 1)
    clear = node(TEST, "clear", (0,), (), 3)
    assert ordered([motion, grasp, pose, clear]) == (pose, clear, grasp, motion)


def test_fluents_shown_are_waited_for() -> None:
    motion, pose = node(FLUENT, "plan", (), (1,), 0), node(GENERATOR, "pose", (), (0,), 5)
    motion.fluents = ((("at", ("mug", 0)), ("at", "mug", "#p1")),)
    assert ordered([motion, pose]) == (pose, motion)
