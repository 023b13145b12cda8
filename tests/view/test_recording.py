"""Listening to a run changes nothing about it, and hears why samples were refused."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from tamp import Solution, load_problem, solve
from tamp.geometric.scene.pose import Pose
from tamp.geometric.values import Grasp
from tamp.plan.write import plan_document
from tamp.planner.recorder import Recorder
from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.structs import And, Domain, Stream, Task
from tamp.system.deadline import Deadline
from tamp.verification.verify import verify
from tamp.view.open import timeline_of_solution
from tamp.view.samples import sample_markers


def planned(name: str, record: bool) -> Solution:
    return solve(load_problem(name), max_time=60.0, seed=0, record=record)


@pytest.fixture(scope="module")
def recorded() -> Solution:
    return planned("packed", record=True)


def test_the_plan_is_the_same_and_holds(recorded: Solution, root: Path) -> None:
    document, plain = plan_document(recorded), plan_document(planned("packed", record=False))
    record = document.pop("record")
    assert "record" not in plain
    assert document | {"timing": 0} == plain | {"timing": 0}
    document["record"] = json.loads(json.dumps(record))
    schema = json.loads((root / "tamp" / "plan" / "plan.schema.json").read_text(encoding="utf-8"))
    jsonschema.validate(document, schema)
    assert verify(document).holds


def test_refused_samples_say_by_which_test_and_what_they_hit(recorded: Solution) -> None:
    assert recorded.record is not None and recorded.record.dropped == 0
    found = sample_markers(plan_document(recorded), recorded.problem.scene)
    placements = [shot for shot in found if shot.kind == "placement"]
    refused = [shot for shot in placements if shot.test is not None and not shot.used]
    hits = [shot for shot in refused if "hits " in shot.text]
    assert len(hits) > 10
    bodies = set(recorded.problem.scene.bodies)
    for shot in hits:
        assert shot.others
        assert set(shot.others) <= bodies - {shot.body}
    assert {shot.test for shot in hits} >= {"sample-on"}
    used = [shot for shot in placements if shot.used]
    placed = {action.objects[0] for action in recorded.plan if action.name == "place"}
    assert {shot.body for shot in used} == placed and all(
        "in the plan" in shot.text for shot in used
    )
    assert any(shot.kind == "grasp" and shot.used for shot in found)


def test_skeletons_are_told_with_what_failed(recorded: Solution) -> None:
    assert recorded.record is not None
    *_, last = recorded.record.attempts
    assert last.bound
    assert len(last.actions) == len(recorded.plan)
    assert last.actions[1] == f"pick {recorded.plan[1].objects[0]}"


def test_without_a_plan_the_scene_shows_what_was_tried() -> None:
    impossible = solve(load_problem("impossible_size"), max_time=60.0, seed=0, record=True)
    assert not impossible.solved
    timeline, story, document = timeline_of_solution(impossible)
    assert timeline.actions == () and story.why and story.head.startswith("No plan")
    assert story.why == impossible.explanation
    assert document["record"] is not None


def declared(name: str, inputs: tuple[str, ...], outputs: tuple[str, ...] = ()) -> Stream:
    return Stream(name, inputs, (), outputs, ())


def heard(recorder: Recorder, stream: BoundStream, *inputs: Any) -> Any:
    domain = Domain("d", {}, {}, {}, {}, (), ())
    task = StreamTask(Task("t", domain, {}, frozenset(), And(()), {}), (stream,), {})
    (watched,) = recorder.watched(task).streams
    made = watched.function(*inputs, call=Call(None, Deadline(10.0)))
    return made if watched.is_test else list(made)


def test_the_subject_is_blamed_and_not_what_is_in_its_way() -> None:
    recorder = Recorder()
    mine, other = Pose((1.0, 0.0, 0.0)), Pose((2.0, 0.0, 0.0))
    grasp = Grasp("mug", Pose(), 0.04)
    for body, value in (("mug", mine), ("can", other), ("mug", grasp)):
        draw = BoundStream(
            declared("draw", ("?o",), ("?p",)), lambda _, call, value=value: iter([value]), ((),)
        )
        assert heard(recorder, draw, body) == [value]
    test = BoundStream(
        declared("test", ("?o",)), lambda *_, call: Rejection("hits can", ("can",)), ()
    )
    assert heard(recorder, test, "mug", mine, grasp, "can", other) == Rejection(
        "hits can", ("can",)
    )
    refusals = [dict(sample.refusals) for sample in recorder.samples]
    assert refusals == [{("test", "hits can"): 1}, {}, {("test", "hits can"): 1}]


def test_samples_are_capped_and_counted() -> None:
    recorder = Recorder(limit=5, each=3)
    poses = [Pose((float(i), 0.0, 0.0)) for i in range(8)]
    draw = BoundStream(
        declared("draw", ("?o",), ("?p",)),
        lambda body, call: iter(poses if body == "mug" else []),
        ((),),
    )
    assert heard(recorder, draw, "mug") == poses
    more = [Pose((float(i), 1.0, 0.0)) for i in range(8)]
    draw = BoundStream(declared("draw", ("?o",), ("?p",)), lambda _, call: iter(more), ((),))
    assert heard(recorder, draw, "can") == more
    assert [sample.arguments[0] for sample in recorder.samples] == ["mug"] * 3 + ["can"] * 2
    assert recorder.record(()).dropped == 11
    late = recorder.record((), [more[7], poses[0], "a motion"])  # the plan's own are never dropped
    assert late.samples[-1].value == more[7] and len(late.samples) == 6 and late.dropped == 10


def test_refused_proposals_leave_room_for_accepted_ones() -> None:
    recorder = Recorder(each=2)

    def draw(body: str, call: Call) -> Iterator[Pose]:
        for i in range(9):
            call.refused(Pose((float(i), 0.0, 0.0)), "falls")
            yield Pose((float(i), 1.0, 0.0))

    heard(recorder, BoundStream(declared("draw", ("?o",), ("?p",)), draw, ((),)), "mug")
    assert [len(sample.refusals) for sample in recorder.samples] == [1, 0, 1, 0]
