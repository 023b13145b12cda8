"""Every mistake in a problem file is one clear error with the file, the line and what would have been right."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.overlaps import check_overlaps
from tests.needs import MESHES, NEEDS_PYBULLET

GOOD = """\
name: mine
domain: cupboard
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
  can: {cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.2, 0.1]}
goal: (on can table)
"""
CAN = "{cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.2, 0.1]}"
ROBOT = "{model: panda_mobile, base: [0, 0, 0]}"
TABLE = "{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}"

# What is replaced, by what, in which line the error is, and words of its message.
CASES = [
    # The file and its keys
    (GOOD, "", None, "the file is empty"),
    (GOOD, "- a\n- b\n", 1, "expected a mapping"),
    (GOOD, "just words\n", 1, "expected a mapping"),
    (GOOD, "a: [1, 2\nb: 3\n", 2, "not valid YAML"),
    (GOOD, "a: 1\n---\nb: 2\n", 2, "not valid YAML"),
    ("name: mine", "nme: mine", 1, "unknown key 'nme'.*Did you mean 'name'"),
    ("name: mine", "name:", 1, "name: has no value"),
    ("name: mine", "room: {x: [0, 1], y: [0, 1]}", 4, "'room' stands twice, first in line 1"),
    ("goal: (on can table)\n", "", 1, "'goal' is missing"),
    (f"robot: {ROBOT}\n", "", 1, "'robot' is missing"),
    ("  can: ", "  table: ", 7, "'table' stands twice, first in line 6"),
    ("goal: (on can table)", "goal: [on, can, table]", 8, "goal: expected text, found a list"),
    ("domain: cupboard", "init: (clean can)", 2, "init: expected a list"),
    # The robot and the room
    (
        "panda_mobile",
        "pnada_mobile",
        3,
        "unknown robot 'pnada_mobile'.*Choices:.*Did you mean 'panda_mobile'",
    ),
    (", base: [0, 0, 0]", "", 3, "robot: 'base' is missing"),
    ("[0, 0, 0]}", "[0, 0]}", 3, "robot.base: expected 3 numbers, found 2"),
    ("[0, 0, 0]}", "[0, 0, 90]}", 3, "more than a full turn.*'90 deg'"),
    ("[0, 0, 0]}", "[0, 3.0, 0]}", 3, "the robot starts out of the room: y = 3"),
    ("[0, 0, 0]}", "[0, 0, 0], arm: [0, 0, 0]}", 3, "robot.arm: expected 7 numbers, found 3"),
    (
        "[0, 0, 0]}",
        "[0, 0, 0], arm: [0, 0, 0, 1.0, 0, 1, 0]}",
        3,
        r"robot.arm\[3\]: .*joint's limits",
    ),
    ("x: [-2.5, 2.5]", "x: [2.5, -2.5]", 4, "room.x: the lower limit"),
    ("x: [-2.5, 2.5]", "x: [left, right]", 4, "'left' is not a number"),
    # Shapes
    ("cylinder: {radius", "cylindr: {radius", 7, "it has no shape.*Did you mean 'cylinder'"),
    (CAN, "{on: table}", 7, "it has no shape. Choices: box"),
    (CAN, "nothing", 7, "bodies.can: expected a mapping"),
    (
        CAN,
        "{box: [0.1, 0.1, 0.1], sphere: 0.1, on: table}",
        7,
        "'box' and 'sphere' both give a shape",
    ),
    (
        CAN,
        "{box: [0.1, -0.1, 0.1], on: table}",
        7,
        r"bodies.can.box\[1\]: must be positive, found -0.1",
    ),
    (CAN, "{box: [0.1, 0, 0.1], on: table}", 7, "must be positive, found 0"),
    (CAN, "{box: [0.1, .nan, 0.1], on: table}", 7, "not a finite number"),
    (CAN, "{box: [0.1, nan, 0.1], on: table}", 7, "not a finite number"),
    (CAN, "{sphere: .inf, on: table}", 7, "not a finite number"),
    (CAN, "{box: [60, 160, 210], on: table}", 7, "too large to be moved. Lengths are metres"),
    (CAN, "{box: 0.1, on: table}", 7, "expected 3 numbers, found '0.1'"),
    ("height: 0.1}", "heigth: 0.1}", 7, "unknown key 'heigth'.*Did you mean 'height'"),
    (", height: 0.1}", "}", 7, "bodies.can.cylinder: 'height' is missing"),
    ("radius: 0.03", "radius: wide", 7, "bodies.can.cylinder.radius: 'wide' is not a number"),
    ("radius: 0.03", "radius: true", 7, "'true' is not a number"),
    # Furniture
    ("furniture: table", "furniture: tabel", 6, "unknown furniture 'tabel'.*Did you mean 'table'"),
    (", size: [1.2, 0.7, 0.72]", "", 6, "'size' is missing"),
    ("0.72], at", "0.72], compartments: 2, at", 6, "unknown key 'compartments'"),
    ("0.72], at", "0.72], fixed: false, at", 6, "furniture is fixed, but for open_box"),
    ("0.72], at", "0.03], at", 6, "has no room under a top"),
    (
        TABLE,
        "{furniture: cupboard, size: [1, 1, 1], compartments: 0, at: [1.6, 0, 0]}",
        6,
        "must be at least 1",
    ),
    (
        TABLE,
        "{furniture: cupboard, size: [1, 1, 1], compartments: 1.5, at: [1.6, 0, 0]}",
        6,
        "not a whole number",
    ),
    (
        TABLE,
        "{furniture: table, size: [1, 1, 1], rpy: [0.1, 0, 0], at: [1.6, 0, 0]}",
        6,
        "'table' is not horizontal",
    ),
    # Properties
    ("on: table,", "on: table, mass: 0,", 7, "bodies.can.mass: must be positive"),
    ("on: table,", "on: table, mass: heavy,", 7, "'heavy' is not a number"),
    ("on: table,", "on: table, friction: -1,", 7, "bodies.can.friction: must be at least 0"),
    ("on: table,", "on: table, colour: gren,", 7, "unknown colour 'gren'.*Did you mean 'green'"),
    ("on: table,", "on: table, colour: [255, 0, 0],", 7, "must be at most 1"),
    ("on: table,", "on: table, colour: [1, 0],", 7, "found 2 numbers"),
    ("on: table,", "on: table, fixed: maybe,", 7, "neither true nor false"),
    ("on: table,", "on: table, colr: red,", 7, "unknown key 'colr'.*Did you mean 'colour'"),
    ("on: table,", "on: table, scale: 2,", 7, "unknown key 'scale'"),
    # Names
    ("  can: ", "  'my can': ", 7, "'my can' is not a name"),
    ("  can: ", "  2can: ", 7, "'2can' is not a name"),
    ("  can: ", "  Table: ", 7, "the name 'Table' is taken by body 'table'"),
    ("  can: ", "  floor: ", 7, "taken by the floor"),
    (
        CAN,
        "{box: [1, 1, 1], at: [0, 2, 0.5], surfaces: {table: {at: [0, 0, 0.5], size: [1, 1]}}}",
        7,
        "is taken by",
    ),
    # Where it stands
    (
        "on: table",
        "on: tabel",
        7,
        "unknown surface or body 'tabel'. Choices: floor, table.*Did you mean 'table'",
    ),
    ("on: table, at: [0.2, 0.1]", "mass: 1", 7, "nothing says where it is"),
    ("on: table, at: [0.2, 0.1]", "at: [0.2, 0.1]", 7, "expected 3 numbers, found 2.*on: floor"),
    ("at: [0.2, 0.1]", "at: [0.2, 0.1, 0.3]", 7, "expected 2 numbers, found 3"),
    ("at: [0.2, 0.1]", "at: [0.61, 0.1]", 7, "can's centre is 0.010 m outside of 'table'"),
    ("at: [0.2, 0.1]", "pose: {position: [0, 0, 1]}", 7, "'on' and 'pose' both"),
    ("on: table, at: [0.2, 0.1]", "pose: {yaw: 1}", 7, "'position' is missing"),
    (
        "on: table, at: [0.2, 0.1]",
        "pose: {position: [0, 0, 1]}, at: [1, 2, 3]",
        7,
        "'pose' and 'at' both",
    ),
    ("at: [0.2, 0.1]", "yaw: 90 degrees", 7, "'90 degrees' is not a number"),
    ("at: [0.2, 0.1]", "yaw: 0.1, rpy: [0, 0, 0]", 7, "both say how it is turned"),
    ("at: [0.2, 0.1]", "quaternion: [0, 0, 0, 0]", 7, "a quaternion of norm 0"),
    ("at: [0.2, 0.1]", "quaternion: [1, 1, 0, 0]", 7, "norm is 1.41, not 1"),
    ("at: [0.2, 0.1]", "quaternion: [0, 0, 1]", 7, "expected 4 numbers, found 3"),
    ("on: table, at: [0.2, 0.1]", "on: can", 7, "stand on each other in a circle: can on can"),
    ("on: table, at: [0.2, 0.1]", "at: [0, 0, 0]", 7, "it reaches 0.050 m below the floor"),
    (CAN, "{sphere: 0.03, on: table}\n  hat: {sphere: 0.02, on: can}", 8, "'can' has no flat top"),
    (
        TABLE,
        "{furniture: cupboard, size: [1, 1, 1], compartments: 2, at: [1.6, 0.0, 0.0]}",
        7,
        "'table' has several places to stand. Choices: table_top, table_1, table_2",
    ),
    (CAN, "{box: [1, 1, 1], on: table, surfaces: {s: {size: [1, 1]}}}", 7, "'at' is missing"),
    (
        CAN,
        "{box: [1, 1, 1], on: table, cavities: {s: {at: [0, 0, 0], size: [1, 1]}}}",
        7,
        "expected 3 numbers, found 2",
    ),
    # Meshes
    (
        CAN,
        "{mesh: objects/bwl.obj, on: table}",
        7,
        "no mesh file 'objects/bwl.obj'. Did you mean 'objects/bowl.obj'",
    ),
    pytest.param(
        CAN,
        "{mesh: pybullet_data/duc.obj, on: table}",
        7,
        "Did you mean 'pybullet_data/duck.obj'",
        marks=NEEDS_PYBULLET,
    ),
    (
        CAN,
        f"{{mesh: {MESHES}/plane_implicit.urdf, on: table}}",
        7,
        "has a <plane>, which has no end",
    ),
    (CAN, "{mesh: objects/bowl.obj, scale: 0, on: table}", 7, "bodies.can.scale: must be positive"),
    (
        CAN,
        "{mesh: objects/bowl.obj, scale: 1000, on: table}",
        7,
        "160 x 160 x 55 m large.*scale: 0.001",
    ),
]


@pytest.mark.parametrize(
    ("old", "new", "line", "message"), CASES, ids=[f"{n}" for n in range(len(CASES))]
)
def test_one_clear_error(
    tmp_path: Path, old: str, new: str, line: int | None, message: str
) -> None:
    assert GOOD.count(old) == 1
    file = tmp_path / "mine.yaml"
    file.write_text(GOOD.replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        load_scene(file)
    assert caught.value.file == str(file) and caught.value.line == line
    assert str(caught.value).startswith(f"{file}:{line}:" if line else f"{file}:")
    assert "\n" not in str(caught.value)


def test_the_good_file_is_good(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(GOOD)
    check_overlaps(load_scene(tmp_path / "mine.yaml"))


@pytest.mark.parametrize(
    ("other", "depth"),
    [
        ("{cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.25, 0.1]}", "10.0 mm"),
        ("{box: [0.1, 0.1, 0.1], on: table, at: [0.28, 0.1]}", "0.0 mm|touch"),
        ("{mesh: objects/mustard_bottle.obj, on: table, at: [0.2, 0.1]}", "mm"),
        ("{box: [0.5, 0.5, 0.5], at: [1.6, 0, 0.9], fixed: true}", "mm"),
    ],
)
def test_overlaps_are_named_with_their_depth(tmp_path: Path, other: str, depth: str) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(GOOD.replace("goal:", f"  other: {other}\ngoal:"))
    loaded = load_scene(file)
    if "touch" in depth:
        check_overlaps(loaded)
        return
    with pytest.raises(InputError, match=depth) as caught:
        check_overlaps(loaded)
    assert "'other'" in str(caught.value) and caught.value.line == 8
    assert caught.value.remedy


def test_a_missing_file_and_an_unknown_name() -> None:
    with pytest.raises(
        InputError, match=r"no such file: nowhere/four_objects.yaml.*Did you mean 'four_objects'"
    ):
        load_scene("nowhere/four_objects.yaml")
    with pytest.raises(
        InputError, match=r"unknown problem 'for_objects'.*Did you mean 'four_objects'"
    ):
        load_scene("for_objects")


def test_bytes_that_are_no_text(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_bytes(b"\xff\xfe\x00name")
    with pytest.raises(InputError, match="not UTF-8"):
        load_scene(file)
    file.write_bytes(b"name: a\x00b\n")
    with pytest.raises(InputError, match="not valid YAML"):
        load_scene(file)


def test_python_tags_are_data_or_refused(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(GOOD.replace("name: mine", "name: !!python/object/apply:os.getcwd []"))
    with pytest.raises(InputError, match="expected text"):
        load_scene(file)
