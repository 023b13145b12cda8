"""Where the timeline has things is where the plan has them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp import load_problem, solve
from tamp.geometric.robot.kinematics import ArmsKinematics
from tamp.plan.open import PlanBundle, open_plan
from tamp.plan.write import write_plan
from tamp.simulation.engines import open_world
from tamp.view.timeline import PoseInterval, Timeline, holding, timeline_of, tool_path


def test_actions_and_objects_are_the_plans(timeline: Timeline, stored: PlanBundle) -> None:
    assert [action.name for action in timeline.actions] == ["move", "pick", "move", "place"]
    assert timeline.actions[1].objects == ("soup_can",)
    assert (
        timeline.actions[-1].end
        == pytest.approx(timeline.duration)
        == pytest.approx(stored.plan.duration)
    )
    assert [action.text for action in timeline.actions[:2]] == ["move", "pick soup_can from table"]
    assert timeline.actions[3].text == "place soup_can on cupboard_top"
    starts = [action.start for action in timeline.actions]
    assert starts[0] == 0.0 and starts == sorted(starts)


def test_the_robot_moves_without_jumps_and_stands_before_and_after(timeline: Timeline) -> None:
    assert timeline.row(-1.0) == pytest.approx(timeline.rows[0])
    assert timeline.row(timeline.duration + 1.0) == pytest.approx(timeline.rows[-1])
    times = np.arange(0.0, timeline.duration, 0.02)
    rows = np.array([timeline.row(time) for time in times])
    assert np.abs(np.diff(rows, axis=0)).max() < 0.02 * 2.7  # rad/s, the fastest joint


def test_a_body_stays_in_the_hand_and_ends_where_the_plan_puts_it(
    timeline: Timeline, stored: PlanBundle
) -> None:
    kinematics = ArmsKinematics(timeline.robot)
    kept, held, left = timeline.stays["soup_can"]
    assert (kept.held, held.held, left.held) == (False, True, False)
    for time in np.linspace(held.since, left.since - 1e-6, 7):
        T_tool_world = np.linalg.inv(kinematics.tool(timeline.row(time)))
        assert T_tool_world @ timeline.poses(time, kinematics)["soup_can"] == pytest.approx(held.T)
    for time in (held.since, left.since):  # nothing jumps when it is grasped or let go
        before, after = (
            timeline.poses(time + step, kinematics)["soup_can"] for step in (-1e-6, 1e-6)
        )
        assert before == pytest.approx(after, abs=1e-4)
    goal = next(action.arguments[1] for action in stored.plan.actions if action.name == "place")
    assert timeline.poses(timeline.duration, kinematics)["soup_can"] == pytest.approx(
        stored.plan.values[goal].data, abs=1e-4
    )


def test_links_stand_where_another_engine_has_them(timeline: Timeline) -> None:
    kinematics = ArmsKinematics(timeline.robot)
    with open_world(timeline.scene, timeline.robot) as world:
        for time in np.linspace(0.0, timeline.duration, 9):
            row = timeline.row(time)
            world.set_robot(row[:3], row[3:10], float(row[10]))
            ours = kinematics.link_poses(row)
            for name, pose in world.link_poses().items():
                assert ours[name] == pytest.approx(pose, abs=1e-5), name


def test_the_hand_is_full_between_pick_and_place(timeline: Timeline) -> None:
    full = holding(timeline)
    assert len(full) == len(timeline.times) - 1
    middle = [
        full[int(np.searchsorted(timeline.times, action.end - 0.3)) - 1]
        for action in timeline.actions
    ]
    assert middle == [False, True, True, False]
    assert tool_path(timeline, ArmsKinematics(timeline.robot)).shape == (len(timeline.times), 3)


def test_a_scene_alone_stands_still(timeline: Timeline) -> None:
    still = timeline_of(timeline.scene, timeline.robot)
    assert still.duration == 0.0 and still.actions == ()
    assert holding(still) == []
    for name in timeline.scene.movable:
        (stay,) = still.stays[name]
        assert isinstance(stay, PoseInterval)
        assert timeline.scene.bodies[name].pose.matrix == pytest.approx(stay.T)


def test_names_keep_the_scenes_case(tmp_path: Path) -> None:
    text = Path(load_problem("one_object").files["problem"][0]).read_text(encoding="utf-8")
    problem = tmp_path / "Mine.yaml"
    problem.write_text(text.replace("soup_can", "Soup_Can"), encoding="utf-8")
    plan = write_plan(solve(load_problem(problem), max_time=60.0), tmp_path / "plan.json")
    opened = open_plan(plan)
    timeline = timeline_of(opened.loaded.scene, opened.robot, opened.plan)
    assert timeline.actions[1].objects == ("Soup_Can",)
    assert len(timeline.stays["Soup_Can"]) == 3
