"""A robot alone: each of its joints goes through its range and comes back, the others stand still."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot, Suction
from tamp.geometric.robot.states import columns, rest_row
from tamp.view.robot_timeline import described, robot_timeline

PANDA = ROBOTS["panda_mobile"]()


@pytest.mark.parametrize("model", ["panda_mobile", "two_pandas", "ur5_suction"])
def test_each_joint_goes_down_and_up_and_back_alone(model: str) -> None:
    robot = ROBOTS[model]()
    timeline, home = robot_timeline(robot, model), rest_row(robot)
    checked = 0
    actions = iter(timeline.actions)
    for arm, where in zip(robot.arms, columns(robot), strict=True):
        for column, joint in enumerate(arm.joints, start=where.start):
            action = next(actions)
            inside = (timeline.times >= action.start) & (timeline.times <= action.end)
            rows, index = timeline.rows[inside], column - where.start
            assert action.name == joint.name
            assert rows[:, column].min() == arm.lower[index]
            assert rows[:, column].max() == arm.upper[index]
            assert rows[0, column] == rows[-1, column] == home[column]
            assert np.argmin(rows[:, column]) < np.argmax(rows[:, column])
            still = np.arange(len(home)) != column
            assert (rows[:, still] == home[still]).all()
            checked += 1
        if arm.fingers:
            action = next(actions)
            opening = timeline.rows[timeline.times > action.start - 1e-9, where.stop - 1]
            assert opening.min() == 0.0 and opening[0] == arm.opening
            assert "fingers" in action.name and f"{1000 * arm.opening:.0f} mm" in action.where
    assert checked == sum(len(arm.joints) for arm in robot.arms) > 5
    assert next(actions, None) is None


def test_one_follows_the_other_and_all_begins_and_ends_at_home() -> None:
    timeline = robot_timeline(PANDA, "panda_mobile")
    starts = [action.start for action in timeline.actions]
    assert starts == [0.0, *(action.end for action in timeline.actions[:-1])]
    assert (np.diff(timeline.times) > 0.0).all()
    assert timeline.times[-1] == timeline.actions[-1].end
    for row in timeline.rows[[0, -1]]:
        assert np.array_equal(row, rest_row(PANDA))


def test_the_ranges_are_told_in_the_joints_units() -> None:
    first, *others = PANDA.joints
    sliding = replace(PANDA, joints=(replace(first, kind="prismatic"), *others))
    slides, turns, *_ = robot_timeline(sliding, "panda_mobile").actions
    assert slides.where == f"{PANDA.lower[0]:.2f} to {PANDA.upper[0]:.2f} m"
    assert turns.where == f"{PANDA.lower[1]:.2f} to {PANDA.upper[1]:.2f} rad"


def test_fingers_are_told_apart_where_there_are_several_hands() -> None:
    def hands(robot: Robot) -> list[str]:
        timeline = robot_timeline(robot, "model")
        return [action.name for action in timeline.actions if "fingers" in action.name]

    assert hands(PANDA) == ["fingers"]
    two = ROBOTS["two_pandas"]()
    assert hands(two) == [f"{arm.arm}'s fingers" for arm in two.arms]
    assert hands(ROBOTS["ur5_suction"]()) == []


def test_a_robot_in_a_line() -> None:
    said = described(PANDA)
    assert said.startswith("panda_mobile · 7 joints · omnidirectional base · ")
    assert said.endswith("the fingers open 80 mm")
    assert f"{sum(len(link.parts) for link in PANDA.links)} convex parts" in said
    cup = described(replace(PANDA, suction=Suction(0.02, 0.1), force=30.0))
    assert cup.endswith("a suction cup 40 mm across, 30 N")
    assert " · 7 + 7 joints · " in described(ROBOTS["two_pandas"]())
