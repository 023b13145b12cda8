"""Writing demonstration files: what was written is read, and what cannot be is refused."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from grounding.relations.demonstration_file import Label, demonstrations_of
from grounding.relations.demonstration_text import (
    BodyEntry,
    DemonstrationFile,
    read_entries,
    write_demonstration,
)
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tests.grounding.relations.shown import BODIES, everything


@pytest.mark.parametrize(
    "arguments", [("cup",), ("cup", "plate"), ("cup", "plate", "bowl"), ("cup", "desk")]
)
def test_what_was_written_is_read(arguments: tuple[str, ...], tmp_path: Path) -> None:
    path = tmp_path / "new/one.yaml"
    write_demonstration(
        path, everything(Label("set_cup", arguments, True), Label("other", ("cup",), False))
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


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (DemonstrationFile(BODIES, ()), "needs a label"),
        (
            DemonstrationFile({"a b": BODIES["cup"]}, (Label("r", ("a b",), True),)),
            "'a b' is no name",
        ),
        (everything(Label("on top", ("cup",), True)), "'on top' is no name"),
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
