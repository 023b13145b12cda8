"""The entry `gripper` of a robot.yaml: what is read of it, and what cannot be, with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robot_gripper import ReadGripper, read_gripper
from tests.geometric.making import yaml

POSE = "{xyz: [0.0, 0.0, 0.1], quaternion: [0.0, 0.0, 0.0, 1.0]}"
PARALLEL = f"""\
kind: parallel
hand: palm
mount: {POSE}
tool: {POSE}
force: 60.0
opening: 0.08
speed: 0.2
fingers:
  left:  {{link: thumb, origin: {POSE}, axis: [0.0, 1.0, 0.0]}}
  right: {{link: jaw, origin: {POSE}, axis: [0.0, -1.0, 0.0]}}
"""
SUCTION = f"""\
kind: suction
hand: cup
mount: {POSE}
tool: {POSE}
force: 30.0
radius: 0.02
tilt: 0.2
"""


def read(folder: Path, text: str) -> ReadGripper:
    return read_gripper(yaml(folder, text))


def refused(folder: Path, text: str, old: str, new: str) -> InputError:
    assert old in text
    with pytest.raises(InputError) as caught:
        read(folder, text.replace(old, new))
    return caught.value


def test_two_fingers_slide_from_the_hand(tmp_path: Path) -> None:
    gripper = read(tmp_path, PARALLEL)
    assert (gripper.hand, gripper.opening, gripper.force) == ("palm", 0.08, 60.0)
    assert gripper.suction is None
    left, right = gripper.fingers
    assert (left.name, left.parent, left.child, left.axis) == (
        "left", "palm", "thumb", (0.0, 1.0, 0.0),
    )  # fmt: skip
    assert (right.child, right.axis) == ("jaw", (0.0, -1.0, 0.0))
    # Each goes half the opening, from the middle on.
    assert (left.kind, left.lower, left.upper, left.velocity) == ("prismatic", 0.0, 0.04, 0.2)
    assert left.origin.position == (0.0, 0.0, 0.1)


def test_fingers_are_what_is_meant_where_no_kind_is_said(tmp_path: Path) -> None:
    assert (
        len(read(tmp_path, PARALLEL.replace("kind: parallel\n", "kind: parallel\n")).fingers) == 2
    )
    error = refused(tmp_path, PARALLEL, "kind: parallel\n", "")
    assert "kind" in error.message  # told once it is known which entries are asked for


def test_a_cup_has_a_radius_and_no_fingers(tmp_path: Path) -> None:
    gripper = read(tmp_path, SUCTION)
    assert gripper.suction is not None
    assert (gripper.suction.radius, gripper.suction.tilt) == (0.02, 0.2)
    assert (gripper.opening, gripper.fingers, gripper.force) == (0.0, (), 30.0)


@pytest.mark.parametrize(
    ("text", "old", "new", "line", "words"),
    [
        (PARALLEL, "kind: parallel", "kind: magnet", 1, "magnet"),
        (PARALLEL, "  right: ", "  third: ", None, None),
        (PARALLEL, "opening: 0.08", "opening: 0.0", 6, "0"),
        (PARALLEL, "force: 60.0", "force: -1.0", 5, "-1"),
        (PARALLEL, "speed: 0.2\n", "", 1, "speed"),
        (PARALLEL, "axis: [0.0, 1.0, 0.0]", "axis: [0.0, 1.0]", 9, "3"),
        (SUCTION, "tilt: 0.2", "tilt: 1.0", 7, "a face may lean by 0 to 0.785 rad, not by 1"),
        (SUCTION, "tilt: 0.2", "tilt: -0.1", 7, "not by -0.1"),
        (SUCTION, "force: 30.0", "force: 200.0", 5, "pulls with 127 N at most, not with 200"),
        (SUCTION, "radius: 0.02", "opening: 0.02", None, "opening"),
    ],
)
def test_what_cannot_be_is_refused_at_its_line(
    tmp_path: Path, text: str, old: str, new: str, line: int | None, words: str | None
) -> None:
    if words is None:  # a name is the gripper's own affair
        assert {finger.name for finger in read(tmp_path, text.replace(old, new)).fingers} == {
            "left", "third",
        }  # fmt: skip
        return
    error = refused(tmp_path, text, old, new)
    assert words in error.message
    if line is not None:
        assert error.line == line


def test_a_gripper_of_one_finger_is_none(tmp_path: Path) -> None:
    third = PARALLEL.splitlines()[-1]
    error = refused(tmp_path, PARALLEL, third, "")
    assert "two fingers, not 1" in error.message
    assert (
        "not 3"
        in refused(tmp_path, PARALLEL, third, f"{third}\n{third.replace('right', 'more')}").message
    )


def test_what_the_air_cannot_press_has_a_remedy(tmp_path: Path) -> None:
    error = refused(tmp_path, SUCTION, "force: 30.0", "force: 128.0")
    assert "larger radius" in (error.remedy or "")
    read(tmp_path, SUCTION.replace("force: 30.0", "force: 127.0"))


def test_a_quaternion_has_norm_one(tmp_path: Path) -> None:
    error = refused(
        tmp_path, SUCTION, "quaternion: [0.0, 0.0, 0.0, 1.0]", "quaternion: [0, 0, 0, 0.9]"
    )
    assert "norm is not 1" in error.message and error.line == 3
