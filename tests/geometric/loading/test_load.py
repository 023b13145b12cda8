"""What a problem file says is what the scene holds."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.loading.overlaps import find_overlaps
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.scene import CONTACT_GAP, Box, Cylinder, Sphere

HEAD = """\
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.5, 90 deg]}
room: {x: [-2.5, 2.5], y: [-2, 3]}
goal: (on can table)
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
"""
PROBLEMS = sorted((Path(__file__).parents[3] / "problems").glob("*.yaml"))


def load(folder: Path, bodies: str, head: str = HEAD) -> LoadedProblem:
    """Load the head with these lines added under `bodies:`."""
    file = folder / "mine.yaml"
    file.write_text(head + "".join(f"  {line}\n" for line in bodies.splitlines()))
    return load_scene(file)


def test_the_head(tmp_path: Path) -> None:
    loaded = load(tmp_path, "can: {cylinder: {radius: 0.03, height: 0.1}, on: table}")
    assert loaded.scene.name == "mine" and loaded.domain == "cupboard"
    assert loaded.scene.robot.model == "panda_mobile" and loaded.scene.robot.arm is None
    assert loaded.scene.robot.base == pytest.approx((0.0, 0.5, math.pi / 2))
    assert loaded.scene.room.x == (-2.5, 2.5) and loaded.scene.room.y == (-2.0, 3.0)
    assert (loaded.goal.text, loaded.goal.line, loaded.goal.column) == ("(on can table)", 4, 7)
    assert loaded.lines == {"robot": 2, "table": 6, "can": 7}
    assert loaded.scene.fixed == ("table",) and loaded.scene.movable == ("can",)


def test_shapes_and_properties(tmp_path: Path) -> None:
    bodies = load(
        tmp_path,
        "box: {box: [0.1, 0.2, 0.3], on: table, mass: 1.5, friction: 0.9, colour: red}\n"
        "ball: {sphere: 0.04, on: table, at: [0.3, 0], colour: [0.1, 0.2, 0.3, 0.5]}\n"
        "can: {cylinder: {radius: 0.03, height: 0.1}, on: table, at: [-0.3, 0], fixed: yes}",
    ).scene.bodies
    assert bodies["box"].parts[0].shape == Box((0.1, 0.2, 0.3))
    assert bodies["ball"].parts[0].shape == Sphere(0.04)
    assert bodies["can"].parts[0].shape == Cylinder(0.03, 0.1)
    assert (bodies["box"].mass, bodies["box"].friction) == (1.5, 0.9)
    assert bodies["box"].colour[0] > 0.5 and bodies["ball"].colour == (0.1, 0.2, 0.3, 0.5)
    assert [bodies[name].movable for name in ("table", "box", "ball", "can")] == [
        False,
        True,
        True,
        False,
    ]


def test_on_puts_the_lowest_point_just_above_the_surface(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        "standing: {box: [0.06, 0.16, 0.21], on: table, at: [0.1, 0.2], yaw: 20 deg}\n"
        "lying: {cylinder: {radius: 0.03, height: 0.2}, on: table, at: [-0.3, 0], rpy: [90 deg, 0, 0]}",
    ).scene
    # The table is turned by 90 degrees: its x is the world's y, its y the world's -x.
    assert scene.bodies["standing"].pose.position == pytest.approx(
        (1.4, 0.1, 0.72 + 0.105 + CONTACT_GAP)
    )
    assert scene.bodies["standing"].pose.yaw == pytest.approx(math.radians(110))
    assert scene.bodies["lying"].pose.position == pytest.approx(
        (1.6, -0.3, 0.72 + 0.03 + CONTACT_GAP)
    )
    assert scene.bodies["lying"].support == "table"


def test_bodies_may_be_listed_in_any_order_and_stand_on_each_other(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        "can: {cylinder: {radius: 0.02, height: 0.1}, on: tray, at: [0.05, 0.0]}\n"
        "tray: {box: [0.2, 0.2, 0.02], on: table, yaw: 90 deg}",
    ).scene
    assert scene.bodies["tray"].support == "table" and scene.bodies["can"].support == "tray"
    # The tray stands at 90 + 90 degrees.
    assert scene.bodies["can"].pose.position == pytest.approx(
        (1.55, 0.0, 0.72 + 0.02 + 0.05 + 2 * CONTACT_GAP)
    )
    assert list(scene.bodies) == ["table", "can", "tray"]


def test_cavities_and_the_floor_carry_bodies(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        "cupboard: {furniture: cupboard, size: [0.9, 0.42, 0.75], compartments: 2, at: [-1.6, 0.4, 0]}\n"
        "bin: {furniture: open_box, size: [0.4, 0.3, 0.2], at: [0, -1.5, 0]}\n"
        "low: {box: [0.1, 0.1, 0.1], on: cupboard_1, at: [0.2, 0.0]}\n"
        "in_bin: {box: [0.1, 0.1, 0.1], on: bin}\n"
        "down: {box: [0.1, 0.1, 0.1], on: floor, at: [1, 2]}",
    ).scene
    assert scene.bodies["low"].pose.position == pytest.approx(
        (-1.4, 0.39, 0.02 + 0.05 + CONTACT_GAP)
    )
    assert scene.bodies["in_bin"].support == "bin"
    assert scene.bodies["down"].support is None
    assert scene.bodies["down"].pose.position == pytest.approx((1, 2, 0.05 + CONTACT_GAP))


@pytest.mark.parametrize(
    "pose",
    [
        "pose: {position: [1, 2, 3], quaternion: [0, 0, 0.7071068, 0.7071068]}",
        "pose: {position: [1, 2, 3], rpy: [0, 0, 90 deg]}",
        "pose: {position: [1, 2, 3], yaw: 90 deg}",
        "{at: [1, 2, 3], yaw: 1.5707963267948966}",
        "{at: [1, 2, 3], yaw: 1.5707963267948966 rad}",
        "{at: [1, 2, 3], quaternion: [0, 0, 0.7071068, 0.7071068]}",
        "{at: [1, 2, 3], rpy: [0, 0, 90deg]}",
    ],
)
def test_ways_to_write_a_pose(tmp_path: Path, pose: str) -> None:
    body = load(
        tmp_path,
        f"wall: {{box: [1, 0.1, 1], fixed: true, {pose.strip('{}') if pose[0] == '{' else pose}}}",
    )
    matrix = body.scene.bodies["wall"].pose.matrix
    assert np.allclose(matrix, [[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]], atol=1e-6)


@pytest.mark.parametrize("height", [0.7185, 0.72, 0.7215])
def test_a_posed_body_near_a_surface_is_snapped_onto_it(tmp_path: Path, height: float) -> None:
    loaded = load(tmp_path, f"box: {{box: [0.1, 0.1, 0.1], at: [1.6, 0, {height + 0.05}]}}")
    assert loaded.scene.bodies["box"].support == "table"
    assert loaded.scene.bodies["box"].pose.position[2] == pytest.approx(0.72 + 0.05 + CONTACT_GAP)
    assert not loaded.warnings and not list(find_overlaps(loaded.scene))


def test_a_body_in_the_air_is_kept_with_a_warning(tmp_path: Path) -> None:
    loaded = load(tmp_path, "box: {box: [0.1, 0.1, 0.1], at: [1.6, 0, 1.0]}")
    assert (
        loaded.scene.bodies["box"].pose.position[2] == 1.0
        and loaded.scene.bodies["box"].support is None
    )
    assert len(loaded.warnings) == 1 and "box hangs in the air" in loaded.warnings[0]


def test_declared_places_and_derived_tops(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        "block: {box: [0.4, 0.4, 0.2], at: [0, 2, 0.1], fixed: true, "
        "surfaces: {spot: {at: [0.1, 0, 0.1], size: [0.1, 0.2], yaw: 90 deg, clearance: 0.3}}, "
        "cavities: {hole: {at: [0, 0, 0], size: [0.1, 0.1, 0.1]}}}\n"
        "slab: {box: [0.4, 0.3, 0.02], at: [-1, 0, 0.5], fixed: true}\n"
        "pole: {cylinder: {radius: 0.02, height: 1}, at: [-1, 1, 0.5], fixed: true}\n"
        "can: {cylinder: {radius: 0.02, height: 0.1}, on: spot, at: [0.05, 0]}",
    ).scene
    assert set(scene.surfaces) == {"table", "spot", "slab"} and set(scene.cavities) == {"hole"}
    assert scene.surfaces["spot"].clearance == 0.3 and scene.surfaces["slab"].size == (0.4, 0.3)
    assert scene.bodies["can"].pose.position == pytest.approx((0.1, 2.05, 0.25 + CONTACT_GAP))


def test_init_metric_samplers_and_arm(tmp_path: Path) -> None:
    head = HEAD.replace("90 deg]}", "90 deg], arm: [0, -45 deg, 0, -2.2, 0, 1.8, 0.7]}", 1)
    head = (
        'init: ["(clean can)", (warm can)]\nmetric: (minimize (total-cost))\nsamplers: {on: uniform}\n'
        + head
    )
    loaded = load(tmp_path, "can: {cylinder: {radius: 0.03, height: 0.1}, on: table}", head)
    assert [(fact.text, fact.line, fact.column) for fact in loaded.init] == [
        ("(clean can)", 1, 9),
        ("(warm can)", 1, 23),
    ]
    assert loaded.metric and loaded.metric.text == "(minimize (total-cost))"
    assert loaded.samplers == {"on": "uniform"}
    assert loaded.scene.robot.arm == pytest.approx((0, -math.pi / 4, 0, -2.2, 0, 1.8, 0.7))


@pytest.mark.parametrize(
    ("goal", "text", "line", "column"),
    [
        ("goal: (and (on a b)\n  (on c d))\n", "(and (on a b)\n  (on c d))", 1, 7),
        ("goal: |\n  (and\n    ; why\n    (on a b))\n", "  (and\n    ; why\n    (on a b))", 2, 1),
        ("goal: >\n\n  (on a b)\n# comment\n", "\n  (on a b)", 2, 1),
        ('goal: "(on a b)"\n', "(on a b)", 1, 8),
        ("goal:\n  (on a b)\n", "(on a b)", 2, 3),
    ],
)
def test_the_goal_keeps_its_place(
    tmp_path: Path, goal: str, text: str, line: int, column: int
) -> None:
    head = goal + HEAD.replace("goal: (on can table)\n", "")
    passage = load(tmp_path, "", head).goal
    assert (passage.text.rstrip(), passage.line, passage.column) == (text, line, column)


def test_the_goal_may_be_a_block_at_the_files_end(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    for ending in ("", "\n", "\n\n"):
        file.write_text(
            HEAD.replace("goal: (on can table)\n", "") + "goal: |\n  (and\n    (on a b))" + ending
        )
        assert load_scene(file).goal.text.rstrip() == "  (and\n    (on a b))"


def test_yaml_anchors_and_merges_work(tmp_path: Path) -> None:
    loaded = load(
        tmp_path,
        "one: &can {cylinder: {radius: 0.03, height: 0.1}, on: table, mass: 0.4}\n"
        "two: {<<: *can, at: [0.2, 0.2], mass: 0.6}",
    )
    assert loaded.scene.bodies["two"].parts == loaded.scene.bodies["one"].parts
    assert (loaded.scene.bodies["one"].mass, loaded.scene.bodies["two"].mass) == (0.4, 0.6)


def test_the_scene_is_frozen(tmp_path: Path) -> None:
    scene = load(tmp_path, "can: {sphere: 0.03, on: table}").scene
    with pytest.raises(TypeError):
        scene.bodies["can"] = scene.bodies["table"]  # type: ignore[index]


@pytest.mark.parametrize("file", PROBLEMS, ids=lambda file: file.stem)
def test_shipped_problems_load_without_warning_or_overlap(file: Path) -> None:
    loaded = load_scene(file)
    assert loaded.scene.name == file.stem and loaded.domain
    assert not loaded.warnings
    assert not list(find_overlaps(loaded.scene))
    assert file.read_text().startswith("# ")
    for name in loaded.scene.movable:
        body = loaded.scene.bodies[name]
        low, _ = bounds(body.parts, body.pose)
        places = {**loaded.scene.surfaces, **loaded.scene.cavities}
        assert body.support
        if body.support in places:
            height = loaded.scene.world_pose(places[body.support]).position[2]
        else:  # a box that may be moved
            support = loaded.scene.bodies[body.support]
            assert support.movable
            height = bounds(support.parts, support.pose)[1][2]
        assert low[2] == pytest.approx(height + CONTACT_GAP)


def test_the_example_of_the_documentation_loads(tmp_path: Path) -> None:
    text = (PROBLEMS[0].parents[1] / "docs" / "problem-format.md").read_text()
    file = tmp_path / "kitchen.yaml"
    file.write_text(text.split("```yaml\n")[1].split("```")[0])
    loaded = load_scene(file)
    assert not loaded.warnings and not list(find_overlaps(loaded.scene))
    assert set(loaded.scene.surfaces) == {"table", "cupboard_top"}


def test_the_ladder_is_complete() -> None:
    assert {file.stem for file in PROBLEMS} >= {
        "one_object", "two_objects", "four_objects", "eight_objects", "cluttered", "shelves", "blocked", "swap",
        "impossible_reach", "impossible_size",
    }  # fmt: skip


def test_loading_imports_nothing_heavy() -> None:
    """A problem without new meshes is read without trimesh, scipy or fcl: together they take a second."""
    code = (
        "import sys; from tamp.geometric.loading.load import load_scene; load_scene('four_objects');"
        "print([name for name in ('trimesh', 'scipy', 'fcl', 'pybullet', 'pinocchio') if name in sys.modules])"
    )
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() == "[]"
