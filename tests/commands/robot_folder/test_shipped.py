"""Every robot that comes with tamp plans, is judged sound, and carries its plan out in physics."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import tamp
from tamp.commands.robot_folder.check import against_physics
from tamp.commands.robot_folder.self_collision import home_collision
from tamp.execution.execute import ExecutionOptions, execute
from tamp.geometric.loading.robots import ROBOTS, SHIPPED
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.plan.open import open_plan
from tamp.verification.verify import verify
from tests.needs import INSTALLED


def problem_for(name: str, size: str) -> str:
    robot = ROBOTS[name]()
    if robot.suction is not None and size == "four_objects":
        return "parcels"  # no mug: what is open closes no cup
    if robot.beside and robot.drive != "fixed":
        return "two_arms_cupboard" if size == "four_objects" else size
    if robot.beside:
        return {"one_object": "two_arms_handover", "four_objects": "two_arms_tables"}[size]
    return f"bench_{size}" if robot.drive == "fixed" else size


@pytest.mark.parametrize("name", SHIPPED)
def test_its_frames_are_pybullets_and_home_is_free(name: str) -> None:
    robot = ROBOTS[name]()
    assert robot.name == name
    assert against_physics(robot) < 1e-5
    assert home_collision(robot, robot.home) is None


@pytest.mark.parametrize("name", SHIPPED)
def test_reachable_poses_are_solved(name: str) -> None:
    robot = ROBOTS[name]()
    ik, kinematics, rng = ArmIK(robot), Kinematics(robot), np.random.default_rng(0)
    missed = 0
    for _ in range(300):
        T = kinematics.arm_tool(rng.uniform(robot.lower, robot.upper))
        missed += len(ik.solve(T, enough=1)) == 0
    assert missed <= 3


def test_a_lift_reaches_what_the_arm_alone_does_not() -> None:
    robot = ROBOTS["pr2"]()
    assert robot.prismatic[0] and not any(robot.prismatic[1:])
    kinematics, rng = Kinematics(robot), np.random.default_rng(0)
    raised = rng.uniform(robot.lower, robot.upper, (20_000, len(robot.joints)))
    raised[:, 0] = robot.upper[0]
    highest = max((kinematics.arm_tool(q) for q in raised), key=lambda T: T[2, 3])
    below = replace(robot, upper=(robot.lower[0] + 0.01, *robot.upper[1:]))
    assert len(ArmIK(robot).solve(highest, enough=1)) == 1
    assert len(ArmIK(below).solve(highest, enough=1)) == 0


@pytest.mark.parametrize("name", SHIPPED)
def test_at_home_nothing_is_in_the_floor_however_a_lift_stands(name: str) -> None:
    robot = ROBOTS[name]()
    kinematics, looked = Kinematics(robot), 0
    lifts = [index for index, slides in enumerate(robot.prismatic) if slides]
    for bound in (robot.lower, robot.home, robot.upper):
        arm = np.array(robot.home)
        arm[lifts] = np.array(bound)[lifts]
        poses = kinematics.link_poses(np.concatenate([np.zeros(3), arm]), robot.opening)
        for link in (link for link in robot.links if link.parts):
            low, _ = bounds(link.parts, Pose.from_matrix(poses[link.name]))
            assert low[2] > 0.0, link.name
            looked += 1
    assert looked >= 3 * len(robot.joints)


@pytest.mark.slow
@pytest.mark.parametrize("name", SHIPPED)
@pytest.mark.parametrize("size", ["one_object", "four_objects"])
def test_it_solves_a_problem_that_is_judged_and_carried_out(
    name: str, size: str, tmp_path: Path
) -> None:
    solution = tamp.solve(
        tamp.load_problem(problem_for(name, size), robot=name), max_time=60.0, seed=0
    )
    assert solution.solved
    plan = tmp_path / "plan.json"
    tamp.write_plan(solution, plan)
    report = verify(plan)
    assert report.holds, report.text()
    assert execute(open_plan(plan), ExecutionOptions(grasp="constraint")).reached


@pytest.mark.slow
@pytest.mark.parametrize("engine", INSTALLED)
def test_a_cup_holds_in_either_engine_whatever_fingers_would_do(
    engine: str, tmp_path: Path
) -> None:
    solution = tamp.solve(
        tamp.load_problem("one_object", robot="ur5_suction"), max_time=60.0, seed=0
    )
    assert solution.solved
    tamp.write_plan(solution, tmp_path / "plan.json")
    assert verify(tmp_path / "plan.json", engine=engine).holds
    stored = open_plan(tmp_path / "plan.json")
    assert execute(stored, ExecutionOptions(grasp="friction", engine=engine)).reached
