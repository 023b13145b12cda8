"""The tools that a problem's streams share, made once; and for a body with its load, for an arm, for a step's scene."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp import load_problem
from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.states import arm_of
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Part, RobotStart
from tamp.geometric.values import Grasp, Stance
from tests.geometric.making import body, scene, table


def test_what_is_held_is_absent() -> None:
    context = load_problem("four_objects").context
    poses = {
        name: context.scene.bodies[name].pose
        for name in context.scene.movable
        if name not in ("mug", "bowl")
    }
    poses["mustard"] = Pose((0.0, 0.0, 1.0))
    scene = context.scene_at(poses, proposed="mug")
    assert "bowl" not in scene.bodies and "table" in scene.bodies
    assert scene.bodies["mug"].pose == context.scene.bodies["mug"].pose
    assert scene.bodies["mustard"].pose.position[2] == 1.0


TRAY, CUP = Box((0.3, 0.2, 0.02)), Box((0.06, 0.06, 0.1))


def made(*bodies: Body, robot: str = "panda_mobile", **more: object) -> Context:
    return Context(scene(*bodies), ROBOTS[robot](), {}, **more)  # type: ignore[arg-type]


def test_a_robot_that_does_not_drive_stands_where_it_is(rng: np.random.Generator) -> None:
    target = Pose((0.5, -1.5, 0.8), (1.0, 0.0, 0.0, 0.0)).matrix
    fixed = made(robot="panda_fixed")
    assert fixed.stands(target, rng, 16).tolist() == [[0.0, -2.0, 0.0]]
    drives = made().stands(target, rng, 16)
    assert len(drives) > 1 and np.hypot(*(drives[:, :2] - (0.5, -1.5)).T).max() < 1.5


def test_only_an_arm_of_too_few_joints_has_its_base_fitted(rng: np.random.Generator) -> None:
    """Five joints do not place a hand by themselves."""
    assert made().base_fit is made(robot="ur5").base_fit is None
    ur5 = ROBOTS["ur5"]()
    count = len(ur5.joints) - 1
    short = replace(
        ur5, joints=ur5.joints[:count], lower=ur5.lower[:count], upper=ur5.upper[:count],
        home=ur5.home[:count],
    )  # fmt: skip
    assert Context(scene(), short, {}).base_fit is not None


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_ball_around_a_bodys_frame_reaches_its_farthest_corner(axis: int, side: float) -> None:
    """Of a cube of 0.2 m that is 0.3 m aside: 0.4 m away along that axis, 0.1 m along the others."""
    x, y, z = (0.3 * side * np.eye(3)[axis]).tolist()
    part = Part(Box((0.2, 0.2, 0.2)), Pose((x, y, z)))
    context = made(Body("thing", (part,), Pose(), movable=True))
    assert context.radius("thing") == pytest.approx(np.sqrt(0.4**2 + 2 * 0.1**2))


def test_a_box_around_a_placed_body() -> None:
    part = Part(Box((0.2, 0.2, 0.2)), Pose((0.3, 0.0, 0.0)))
    context = made(Body("thing", (part,), Pose(), movable=True))
    quarter = Pose.from_xyz_yaw(1.0, 2.0, 3.0, np.pi / 2)
    low, high = context.box("thing", quarter)
    assert low == pytest.approx([0.9, 2.2, 2.9]) and high == pytest.approx([1.1, 2.4, 3.1])
    assert context.box("thing", quarter)[0] is low  # worked out once


def test_fixed_parts_are_those_of_fixed_bodies_alone() -> None:
    two = Body(
        "two", (Part(Box((1, 1, 1))), Part(Box((1, 1, 1)), Pose((0.0, 0.0, 1.0)))), Pose((5, 0, 0)),
        movable=False,
    )  # fmt: skip
    parts, lows, highs = made(body("cup", CUP, (0, 0, 1)), two, table()).fixed_parts
    assert [name for name, _, _ in parts] == ["two", "two", "table"]
    assert lows[:2] == pytest.approx(np.array([(4.5, -0.5, -0.5), (4.5, -0.5, 0.5)]))
    assert highs[2] == pytest.approx([0.5, 0.3, 0.5])
    nothing, lows, highs = made(body("cup", CUP, (0, 0, 1))).fixed_parts
    assert nothing == [] and lows.shape == highs.shape == (0, 3)


def test_home_is_where_the_problem_has_the_arm() -> None:
    context = made()
    assert context.home.tolist() == list(context.robot.home)
    assert context.carrying_up == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)  # the hand looks down
    arm = (0.0, 0.3, 0.0, -1.5, 0.0, 1.8 + 0.5, 0.785)
    start = replace(context.scene, robot=RobotStart("panda_mobile", (0.0, 0.0, 0.0), arm))
    other = Context(start, context.robot, {})
    assert other.home.tolist() == list(arm)
    assert other.carrying_up[2] == pytest.approx(-np.cos(0.5), abs=1e-3)
    assert other.conf((1.0, 2.0, 3.0), other.home).tolist() == [1.0, 2.0, 3.0, *arm]


def test_the_robot_among_the_fixed_bodies_holds_what_it_is_said_to_hold() -> None:
    """A cup in the hand meets the shelf below it, a movable box there is not looked at."""
    alone = made()
    conf = alone.conf((0.0, 0.0, 0.0), alone.home)
    x, y, z = (float(value) for value in alone.kinematics.tool(conf)[:3, 3])
    shelf = body("shelf", Box((0.1, 0.1, 0.02)), (x, y, z - 0.06), movable=False)
    inside = body("box", CUP, (x, y, z))
    context = made(shelf, inside, body("cup", CUP, (5, 5, 1)))
    grasp = Grasp("cup", Pose((0.0, 0.0, 0.02)), 0.061)
    assert context.fixed_only(None).free(conf)
    assert context.fixed_only(grasp).hits(conf) == ("cup", "shelf")
    assert context.fixed_only(grasp) is context.fixed_only(replace(grasp))
    assert context.attachment(grasp).opening == 0.061


def test_a_body_with_its_load_is_one() -> None:
    """The tray's frame is turned by a quarter: the cup, 0.1 m along its x, is 0.1 m along y of the world."""
    at = Pose.from_xyz_yaw(1.0, 0.0, 0.5, np.pi / 2)
    tray = replace(body("tray", TRAY, (0, 0, 0)), pose=at)
    context = made(
        tray, body("cup", CUP, (3, 0, 1)), table(), steering="reeds-shepp", planner="ompl"
    )
    on_it = Pose((0.1, 0.0, 0.06))
    whole = context.loaded("tray", (("cup", on_it),))
    assert set(whole.scene.bodies) == {"tray", "table"}
    first, second = whole.scene.bodies["tray"].parts
    assert (first.shape, second.shape) == (TRAY, CUP)
    assert second.pose.position == pytest.approx((0.1, 0.0, 0.06))
    assert whole.box("tray", at)[1] == pytest.approx([1.1, 0.15, 0.61])
    assert (whole.steering, whole.planner, whole.robot) == ("reeds-shepp", "ompl", context.robot)
    assert context.loaded("tray", (("cup", on_it),)) is whole
    assert context.loaded("tray", ()) is context
    assert set(context.scene.bodies) == {"tray", "cup", "table"}


@pytest.fixture(scope="module")
def two() -> Context:
    return made(body("cup", CUP, (0, 0, 1)), robot="two_pandas")


def test_one_arm_moves_and_the_others_stand_as_they_are_said_to(two: Context) -> None:
    left, right = two.robot.arms
    own = two.of_arm("left")
    assert (own.robot.arm, own.scene, own.footings) == ("left", two.scene, two.footings)
    assert own.footings is two.footings
    assert own.robot.still_links.keys() == left.still_links.keys()
    joints = tuple(0.1 + q for q in right.home)
    grasp = Grasp("cup", Pose((0.0, 0.0, 0.05)), 0.06)
    other = two.of_arm("left", {"right": Stance(joints, grasp)})
    T_tool = Kinematics(arm_of(two.robot, "right")).tool(np.array([0.0, 0.0, 0.0, *joints]))
    held = other.robot.still_links["cup"].matrix
    assert held == pytest.approx(T_tool @ grasp.T_tool_body.matrix, abs=1e-9)
    assert other.robot.links[-1].name == "cup" and "cup" not in own.robot.still_links
    with pytest.raises(KeyError):
        two.of_arm("left", {"middle": Stance()})


def test_where_nothing_is_said_of_an_arm_it_is_at_home_and_open(two: Context) -> None:
    plain, said = two.of_arm("left"), two.of_arm("left", {"right": Stance()})
    assert plain.robot.still_links == said.robot.still_links
    home = two.of_arm("left", {"right": Stance(two.robot.arms[1].home)})
    assert home.robot.still_links == plain.robot.still_links
    holding = two.of_arm("left", {"right": Stance(None, Grasp("cup", Pose(), 0.02))})
    fingers = [finger.child for finger in two.robot.arms[1].fingers]
    assert all(holding.robot.still_links[name] != plain.robot.still_links[name] for name in fingers)


def test_an_arm_is_made_once_and_its_kinematics_serve_however_others_stand(two: Context) -> None:
    stance = {"right": Stance(None, Grasp("cup", Pose(), 0.03))}
    assert two.of_arm("left") is two.of_arm("left") is not two.of_arm("right")
    again = two.of_arm("left", {"right": Stance(None, Grasp("cup", Pose(), 0.03))})
    assert two.of_arm("left", stance) is again
    assert again.ik is two.of_arm("left").ik


def test_without_any_poses_everything_is_at_its_start() -> None:
    context = made(table(), body("cup", CUP, (0, 0, 0.6)), body("box", CUP, (0.3, 0, 0.6)))
    scene_now = context.scene_at({})
    assert scene_now.bodies == context.scene.bodies
    assert scene_now.bodies is not context.scene.bodies  # which a generator may spoil


def test_a_body_that_a_pose_is_proposed_for_stays_at_its_start() -> None:
    context = made(table(), body("cup", CUP, (0, 0, 0.6)), body("box", CUP, (0.3, 0, 0.6)))
    away = Pose((0.2, 0.2, 0.6))
    known = context.scene_at({"cup": away})
    assert known.bodies.keys() == {"table", "cup"} and known.bodies["cup"].pose == away
    proposed = context.scene_at({"cup": away}, proposed="cup")
    assert proposed.bodies["cup"].pose == context.scene.bodies["cup"].pose


def test_what_the_hand_holds_at_the_start_touches_nothing() -> None:
    cup, box = body("cup", CUP, (0, 0, 0.6)), body("box", CUP, (0.06, 0, 0.6))
    assert made(cup, box).touching.touched("cup", cup.pose).keys() == {"box"}
    held = made(cup, box, holding=Grasp("box", Pose(), 0.06))
    assert not held.touching.touched("cup", cup.pose)
