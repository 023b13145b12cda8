"""Demonstration files of any bodies: written, read again, and what is wrong with them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from grounding.relations.demonstration_file import Label, demonstrations_of
from grounding.relations.demonstration_text import (
    BodyEntry,
    DemonstrationFile,
    demonstration_text,
    read_entries,
    write_demonstration,
)
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose

BODIES = {
    "desk": BodyEntry(
        {"furniture": "table", "size": [1.2, 0.7, 0.72]}, Pose.from_xyz_yaw(1.5, 0.0, 0.0, 0.4)
    ),
    "cup": BodyEntry(
        {"cylinder": {"radius": 0.04, "height": 0.1}, "colour": "red"}, Pose((1.5, 0.1, 0.771))
    ),
    "plate": BodyEntry(
        {"box": [0.2, 0.2, 0.02], "front": "90 deg"}, Pose.from_xyz_yaw(1.4, -0.2, 0.731, 1.0)
    ),
    "bowl": BodyEntry(
        {"mesh": "objects/bowl.obj", "fixed": True},
        Pose.from_xyz_rpy((1.9, 0.2, 0.9), (1.0, 0.2, 0.0)),
    ),
}


def shown(*labels: Label) -> DemonstrationFile:
    return DemonstrationFile(BODIES, labels, "A cup\nbeside a plate.")


@pytest.mark.parametrize(
    "arguments", [("cup",), ("cup", "plate"), ("cup", "plate", "bowl"), ("cup", "desk")]
)
def test_what_was_written_is_read(arguments: tuple[str, ...], tmp_path: Path) -> None:
    path = tmp_path / "new/one.yaml"
    write_demonstration(
        path, shown(Label("set_cup", arguments, True), Label("other", ("cup",), False))
    )
    (found,) = demonstrations_of("Set_Cup", [path.parent])
    assert found.arguments == arguments and found.holds and found.source.startswith(f"{path}:")
    for name, entry in BODIES.items():
        matrix = found.scene.bodies[name].pose.matrix
        assert (
            np.abs(matrix - entry.pose.matrix).max() < 2e-3
        )  # a movable body is set onto what is 2 mm below
    assert found.scene.bodies["plate"].front == pytest.approx(math.pi / 2)
    assert found.scene.bodies["desk"].front == 0.0

    again = tmp_path / "again.yaml"
    write_demonstration(
        again, DemonstrationFile(read_entries(path), [Label("set_cup", arguments, False)])
    )
    (other,) = demonstrations_of("set_cup", [again])
    assert not other.holds
    for name in BODIES:
        assert (
            np.abs(
                other.scene.bodies[name].pose.matrix - found.scene.bodies[name].pose.matrix
            ).max()
            < 1e-6
        )
        assert [type(part.shape) for part in other.scene.bodies[name].parts] == [
            type(part.shape) for part in found.scene.bodies[name].parts
        ]


def test_robot_and_room_may_be_left_out(tmp_path: Path) -> None:
    path = tmp_path / "one.yaml"
    text = demonstration_text(shown(Label("alone", ("cup",), True)))
    path.write_text(
        "\n".join(line for line in text.splitlines() if not line.startswith(("robot", "room")))
    )
    assert [one.arguments for one in demonstrations_of("alone", [path])] == [("cup",)]


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        ("(near cup plate)", "one.yaml:11: the goal says nothing of 'stack'"),
        ("(stack cpu plate)", "one.yaml:11:14: unknown object 'cpu'"),
        ("(stack)", "names one to 6 bodies"),
        ("(stack (cup) plate)", "names one to 6 bodies"),
        ("(stack cup cup)", "'cup' stands twice"),
        ("(and (stack cup plate) (stack cup))", "has 1 arguments here, and 2 before"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(goal: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "one.yaml"
    text = demonstration_text(shown(Label("stack", ("cup", "plate"), True)))
    path.write_text(text.replace("(stack cup plate)", goal))
    with pytest.raises(InputError) as found:
        list(demonstrations_of("stack", [path]))
    assert message in str(found.value)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (DemonstrationFile(BODIES, ()), "needs a label"),
        (
            DemonstrationFile({"a b": BODIES["cup"]}, (Label("r", ("a b",), True),)),
            "'a b' is no name",
        ),
        (shown(Label("on top", ("cup",), True)), "'on top' is no name"),
        (
            DemonstrationFile(
                {"cup": BodyEntry({"box": [1, 1, 1]}, Pose((math.nan, 0, 0)))},
                [Label("r", ("cup",), True)],
            ),
            "nan is not a finite number",
        ),
    ],
)
def test_what_cannot_be_written_is_refused(
    wrong: DemonstrationFile, message: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=message):
        write_demonstration(tmp_path / "one.yaml", wrong)
    assert not list(tmp_path.iterdir())
