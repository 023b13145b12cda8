"""Trajectories as text, of a plan made by hand whose every number is known."""

from __future__ import annotations

import csv
import io
import json

import numpy as np
import pytest

from tamp.export.formats import csv_text, json_text, ros_text
from tamp.export.trajectory import BASE_JOINTS, timed_actions
from tamp.plan.read import Value
from tests.export.known import ACTIONS, ARM, DOWN, FINGERS, HOME, PLAN, ROBOT
from tests.plan.making import arm, base, plan_of


def test_json_tells_what_is_grasped_only_where_it_is() -> None:
    document = json.loads(json_text(PLAN, ROBOT, ACTIONS))
    assert document["joints"] == {
        "base": list(BASE_JOINTS),
        "arm": list(ARM),
        "gripper": list(FINGERS),
    }
    segments = [segment for action in document["actions"] for segment in action["segments"]]
    assert [segment.get("attach") for segment in segments] == [None, None, "cup", None, None]
    assert [segment.get("detach") for segment in segments] == [None, None, None, None, "cup"]
    assert [segment["holding"] for segment in segments] == [None, None, None, "cup", None]
    assert segments[0]["velocities"] == [[0.0, 0.0, 0.0], [0.5, 0.0, 0.1], [0.0, 0.0, 0.0]]


def rows() -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(csv_text(PLAN, ROBOT, ACTIONS))))


def test_csv_says_of_every_joint_where_it_is_also_while_it_stands() -> None:
    found = rows()
    assert len(found) == 3 + 2 + 2 + 2 + 2
    assert [row["number"] for row in found] == ["1"] * 3 + ["2"] * 6 + ["3"] * 2
    first, last = found[0], found[-1]
    assert [float(first[name]) for name in ARM] == pytest.approx(HOME)
    assert [float(first[name]) for name in FINGERS] == [0.04, 0.04]
    assert [float(last[name]) for name in BASE_JOINTS] == [1.0, 0.0, 0.2]
    assert [row["holding"] for row in found[7:9]] == ["cup", "cup"]
    turning = found[1]
    assert (float(turning["v_base_x"]), float(turning["v_base_yaw"])) == (0.5, 0.1)
    assert all(float(turning[f"v_{name}"]) == 0.0 for name in (*ARM, *FINGERS))


def test_before_its_first_move_the_base_is_where_the_plan_starts() -> None:
    start = {
        "b": Value("base-conf", np.array([0.5, -1.0, 2.0])),
        "c": Value("base-conf", np.zeros(3)),
    }
    still = plan_of(
        ("pick", ("cup",), [arm([0, 1], [HOME, DOWN])]),
        values=start,
        initial=[("goes-to", "c"), ("at-base", "b")],
    )
    text = csv_text(still, ROBOT, timed_actions(still, ROBOT))
    row = next(csv.DictReader(io.StringIO(text)))
    assert [float(row[name]) for name in BASE_JOINTS] == [0.5, -1.0, 2.0]


def test_ros_times_count_from_each_messages_own_start() -> None:
    found = json.loads(ros_text(PLAN, ROBOT, ACTIONS))["trajectories"]
    assert [one["start"] for one in found] == [0.0, 2.0, 3.0, 3.5, 4.5]
    third = found[2]["message"]["points"][-1]
    assert third["time_from_start"] == {"sec": 0, "nanosec": 500_000_000}
    assert [one["message"]["header"]["frame_id"] for one in found] == ["world", "", "", "", ""]
    assert [one["controller"] for one in found] == ["base", "arm", "gripper", "arm", "gripper"]


def test_numbers_are_written_without_a_negative_zero() -> None:
    tiny = plan_of(("move", (), [base([0, 1], [[-1e-12, 0, 0], [1, 0, 0]])]))
    text = json_text(tiny, ROBOT, timed_actions(tiny, ROBOT))
    assert "-0.0" not in text and "e-" not in text
