"""The hand and the wrist behind it against bodies, placed by the tool alone: what they hit the whole robot hits."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np

from tamp.geometric.collision.collisions import Attachment
from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.collision.hand_collisions import HandCollisions
from tamp.geometric.scene.pose import Pose
from tests.geometric.streams.scenes import problem_with


def test_the_hand_and_wrist_hit_only_what_the_robot_hits(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    """HandCollisions places hand and wrist by the tool alone; the whole robot at that pose must agree."""
    context = problem_with("can", tmp_path).context
    hand: HandCollisions = context.hand
    lower, upper = np.array(context.robot.lower), np.array(context.robot.upper)
    fixed = [(name, context.scene.bodies[name].pose) for name in context.scene.fixed]
    hits = 0
    for _ in range(1500):
        x, y = (-1.0, 0.3) if rng.random() < 0.5 else (1.0, 0.0)
        base = np.array(
            [x + rng.uniform(-0.3, 0.3), y + rng.uniform(-0.4, 0.4), rng.uniform(-3, 3)]
        )
        conf = context.conf(base, rng.uniform(lower, upper))
        said = hand.hits([context.kinematics.tool(conf)], context.robot.opening, None, fixed)
        if said is not None:
            hits += 1
            assert context.fixed_only(None).hits(conf) is not None
    assert hits > 20


def test_the_hand_hits_all_that_its_parts_hit(tmp_path: Path, rng: np.random.Generator) -> None:
    """The balls around the parts leave nothing out: asking FCL about every pair says the same."""
    context = problem_with("mug", tmp_path).context
    scene, robot = context.scene, context.robot
    links = [FclBody(link.parts) for link in robot.links[-3:]]
    held = FclBody(scene.bodies["mug"].parts)
    fixed = {name: FclBody(scene.bodies[name].parts) for name in scene.fixed}
    standing = [(name, scene.bodies[name].pose) for name in scene.fixed]
    lower, upper = np.array(robot.lower), np.array(robot.upper)
    hits = clear = 0
    for _ in range(600):
        base = np.array([1.0 + rng.uniform(-0.3, 0.3), rng.uniform(-0.4, 0.4), rng.uniform(-1, 1)])
        conf = context.conf(base, rng.uniform(lower, upper))
        opening = float(rng.uniform(0.0, robot.opening))
        attachment = Attachment("mug", Pose((0.0, 0.0, float(rng.uniform(0.0, 0.1)))), opening)
        tool = context.kinematics.tool(conf)
        poses = list(context.kinematics.link_poses(conf, opening).values())[-3:]
        moving = [*zip(links, poses, strict=True), (held, tool @ attachment.T_tool_body.matrix)]
        touched = {
            name
            for name, other in fixed.items()
            for mover, matrix in moving
            for k, part in itertools.product(range(len(mover.objects)), range(len(other.objects)))
            if touch(mover.place(k, matrix), other.place(part, scene.bodies[name].pose.matrix), 0.0)
        }
        said = context.hand.hits([tool], opening, attachment, standing)
        if touched:
            hits += 1
            assert said is not None
        clear += said is None
    assert hits > 20 and clear > 20


def test_the_first_body_in_the_way_is_named_and_nothing_without_bodies(tmp_path: Path) -> None:
    context = problem_with("can", tmp_path).context
    table, lamp = context.scene.bodies["table"].pose, Pose((0.0, 0.0, 1.9))
    inside_both = [lamp.matrix, table.matrix]
    for order in itertools.permutations((("table", table), ("lamp", lamp))):
        said = context.hand.hits(inside_both, context.robot.opening, None, order)
        assert said == "lamp"  # at the first of the tool's poses
    assert context.hand.hits(inside_both, context.robot.opening, None, []) is None
    far = Pose((0.0, 1.0, 1.5)).matrix
    assert context.hand.hits([far], context.robot.opening, None, [("table", table)]) is None
    assert context.hand.hits([far, lamp.matrix], 0.0, None, [("lamp", lamp)]) == "lamp"


def test_two_hands_meet_where_their_parts_do(tmp_path: Path, rng: np.random.Generator) -> None:
    """Beside FCL on the two hands' links; the wrists behind them may meet as well."""
    context = problem_with("can", tmp_path).context
    robot, hand = context.robot, context.hand
    other = HandCollisions(context.scene, robot)
    moving, standing = ([FclBody(link.parts) for link in robot.links[-3:]] for _ in range(2))
    T_tool_hand = robot.T_hand_tool.inverse().matrix

    def links(opening: float, T: np.ndarray) -> list[np.ndarray]:
        places = [T @ T_tool_hand]
        for finger in robot.fingers:
            slid = finger.origin.matrix.copy()
            slid[:3, 3] += slid[:3, :3] @ np.array(finger.axis) * opening / 2
            places.append(T @ T_tool_hand @ slid)
        return places

    met = apart = 0
    for _ in range(150):
        T = Pose.from_xyz_rpy(tuple(rng.uniform(-0.2, 0.2, 3)), tuple(rng.uniform(-3, 3, 3))).matrix
        openings = rng.uniform(0.0, robot.opening, 2).tolist()
        said = hand.meets(openings[0], np.eye(4), other, openings[1], T)
        touched = any(
            touch(a.place(0, first), b.place(0, second), 0.0)
            for a, first in zip(moving, links(openings[0], np.eye(4)), strict=True)
            for b, second in zip(standing, links(openings[1], T), strict=True)
        )
        assert said or not touched
        met += touched
        apart += not said
    assert met > 20 and apart > 20
    assert not hand.meets(0.08, np.eye(4), other, 0.08, Pose((1.0, 0.0, 0.0)).matrix)


def test_what_the_hand_hits_is_in_the_boxes_that_it_sweeps(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    context = problem_with("mug", tmp_path).context
    attachment = Attachment("mug", Pose((0.0, 0.0, 0.05)), 0.04)
    hits = clear = 0
    for _ in range(300):
        start = Pose.from_xyz_rpy((0.0, 0.0, 1.0), tuple(rng.uniform(-3, 3, 3))).matrix
        tools = np.array([start, Pose(tuple(rng.uniform(-0.1, 0.1, 3))).matrix @ start])
        there = Pose((*rng.uniform(-0.5, 0.5, 2), float(rng.uniform(0.4, 1.6))))
        swept = context.hand.swept(tools, (0.02, context.robot.opening), attachment)
        near = swept.meet(*context.box("lamp", there), 0.0)
        hit = context.hand.hits(
            list(tools), context.robot.opening, attachment, [("lamp", there)]
        ) or context.hand.hits(list(tools), 0.02, None, [("lamp", there)])
        assert near or hit is None
        hits, clear = hits + (hit is not None), clear + (not near)
    assert hits > 20 and clear > 60
