"""Each way to fail has its name, by the paper's oracle and in physics."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.body_geometry import BodyGeometry
from grounding.oracles import ItemOf, Verdict, drop_verdicts, paper_oracle, paper_verdicts
from grounding.relation_scene import Placed, Region, RelationScene
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Part
from tamp.simulation.engines import open_drops

TABLE = BodyGeometry((Part(Box((0.8, 0.6, 0.4))),))
BRICK = BodyGeometry((Part(Box((0.1, 0.06, 0.04))),))
WALLS = (
    Part(Box((0.4, 0.3, 0.02)), Pose((0.0, 0.0, 0.01))),
    *(Part(Box((0.02, 0.3, 0.2)), Pose((x, 0.0, 0.1))) for x in (-0.19, 0.19)),
    *(Part(Box((0.4, 0.02, 0.2)), Pose((0.0, y, 0.1))) for y in (-0.14, 0.14)),
)


def at(x: float, y: float, z: float, tilt: float = 0.0) -> np.ndarray:
    """T_world_body, turned about x."""
    matrix = np.eye(4)
    matrix[1:3, 1:3] = [[math.cos(tilt), -math.sin(tilt)], [math.sin(tilt), math.cos(tilt)]]
    matrix[:3, 3] = x, y, z
    return matrix


def on() -> RelationScene:
    """A brick, a table whose top is at 0.4 m, another brick on it at x = 0.2 m."""
    region = Region(
        False,
        at(0, 0, 0.2),
        np.array([0.8, 0.6, np.inf]),
        np.array([[-0.4, -0.3, -0.2], [0.4, 0.3, 0.2]]),
    )
    others = (Placed(BRICK, at(0.2, 0, 0.42)),)
    return RelationScene(Placed(TABLE, at(0, 0, 0.2)), region, Placed(BRICK, at(0, 0, 1.0)), others)


def inside() -> RelationScene:
    """A brick, a box open above on the ground with walls of 2 cm, another brick in it at x = 0.1 m."""
    box = np.array([[-0.2, -0.15, 0.0], [0.2, 0.15, 0.2]])
    region = Region(True, at(0, 0, 0.02), np.array([0.36, 0.26, 0.18]), box)
    others = (Placed(BRICK, at(0.1, 0, 0.04)),)
    return RelationScene(
        Placed(BodyGeometry(WALLS), np.eye(4)), region, Placed(BRICK, at(0, 0, 1.0)), others
    )


ON = [
    (at(0.0, 0.1, 0.4205), Verdict.HOLDS, Verdict.HOLDS),
    (at(0.0, 0.1, 0.38), Verdict.TOO_LOW, Verdict.TOO_LOW),
    (at(0.0, 0.1, 0.46), Verdict.TOO_HIGH, Verdict.TOO_HIGH),
    (at(0.42, 0.1, 0.4205), Verdict.OVERLAPPING, Verdict.OVERLAPPING),
    (at(0.5, 0.1, 0.4205), Verdict.OUTSIDE, Verdict.OUTSIDE),
    (at(0.15, 0.0, 0.4205), Verdict.COLLIDES, Verdict.COLLIDES),
    (at(0.0, 0.1, 0.41), Verdict.HOLDS, Verdict.PENETRATES),
    (at(0.0, 0.1, 0.4385, tilt=0.5), Verdict.HOLDS, Verdict.TIPS),
    (np.full((4, 4), np.nan), Verdict.OUTSIDE, Verdict.OUTSIDE),
]
INSIDE = [
    (at(-0.05, 0.05, 0.0405), Verdict.HOLDS, Verdict.HOLDS),
    (at(-0.05, 0.05, 0.0), Verdict.TOO_LOW, Verdict.TOO_LOW),
    (at(-0.05, 0.05, 0.2), Verdict.TOO_HIGH, Verdict.TOO_HIGH),
    (at(-0.19, 0.05, 0.0405), Verdict.OVERLAPPING, Verdict.OVERLAPPING),
    (at(-0.26, 0.05, 0.0405), Verdict.OUTSIDE, Verdict.OUTSIDE),
    (at(0.05, 0.0, 0.0405), Verdict.COLLIDES, Verdict.COLLIDES),
    (at(-0.05, 0.05, 0.035), Verdict.HOLDS, Verdict.PENETRATES),
    (at(-0.05, 0.05, 0.14), Verdict.HOLDS, Verdict.TIPS),
]
SCENES = {"on": on(), "inside": inside()}
CASES = [("on", *case) for case in ON] + [("inside", *case) for case in INSIDE]


@pytest.mark.parametrize(("relation", "pose", "paper", "physics"), CASES)
def test_each_failure_has_its_name(
    relation: str, pose: np.ndarray, paper: Verdict, physics: Verdict
) -> None:
    situation = SCENES[relation]
    assert paper_verdicts(situation, pose[None]) == [paper]
    assert paper_oracle(situation, pose[None]).tolist() == [paper is Verdict.HOLDS]
    with open_drops() as drops:
        assert drop_verdicts(situation, pose[None], drops, ItemOf()) == [physics]


def test_every_failure_occurs_above() -> None:
    for cases in (ON, INSIDE):
        assert {physics for _, _, physics in cases} == {*Verdict}
        assert {paper for _, paper, _ in cases} == {*Verdict} - {Verdict.PENETRATES, Verdict.TIPS}


def test_several_poses_are_judged_one_by_one() -> None:
    for situation, cases in zip(SCENES.values(), (ON, INSIDE), strict=True):
        poses = np.array([pose for pose, _, _ in cases])
        assert paper_verdicts(situation, poses) == [paper for _, paper, _ in cases]
        assert paper_verdicts(situation, poses[:0]) == []
