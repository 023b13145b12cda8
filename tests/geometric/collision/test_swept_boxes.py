"""Swept boxes leave nothing out: whatever the robot touches on its way lies in one of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tamp.geometric.collision.collisions import Attachment
from tamp.geometric.collision.swept_boxes import (
    SweptBoxes,
    part_boxes,
    swept_balls,
    swept_by_robot,
)
from tamp.geometric.collision.tables import FRAME
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tests.geometric.streams.scenes import problem_with


def test_boxes_meet_within_the_padding_on_all_axes() -> None:
    boxes = SweptBoxes(
        np.array([[0.0, 0.0, 0.0], [5.0, 5.0, 5.0]]), np.array([[1.0, 1.0, 1.0], [6.0, 6.0, 6.0]])
    )
    assert boxes.meet(np.full(3, 0.5), np.full(3, 0.6), 0.0)
    assert boxes.meet(np.full(3, 1.01), np.full(3, 2.0), 0.02)
    assert not boxes.meet(np.full(3, 1.01), np.full(3, 2.0), 0.005)
    assert not boxes.meet(np.array([0.5, 0.5, 2.0]), np.array([0.6, 0.6, 3.0]), 0.1)
    assert not boxes.meet(np.array([0.5, 5.5, 0.5]), np.array([0.6, 5.6, 0.6]), 0.1)
    assert boxes.meet(np.full(3, -1.0), np.full(3, 9.0), 0.0)


def test_balls_sweep_boxes_around_all_their_places() -> None:
    turned = Pose.from_xyz_yaw(1.0, 0.0, 0.0, np.pi / 2).matrix
    swept = swept_balls(np.array([np.eye(4), turned]), np.array([[1.0, 0.0, 0.0]]), np.array([0.1]))
    np.testing.assert_allclose(swept.low, [[0.9, -0.1, -0.1]])
    np.testing.assert_allclose(swept.high, [[1.1, 1.1, 0.1]])


def test_boxes_of_parts_are_where_kinematics_says_that_links_are(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    context = problem_with("can", tmp_path).context
    tables = context.collisions.arrangement({}, None, fixed=False).tables
    confs = rng.uniform(-2.0, 2.0, (20, 10))
    low, high = part_boxes(tables.joints, tables.parts, tables.part_poses, confs)
    order = np.argsort(tables.parts[:, FRAME], kind="stable")

    for conf, least, most in zip(confs, low, high, strict=True):
        links = context.kinematics.link_poses(conf, context.robot.opening)
        exact = [
            bounds((part,), Pose.from_matrix(links[link.name]))
            for link in context.robot.links
            for part in link.parts
        ]
        below = np.array([one[0] for one in exact])[order] - least.T
        above = most.T - np.array([one[1] for one in exact])[order]
        assert (below > -1e-9).all() and (above > -1e-9).all()
        assert np.median(np.concatenate([below, above])) < 0.05  # tight, too


def test_a_body_that_the_robot_hits_on_its_way_is_in_a_box(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    """Between configurations, too: the edges are long ones."""
    context = problem_with("can", tmp_path).context
    collisions, body = context.collisions, "can"
    alone = collisions.arrangement({}, None, fixed=False)
    hits = clear = 0
    for _ in range(600):
        path = np.zeros((3, 10))
        path[:, :3] = rng.uniform(-0.2, 0.2, 3)
        path[:, 3:] = context.home + np.cumsum(rng.uniform(-0.2, 0.2, (3, 7)), axis=0)
        pose = Pose((*rng.uniform(-0.7, 0.7, 2), float(rng.uniform(0.1, 1.2))))
        among = collisions.arrangement({body: pose}, None, fixed=False)
        near = swept_by_robot([alone], [path]).meet(*context.box(body, pose), 0.0)
        hit = among.path_hits(path)
        if hit is not None and body in hit:
            hits += 1
            assert near
        clear += not near
    assert hits >= 20 and clear >= 60, (hits, clear)


def test_a_held_body_is_in_the_boxes(tmp_path: Path) -> None:
    context = problem_with("can", tmp_path).context
    attachment = Attachment("can", Pose((0.0, 0.0, 0.05)), 0.066)
    loaded = context.collisions.arrangement({}, attachment, fixed=False)
    conf = context.conf(np.zeros(3), context.home)
    at = Pose.from_matrix(context.kinematics.tool(conf) @ attachment.T_tool_body.matrix)
    low, high = bounds(context.scene.bodies["can"].parts, at)
    boxes = swept_by_robot([loaded], [conf[None]])
    assert ((boxes.low <= low + 1e-6) & (boxes.high >= high - 1e-6)).all(axis=1).any()
