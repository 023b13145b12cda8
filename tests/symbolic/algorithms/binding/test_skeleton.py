"""A skeleton: who makes a variable, who uses it, what tells skeletons apart, what is recalled."""

from __future__ import annotations

from tamp.symbolic.algorithms.binding.skeleton import CallNode, Skeleton, Step
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.structs import Stream

NOTHING = frozenset[tuple[str, ...]]()


def step(name: str, *arguments: str) -> Step:
    return Step(name, arguments, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, ())


def node(
    name: str,
    inputs: tuple[int | str, ...],
    outputs: tuple[int, ...],
    guess: tuple[str, ...] = (),
    shown: tuple[int | str, ...] = (),
) -> CallNode:
    """A call; `shown` are the terms of one fluent fact that its function looks at."""
    stream = BoundStream(Stream(name, (), (), (), ()), lambda: None, ())
    fluents = (((("at", shown), ("at", *map(str, shown))),) if shown else ())  # fmt: skip
    return CallNode(stream, (guess, ()), inputs, outputs, 0, (name,), fluents)


def skeleton(*nodes: CallNode, steps: tuple[Step, ...] = ()) -> Skeleton:
    return Skeleton(steps, (), nodes, ())


def test_each_variable_has_a_maker_and_each_call_its_users() -> None:
    made = skeleton(
        node("pose", ("cup",), (1,)),
        node("grasp", ("cup",), (2,)),
        node("kin", ("cup", 1, 2), (3, 4)),
        node("motion", (3,), (5,), shown=("cup", 1)),
    )
    assert made.makers == {1: 0, 2: 1, 3: 2, 4: 2, 5: 3}
    assert made.users == [[2, 3], [2], [3], []]


def test_what_a_call_is_shown_twice_is_used_once() -> None:
    made = skeleton(node("pose", (), (1,)), node("test", (1, 1), (), shown=(1, "cup")))
    assert made.users == [[1], []]


def test_a_shown_variable_that_nothing_makes_is_no_use_of_anything() -> None:
    made = skeleton(node("pose", (), (1,)), node("test", (1,), (), shown=(7,)))
    assert made.users == [[1], []]


def test_skeletons_are_told_apart_by_their_actions() -> None:
    one = skeleton(steps=(step("pick", "cup"), step("place", "cup")))
    assert one.signature == (("pick", ("cup",)), ("place", ("cup",)))
    assert one.signature != skeleton(steps=(step("place", "cup"), step("pick", "cup"))).signature


def test_calls_that_look_alike_are_counted() -> None:
    made = skeleton(
        node("pose", (), (1,), ("cup",)),
        node("pose", (), (2,), ("jar",)),
        node("pose", (), (3,), ("cup",)),
    )
    cup, jar = (("cup",), ()), (("jar",), ())
    assert made.calls == {("pose", cup, 0): 0, ("pose", jar, 0): 1, ("pose", cup, 1): 2}


def test_values_are_recalled_where_a_call_is_the_same() -> None:
    earlier = skeleton(
        node("pose", (), (1,), ("cup",)), node("grasp", (), (2,)), node("pose", (), (3,), ("cup",))
    )
    earlier.memory = {0: (("a",), ("p1",)), 1: ((), ("g1",)), 2: (("b",), ("p2",))}
    later = skeleton(
        node("grasp", (), (1,)), node("pose", (), (2,), ("jar",)), node("pose", (), (3,), ("cup",))
    )
    later.recall(earlier)
    assert later.memory == {0: ((), ("g1",)), 2: (("a",), ("p1",))}


def test_what_is_remembered_already_is_kept() -> None:
    earlier, later = (skeleton(node("pose", (), (1,))) for _ in range(2))
    earlier.memory, later.memory = {0: ((), ("old",))}, {0: ((), ("new",))}
    later.recall(earlier)
    assert later.memory == {0: ((), ("new",))}
    fresh = skeleton(node("pose", (), (1,)))
    fresh.recall(skeleton(node("pose", (), (1,))))
    assert fresh.memory == {}
