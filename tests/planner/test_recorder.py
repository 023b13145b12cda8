"""A recorder hears what streams draw and refuse, changes none of it, and forgets nothing that the plan uses."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.values import Grasp
from tamp.planner.recorder import Recorder
from tamp.stream import Call, Rejection, Wild
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.structs import Stream
from tamp.system.deadline import Deadline


def bound(name: str, function: Any, outputs: tuple[str, ...] = ("?p",)) -> BoundStream:
    return BoundStream(Stream(name, ("?o",), (), outputs, ()), function, ())


def watched(recorder: Recorder, *streams: BoundStream) -> list[Any]:
    task = StreamTask(None, streams, {})  # type: ignore[arg-type]
    return [stream.function for stream in recorder.watched(task).streams]


def call() -> Call:
    return Call(np.random.default_rng(0), Deadline(math.inf))


def at(x: float) -> Pose:
    return Pose((x, 0.0, 0.0))


def drawing(*values: Any) -> Any:
    def draw(*inputs: Any, call: Call) -> Iterator[Any]:
        yield from values

    return draw


def test_what_is_drawn_passes_as_it_is_and_is_kept_once() -> None:
    recorder = Recorder()
    (draw,) = watched(recorder, bound("sample-on", drawing(at(1), Rejection("no"), at(2), at(1))))
    assert list(draw("cup", "table", call=call())) == [at(1), Rejection("no"), at(2), at(1)]
    assert [(one.stream, one.arguments, one.value) for one in recorder.samples] == [
        ("sample-on", ("cup", "table"), at(1)),
        ("sample-on", ("cup", "table"), at(2)),
    ]


def test_what_is_drawn_lazily_is_heard_lazily() -> None:
    recorder = Recorder()
    (draw,) = watched(recorder, bound("sample-on", drawing(at(1), at(2))))
    tries = draw("cup", call=call())
    assert recorder.samples == []
    next(tries)
    assert len(recorder.samples) == 1


def test_a_tests_no_is_counted_on_its_first_pose_and_its_grasp() -> None:
    recorder, grasp = Recorder(), Grasp("cup", Pose(), 0.05)
    draw, take, test = watched(
        recorder,
        bound("sample-on", drawing(at(1), at(2))),
        bound("sample-grasp", drawing(grasp)),
        bound("test-clear", lambda *_, call: Rejection("hits box"), ()),
    )
    list(draw("cup", call=call()))
    list(take("cup", call=call()))
    for _ in range(3):
        assert test("cup", at(1), grasp, at(2), call=call()) == Rejection("hits box")
    counts = [dict(one.refusals) for one in recorder.samples]
    assert counts == [{("test-clear", "hits box"): 3}, {}, {("test-clear", "hits box"): 3}]


def test_wild_outputs_are_heard_as_what_they_hold() -> None:
    recorder = Recorder()
    (draw,) = watched(recorder, bound("sample-on", drawing(Wild(at(1), [("near", 1)]))))
    assert isinstance(next(draw("cup", call=call())), Wild)
    assert [one.value for one in recorder.samples] == [at(1)]


def test_a_proposal_that_its_stream_refuses_is_told_with_the_reason() -> None:
    def draw(*inputs: Any, call: Call) -> Iterator[Any]:
        call.refused(at(5), "sinks in")
        call.refused(at(5), Rejection.hits("box"))
        call.refused(at(5), Rejection("hits box", bodies=("box", "lid")))
        yield at(6)

    recorder = Recorder()
    (heard,) = watched(recorder, bound("sample-on", draw))
    list(heard("cup", call=call()))
    assert [(one.value, dict(one.refusals)) for one in recorder.samples] == [
        (at(5), {("sample-on", "sinks in"): 1, ("sample-on", "hits box"): 2}),
        (at(6), {}),
    ]
    met = {("sample-on", "sinks in"): (), ("sample-on", "hits box"): ("box", "lid")}
    assert recorder.samples[0].met == met


def test_one_body_that_is_hard_to_place_leaves_room_for_others() -> None:
    recorder = Recorder(limit=5, each=2)
    (draw,) = watched(recorder, bound("sample-on", drawing(*(at(x) for x in range(4)))))
    list(draw("cup", call=call()))
    assert [one.value for one in recorder.samples] == [at(0), at(1)] and recorder.dropped == 2
    (more,) = watched(recorder, bound("sample-on", drawing(*(at(x) for x in range(10, 14)))))
    list(more("box", call=call()))
    assert len(recorder.samples) == 4 and recorder.dropped == 4


def test_what_the_plan_uses_comes_back_with_its_refusals() -> None:
    recorder = Recorder(limit=1)
    draw, test = watched(
        recorder,
        bound("sample-on", drawing(at(1), at(2), at(3))),
        bound("test-clear", lambda *_, call: Rejection("hits box"), ()),
    )
    list(draw("cup", call=call()))
    test("cup", at(2), call=call())
    record = recorder.record((), [at(2), "cup", at(1)])
    assert [one.value for one in record.samples] == [at(1), at(2)] and record.dropped == 1
    assert dict(record.samples[1].refusals) == {("test-clear", "hits box"): 1}


def test_a_value_of_no_named_object_is_not_kept() -> None:
    recorder = Recorder()
    (draw,) = watched(recorder, bound("sample", drawing(at(1))))
    list(draw(at(9), call=call()))
    assert recorder.samples == []
