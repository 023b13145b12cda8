"""States of a robot as rows: whose numbers they are, at rest, at the start, and with one arm moved."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import arm_of, columns, rest_row, start_row, with_arm
from tamp.geometric.scene.scene import RobotStart

TWO = ROBOTS["two_pandas"]()


def test_an_arm_is_found_by_its_name_and_the_first_without_one() -> None:
    assert [arm_of(TWO, name).arm for name in (None, "left", "right")] == ["left", "left", "right"]
    with pytest.raises(KeyError):
        arm_of(TWO, "middle")


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("two_pandas", (slice(3, 11), slice(11, 19))),  # 7 joints and the fingers each
        ("ur5", (slice(3, 10),)),
        ("pr2", (slice(3, 12),)),  # 7 joints on a lift
    ],
)
def test_each_arm_has_its_joints_and_fingers_after_the_base(
    name: str, wanted: tuple[slice, ...]
) -> None:
    robot = ROBOTS[name]()
    assert columns(robot) == wanted
    assert len(rest_row(robot)) == wanted[-1].stop


def hand(robot: Robot) -> list[float]:
    return [*robot.home, robot.opening]


def test_at_rest_all_arms_are_at_home_with_open_fingers() -> None:
    left, right = TWO.arms
    assert rest_row(TWO).tolist() == [0.0, 0.0, 0.0, *hand(left), *hand(right)]
    assert rest_row(TWO, (1.0, -2.0, 0.5)).tolist()[:4] == [1.0, -2.0, 0.5, left.home[0]]


def test_a_problem_says_where_base_and_first_arm_begin() -> None:
    left, right = TWO.arms
    row = start_row(TWO, RobotStart("two_pandas", (1.0, 2.0, 3.0)))
    assert np.array_equal(row, rest_row(TWO, (1.0, 2.0, 3.0)))
    arm = tuple(0.1 * k for k in range(7))
    row = start_row(TWO, RobotStart("two_pandas", (1.0, 2.0, 3.0), arm))
    assert row.tolist() == [1.0, 2.0, 3.0, *arm, left.opening, *hand(right)]


def test_one_arm_is_moved_and_the_row_that_was_is_left_alone() -> None:
    rest = rest_row(TWO)
    joints = [float(k) for k in range(7)]
    moved = with_arm(TWO, rest, 1, joints, None)
    assert moved[columns(TWO)[1]].tolist() == [*joints, TWO.arms[1].opening]
    closed = with_arm(TWO, moved, 0, None, 0.01)
    assert closed[10] == 0.01 and np.flatnonzero(closed != moved).tolist() == [10]
    assert np.array_equal(with_arm(TWO, rest, 0, None, None), rest)
    assert np.array_equal(rest, rest_row(TWO))
