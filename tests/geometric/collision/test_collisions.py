"""Bodies against each other, exactly, and what an arrangement has in it: what is held, the fingers at their opening."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import fcl
import numpy as np

from benchmarks.collision_reference import random_pose, random_scene
from tamp.geometric.collision.collisions import Attachment, Collisions
from tamp.geometric.collision.fcl_bodies import FclBody
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Box, Cylinder, Sphere
from tests.geometric.collision.confs import at
from tests.geometric.making import body, scene


def test_the_attached_body_counts_and_leaves_its_place(
    robot: Robot, kinematics: Kinematics
) -> None:
    conf = at(robot)
    T_world_tool = Pose.from_matrix(kinematics.tool(conf))
    cup = replace(body("cup", Cylinder(0.02, 0.1), (0, 0, 0)), pose=T_world_tool)
    post = replace(
        body("post", Box((0.03, 0.03, 0.03)), (0, 0, 0)), pose=T_world_tool @ Pose((0.0, 0.0, 0.07))
    )
    collisions = Collisions(scene(cup, post), robot, kinematics)
    poses = {"cup": cup.pose, "post": post.pose}
    grasp = Attachment("cup", Pose(), 0.04)
    assert collisions.arrangement({}).free(conf)
    assert collisions.arrangement({"post": post.pose}).hits(conf) is None
    assert collisions.arrangement(poses, grasp).hits(conf) is None
    raised = Attachment("cup", Pose((0.0, 0.0, 0.03)), 0.04)
    assert collisions.arrangement(poses, raised).hits(conf) == ("cup", "post")
    assert not collisions.arrangement(poses, raised).free(conf)
    assert (
        collisions.arrangement({}, Attachment("cup", Pose((0.0, 0.0, -0.25)), 0.04)).hits(conf)
        is not None
    )  # link6


def test_fingers_stand_at_half_the_opening(robot: Robot, kinematics: Kinematics) -> None:
    conf = at(robot)
    pea = replace(
        body("pea", Sphere(0.005), (0, 0, 0)), pose=Pose.from_matrix(kinematics.tool(conf))
    )
    collisions = Collisions(scene(pea), robot, kinematics)
    assert collisions.arrangement({"pea": pea.pose}, opening=0.04).free(conf)
    hit = collisions.arrangement({"pea": pea.pose}, opening=0.0).hits(conf)
    assert hit is not None and hit[0].endswith("finger") and hit[1] == "pea"


def test_bodies_resting_on_each_other_do_not_collide(robot: Robot, kinematics: Kinematics) -> None:
    board = body("board", Box((1.0, 1.0, 0.04)), (0, 0, 0.5), movable=False)
    collisions = Collisions(
        scene(
            board,
            body("a", Box((0.1, 0.1, 0.1)), (0, 0, 1)),
            body("b", Cylinder(0.05, 0.2), (0, 0, 2)),
        ),
        robot,
        kinematics,
    )
    resting = Pose((0.0, 0.0, 0.52 + 0.05 + CONTACT_GAP))
    assert collisions.between("a", resting, {}) is None
    assert collisions.between("a", Pose((0.0, 0.0, 0.52 + 0.05 - CONTACT_GAP)), {}) == "board"
    beside = Pose((0.101, 0.0, 0.52 + 0.1 + CONTACT_GAP))
    assert not collisions.pair("a", resting, "b", beside)
    overlapping = Pose((0.099, 0.0, 0.52 + 0.1 + CONTACT_GAP))
    assert collisions.pair("a", resting, "b", overlapping)
    assert collisions.between("a", resting, {"a": resting, "b": overlapping}) == "b"


def test_pairs_agree_with_fcl(robot: Robot, kinematics: Kinematics) -> None:
    rng = np.random.default_rng(7)
    scene = random_scene(rng, 8)
    collisions = Collisions(scene, robot, kinematics)
    names = [name for name in scene.movable if name != "held"]
    found = Counter()
    for _ in range(300):
        a, b = rng.choice(names, 2, replace=False)
        T_a, T_b = (random_pose(rng, np.full(3, -0.15), np.full(3, 0.15)) for _ in range(2))
        objects = [
            [FclBody((part,)).place(0, T.matrix) for part in scene.bodies[name].parts]
            for name, T in ((a, T_a), (b, T_b))
        ]
        expected = any(fcl.collide(p, q) for p in objects[0] for q in objects[1])
        assert collisions.pair(a, T_a, b, T_b) is expected
        found[expected] += 1
    assert found[True] > 30 and found[False] > 30
