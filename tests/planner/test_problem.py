"""Loading a problem: what is refused before anything is planned, and what is kept of its files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.values import Grasp
from tamp.planner.problem import Problem, _own_robot, load_problem

TEXT = """\
name: tea
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.6], at: [1.2, 0.0, 0.0]}
  cup:   {box: [0.06, 0.06, 0.1], on: table}
goal: (on
   cup   table)
"""


def load(folder: Path, text: str = TEXT, **options: Any) -> Problem:
    file = folder / "tea.yaml"
    file.write_text(text, encoding="utf-8")
    return load_problem(file, **options)


@pytest.fixture(scope="module")
def tea(tmp_path_factory: pytest.TempPathFactory) -> Problem:
    return load(tmp_path_factory.mktemp("tea"))


def test_a_problem_has_its_goal_in_one_line_and_its_files_by_role(tea: Problem) -> None:
    assert (
        tea.name == "tea" and " ".join(tea.goal.split()) == tea.goal and tea.goal.startswith("(on")
    )
    assert tea.files["problem"][0].name == "tea.yaml" and tea.files["robot"] == ()
    assert not tea.robot_given and tea.warnings == ()
    assert tea.samplers == {"on": "surface", "inside": "surface"}
    assert {stream.name for stream in tea.stream_task.streams} >= {"sample-on", "plan-pick"}
    assert tea.stream_task.values["cup"] == "cup"


def test_the_base_drives_as_its_robot_unless_told_otherwise(tea: Problem, tmp_path: Path) -> None:
    assert tea.context.steering == "se2"
    assert load(tmp_path, steering="differential").context.steering == "differential"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"steering": "sideways"}, r"unknown steering 'sideways'.*se2"),
        ({"planner": "prm"}, r"unknown planner 'prm'.*compiled"),
    ],
)
def test_unknown_ways_are_refused_before_files_are_read(options: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        load_problem("nowhere.yaml", **options)


def test_a_base_with_wheels_that_do_not_slide_drives_as_it_can(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wheels = replace(ROBOTS["panda_mobile"](), drive="differential")
    monkeypatch.setattr("tamp.planner.problem.load_robot", lambda model: wheels)
    assert load(tmp_path).context.steering == "differential"
    with pytest.raises(InputError, match="cannot move by 'se2': its drive is differential"):
        load(tmp_path, steering="se2")


def test_a_robot_that_starts_in_a_table_is_told_to_move(tmp_path: Path) -> None:
    inside = TEXT.replace("base: [0.0, 0.0, 0.0]", "base: [1.2, 0.0, 0.0]")
    with pytest.raises(InputError, match=r"the robot starts in collision: .*table") as told:
        load(tmp_path, inside)
    assert told.value.line == 3 and "Move its base, or what stands there" in str(told.value)


def test_an_arm_that_starts_in_itself_needs_another_one(tmp_path: Path) -> None:
    folded = TEXT.replace(
        "base: [0.0, 0.0, 0.0]}",
        "base: [0.0, 0.0, 0.0], arm: [0.0, 1.7, 0.0, -3.0, 0.0, 0.0, 0.8]}",
    )
    with pytest.raises(InputError, match="the robot starts in collision") as told:
        load(tmp_path, folded)
    assert "Give it another 'arm:'" in str(told.value)


def test_what_a_file_says_may_not_overlap_and_what_is_seen_may(tmp_path: Path) -> None:
    cup, jar = (
        f"  {name}: {{box: [0.06, 0.06, 0.1], on: table, at: [{x}, 0.0]}}\n"
        for name, x in (("cup", 0.0), ("jar", 0.05))
    )
    head, _, goal = TEXT.partition("  cup:")
    twice = head + cup + jar + goal[goal.index("goal:") :]
    with pytest.raises(InputError, match="'cup' and 'jar' overlap"):
        load(tmp_path, twice)
    apart = load_scene(tmp_path / "tea.yaml")
    assert load(tmp_path, twice, scene=apart.scene).scene is apart.scene


def test_what_is_in_the_hand_is_no_more_where_it_lay(tea: Problem, tmp_path: Path) -> None:
    """It lay where the palm is by now; it is held below the fingers, or hits the floor."""
    context = tea.context
    conf = context.conf(tea.scene.robot.base, context.home)
    palm = Pose.from_matrix(context.kinematics.tool_plainly(conf)) @ Pose((0.0, 0.0, -0.06))
    lay = replace(tea.scene.bodies["cup"], pose=palm)
    seen = replace(tea.scene, bodies={**tea.scene.bodies, "cup": lay})
    with pytest.raises(InputError, match="the robot starts in collision: panda_"):
        load(tmp_path, scene=seen)
    grasp = Grasp("cup", Pose((0.0, 0.0, 0.05)), 0.06)
    assert load(tmp_path, scene=seen, holding=grasp).context.holding is grasp
    low = replace(grasp, T_tool_body=Pose((0.0, 0.0, 1.5)))
    with pytest.raises(InputError, match="the robot starts in collision: cup"):
        load(tmp_path, scene=seen, holding=low)


def test_a_function_that_no_stream_has_is_a_warning(tmp_path: Path) -> None:
    odd = load(tmp_path, functions={"sample-one": lambda *_, call: iter(())})
    assert any("sample-one" in text for text in odd.warnings)


def test_files_of_a_robot_are_told_where_it_does_not_come_with_us(tmp_path: Path) -> None:
    ours = ROBOTS["panda_mobile"]()
    assert _own_robot(ours) == ()
    for other in (replace(ours, name="mine"), replace(ours, folder=tmp_path / "panda_mobile")):
        assert _own_robot(other) == other.files != ()


def test_a_robot_beside_the_problem_is_the_one_that_plans(tmp_path: Path) -> None:
    other = load(tmp_path, robot="pr2")
    assert other.robot_given and other.context.robot.name == "pr2"
