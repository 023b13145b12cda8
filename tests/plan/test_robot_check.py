"""A plan is refused whose robot has changed, or whose rows are not of the robot's joints."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.plan.read import PlanFile, PlanSource, StoredSegment, Value
from tamp.plan.robot_check import check_robot
from tests.plan.making import arm, base, close, plan_of

PANDA = ROBOTS["panda_mobile"]()
TWO = ROBOTS["two_pandas"]()
SEVEN, SIX = [np.zeros(7), np.ones(7)], [np.zeros(6), np.ones(6)]


def moving(*segments: StoredSegment, **values: Value) -> PlanFile:
    return plan_of(("move", ("t1",), segments), values=values)


def of_arm(name: str, segment: StoredSegment) -> StoredSegment:
    return replace(segment, arm=name)


def refused(plan: PlanFile, robot: Robot = PANDA) -> str:
    with pytest.raises(InputError) as caught:
        check_robot(plan, robot)
    return str(caught.value)


def test_rows_of_the_robots_joints_are_taken() -> None:
    own = base([0, 1], [[0, 0, 0], [1, 0, 0]])
    reach = Value("reach", (np.zeros((2, 7)), np.zeros((3, 7))))
    motion = Value("motion", (("base", np.zeros((2, 3)), None), ("arm", np.zeros((2, 7)), None)))
    check_robot(moving(own, arm([0, 1], SEVEN), close("cup"), r1=reach, t1=motion), PANDA)
    check_robot(moving(r1=Value("pose", np.eye(4)), t1=Value("motion", None)), PANDA)


def test_rows_of_another_length_are_named_with_their_place() -> None:
    right = arm([0, 1], SEVEN)
    assert refused(moving(right, arm([0, 1], SIX))) == (
        "actions[0].segments[1].positions: 7 numbers are expected, one for each joint of the "
        "robot panda_mobile, not 6"
    )
    lift = Value("reach", (np.zeros((2, 7)), np.zeros((2, 8))))
    assert "values.r1.lift: 7 numbers are expected" in refused(moving(right, r1=lift))
    approach = Value("reach", (np.zeros((2, 5)), np.zeros((2, 7))))
    assert "values.r1.approach" in refused(moving(right, r1=approach))
    motion = Value("motion", (("arm", np.zeros((2, 6)), None),))
    assert "values.t1: 7 numbers" in refused(moving(right, t1=motion))


def test_an_arm_that_the_robot_does_not_have_is_refused() -> None:
    names = [one.arm for one in TWO.arms]
    check_robot(moving(*(of_arm(name, arm([0, 1], SEVEN)) for name in names)), TWO)
    said = refused(moving(of_arm("middle", close("cup"))), TWO)
    assert "actions[0].segments[0].positions: the robot two_pandas has no arm 'middle'" in said
    assert all(name in said for name in names)
    third = Value("motion", (("gripper", np.zeros((2, 0)), "third"),))
    assert "values.t1: the robot two_pandas has no arm 'third'" in refused(moving(t1=third), TWO)


def test_each_arm_has_its_own_number_of_joints() -> None:
    """Where the plan does not say whose rows they are, any arm's will do."""
    first, second = TWO.arms
    joints = second.joints[:-1]
    robot = replace(first, beside=(replace(second, joints=joints),))
    assert [len(one.joints) for one in robot.arms] == [7, 6]

    check_robot(moving(of_arm(first.arm, arm([0, 1], SEVEN)), arm([0, 1], SIX)), robot)
    check_robot(moving(of_arm(second.arm, arm([0, 1], SIX)), arm([0, 1], SEVEN)), robot)
    wrong = moving(of_arm(second.arm, arm([0, 1], SEVEN)))
    assert "6 numbers are expected" in refused(wrong, robot)
    assert "not 5" in refused(moving(arm([0, 1], [np.zeros(5)] * 2)), robot)


@pytest.fixture
def kept(tmp_path: Path) -> Robot:
    """A robot that is kept in a folder of its own."""
    for name, text in (("robot.yaml", "name: r"), ("geometry.npz", "hulls")):
        (tmp_path / name).write_text(text)
    return replace(PANDA, folder=tmp_path)


def made_from(*sources: tuple[str, str, str]) -> PlanFile:
    """A plan of files: role, path and text."""
    return replace(
        moving(),
        sources=tuple(
            PlanSource(role, Path(path), hashlib.sha256(text.encode()).hexdigest())
            for role, path, text in sources
        ),
    )


def test_a_robots_file_that_has_changed_is_refused(kept: Robot) -> None:
    same = ("robot", "/elsewhere/robot.yaml", "name: r")
    check_robot(made_from(same, ("robot", "geometry.npz", "hulls")), kept)
    said = refused(made_from(same, ("robot", "geometry.npz", "other hulls")), kept)
    assert f"the robot's {kept.folder / 'geometry.npz'} is not the one" in said
    assert "Plan again with tamp-solve" in said


def test_only_the_robots_own_files_are_asked_about(kept: Robot) -> None:
    check_robot(made_from(("robot", "another.npz", "of a newer version")), kept)
    check_robot(made_from(("mesh", "geometry.npz", "of a cup")), kept)


def test_of_files_of_one_name_any_may_be_it(kept: Robot) -> None:
    """A body's two arms may be of two folders, each with a robot.yaml."""
    both = [("robot", "left/robot.yaml", "name: l"), ("robot", "right/robot.yaml", "name: r")]
    check_robot(made_from(*both), kept)
    check_robot(made_from(*reversed(both)), kept)
    assert "robot.yaml is not the one" in refused(made_from(both[0]), kept)
