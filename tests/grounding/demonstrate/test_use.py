"""The problem that the page plans: its robot stands in front, or is the given scene's."""

from __future__ import annotations

import math
import shlex
from pathlib import Path

import numpy as np
import pytest

from grounding.demonstrate.relation import parse_relation
from grounding.demonstrate.scene import Stage, sample_stage
from grounding.demonstrate.use import ROBOT_DISTANCE_M, ROOM_MARGIN_M, Uses, write_problem
from grounding.demonstrate.viewer import depth, stand_of
from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.yaml_file import read_yaml
from tamp.geometric.scene.scene import Scene

STACK = parse_relation("stack(a, b)")


@pytest.fixture(scope="module")
def stage() -> Stage:
    return sample_stage(STACK, np.random.default_rng(0))


def written(folder: Path, stage: Stage, scene: Path | None = None) -> Scene:
    uses = Uses("stack", folder)
    write_problem(uses, STACK, stage, scene)
    return load_scene(uses.problem, demonstration=True).scene


def test_the_robot_stands_in_front_of_the_furniture_and_looks_at_it(
    stage: Stage, tmp_path: Path
) -> None:
    made = written(tmp_path, stage)
    stand = stand_of(stage.scene, stage.arguments)
    assert stand is not None
    x, y, yaw = made.robot.base
    to = np.array(stand.pose.position[:2]) - (x, y)
    assert np.linalg.norm(to) == pytest.approx(depth(stand) / 2 + ROBOT_DISTANCE_M, abs=2e-3)
    assert math.remainder(math.atan2(to[1], to[0]) - yaw, 2 * math.pi) == pytest.approx(0, abs=2e-3)
    # on the side of its front: it would not see that one's back
    side = stand.pose.yaw + stand.front - math.pi / 2
    assert np.allclose(-to / np.linalg.norm(to), [math.cos(side), math.sin(side)], atol=2e-3)


def test_the_room_is_around_the_furniture(stage: Stage, tmp_path: Path) -> None:
    room, stand = written(tmp_path, stage).room, stand_of(stage.scene, stage.arguments)
    assert stand is not None
    for (low, high), middle in zip((room.x, room.y), stand.pose.position[:2], strict=True):
        assert (low, high) == pytest.approx(
            (middle - ROOM_MARGIN_M, middle + ROOM_MARGIN_M), abs=1e-3
        )


def test_the_bodies_are_where_they_were_and_the_relation_is_the_goal(
    stage: Stage, tmp_path: Path
) -> None:
    made = written(tmp_path, stage)
    assert made.bodies.keys() == stage.scene.bodies.keys()
    for name, body in made.bodies.items():
        assert np.allclose(body.pose.matrix, stage.scene.bodies[name].pose.matrix, atol=1e-4)

    root = read_yaml(Uses("stack", tmp_path).problem).mapping()
    assert root["domain"].text() == "../stack.pddl"
    assert root["samplers"].mapping()["stack"].text() == "../stack.safetensors"
    assert root["goal"].text() == f"(stack {' '.join(stage.arguments)})"


def test_a_given_scenes_robot_and_room_are_taken(stage: Stage, tmp_path: Path) -> None:
    given = tmp_path / "given.yaml"
    arm = "[0.1, -0.5, 0.0, -2.0, 0.0, 1.5, 0.7]"
    given.write_text(
        f"robot: {{model: panda_mobile, base: [0.5, -1.5, 0.25], arm: {arm}}}\n"
        "room: {x: [-4.0, 3.0], y: [-2.0, 2.5]}\n"
        "bodies:\n  table: {furniture: table, size: [1.2, 0.7, 0.7], at: [1.6, 0, 0]}\ngoal: (and)\n"
    )
    made, wanted = written(tmp_path / "out", stage, given), load_scene(given, demonstration=True)
    assert made.robot == wanted.scene.robot and made.robot.arm is not None
    assert (made.room.x, made.room.y) == ((-4.0, 3.0), (-2.0, 2.5))


def test_what_cannot_be_written_is_an_error(stage: Stage, tmp_path: Path) -> None:
    (tmp_path / "plan").write_text("a file where the folder should be")
    with pytest.raises(InputError, match="cannot be written") as caught:
        write_problem(Uses("stack", tmp_path), STACK, stage, None)
    assert caught.value.file == str(tmp_path / "plan" / "problem.yaml")


def test_commands_are_as_a_user_types_them_and_stay_in_the_folder() -> None:
    uses = Uses("left_of", Path("my demos"))
    assert shlex.split(uses.commands["learn"]) == ["tamp-learn", *uses.learning]
    assert shlex.split(uses.commands["plan"]) == ["tamp-solve", *uses.planning]
    assert uses.learning == [
        "new", "left_of", "--demos", "my demos", "--out", "my demos/left_of.safetensors",
        "--add-to", "my demos/left_of.pddl",
    ]  # fmt: skip
    assert uses.planning[0] == str(uses.problem) == "my demos/plan/problem.yaml"
    assert "--verify" in uses.planning and str(uses.page) in uses.planning
