"""A user's own relation: poses that rest and that nobody's classifier denies, and what the classifier says."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import pytest

from tamp.geometric.context import Context
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.streams.user_relations import (
    fails_relation,
    sample_relation,
    test_relation,
)
from tamp.stream import Call, Rejection, RejectionKind
from tamp.system.deadline import Deadline
from tests.geometric.streams.scenes import problem_with

holds_relation = test_relation
del test_relation  # it is no test of pytest's


@pytest.fixture(scope="module")
def context(tmp_path_factory: pytest.TempPathFactory) -> Context:
    return problem_with("box", tmp_path_factory.mktemp("scene")).context


def call(**more: Any) -> Call:
    return Call(np.random.default_rng(0), Deadline(60.0), **more)


class Saying:
    """A classifier with one answer, that remembers the scenes that it saw."""

    def __init__(self, number: float) -> None:
        self.number, self.seen = number, list[tuple[Scene, tuple[str, ...]]]()

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        self.seen.append((scene, tuple(arguments)))
        return self.number


class Once:
    """Proposes these poses, once."""

    def __init__(self, *poses: Pose) -> None:
        self.poses = list(poses)

    def propose(self, scene: Scene, arguments: Sequence[str], count: int, rng: Any) -> list[Pose]:
        made, self.poses = self.poses, []
        return made


def stands(context: Context, x: float, y: float, z: float = 0.0) -> Pose:
    """A pose of the box beside its start, by metres along the world's axes."""
    start = context.scene.bodies["box"].pose
    return Pose((x, y, z)) @ start


def sampled(context: Context, *poses: Pose, **more: Any) -> list[Pose | Rejection]:
    made: Iterator[Pose | Rejection] = sample_relation(
        context, "box", "table", relation="by", generator=Once(*poses), call=call(), **more
    )
    return list(made)


def test_a_pose_over_its_place_is_put_to_rest_there(context: Context) -> None:
    (made,) = sampled(context, stands(context, 0.0, 0.1, 0.004))
    assert isinstance(made, Pose)
    assert made.position[:2] == pytest.approx(stands(context, 0.0, 0.1).position[:2], abs=1e-9)
    assert made.position[2] == pytest.approx(stands(context, 0.0, 0.1).position[2], abs=1e-3)


def test_what_rests_nowhere_or_hits_what_is_fixed_is_refused(context: Context) -> None:
    lamp = context.scene.bodies["lamp"].pose.position
    start = context.scene.bodies["box"].pose
    inside = Pose((lamp[0] - start.position[0], lamp[1] - start.position[1], 0.0)) @ start
    assert sampled(context, stands(context, 0.0, 0.0, 0.5)) == [
        Rejection("rests nowhere", kind=RejectionKind.UNSTABLE)
    ]
    assert sampled(context, inside) == [Rejection.hits("lamp")]


@pytest.mark.parametrize(("number", "kept"), [(0.9, True), (0.5, True), (0.2, False)])
def test_a_classifier_that_no_stream_asks_is_asked_of_each_pose(
    number: float, kept: bool, context: Context
) -> None:
    classifier = Saying(number)
    (made,) = sampled(context, stands(context, 0.0, 0.1), judge=(classifier, (0, 1)))
    assert isinstance(made, Pose) is kept
    if isinstance(made, Rejection):
        assert made == Rejection("unlikely (0.20)", kind=RejectionKind.UNLIKELY)
    ((scene, words),) = classifier.seen
    assert words == ("box", "table")
    shown = scene.bodies["box"].pose.position  # at the pose that is asked about, not at the start
    assert shown[1] == pytest.approx(stands(context, 0.0, 0.1).position[1], abs=1e-6)


Answering = Callable[..., bool | Rejection]


@pytest.mark.parametrize(
    ("number", "holds", "fails"),
    [
        (0.8, True, "likely (0.80)"),
        (0.3, "unlikely (0.30)", True),
        (math.nan, "cannot tell", "cannot tell"),
    ],
)
def test_a_test_and_its_opposite_say_what_the_classifier_says(
    number: float, holds: bool | str, fails: bool | str, context: Context
) -> None:
    asked: list[tuple[Answering, bool | str]] = [(holds_relation, holds), (fails_relation, fails)]
    for stream, expected in asked:
        pose = stands(context, 0.2, 0.0)
        answer = stream(context, "box", pose, "table", classifier=Saying(number), call=call())
        if isinstance(expected, str):
            assert answer == Rejection(expected, kind=RejectionKind.UNLIKELY)
        else:
            assert answer is expected


def test_bodies_are_where_the_arguments_and_the_step_have_them(context: Context) -> None:
    classifier, pose = Saying(1.0), stands(context, 0.2, 0.0)
    holds_relation(context, "box", pose, "table", classifier=classifier, call=call())
    holds_relation(context, "box", "table", classifier=classifier, call=call())
    facts = [("at-pose", "box", stands(context, 0.0, 0.3))]
    holds_relation(context, "box", "table", classifier=classifier, call=call(fluents=facts))
    places = [scene.bodies["box"].pose.position for scene, _ in classifier.seen]
    assert places == [
        pose.position,
        context.scene.bodies["box"].pose.position,
        stands(context, 0.0, 0.3).position,
    ]
