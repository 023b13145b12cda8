"""A plan file is read into values, options and actions; what it may not be is named by its place."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.plan.open import read_motions
from tamp.plan.read import read_plan
from tests.plan.making import DOCUMENT, SHA


def test_options_are_read_where_a_plan_tells_them(file: Path) -> None:
    plain = read_motions(file)
    assert (plain.algorithm, dict(plain.samplers)) == ("adaptive", {})
    file.write_text(
        json.dumps(
            {**DOCUMENT, "options": {"algorithm": "incremental", "samplers": {"on": "uniform"}}}
        )
    )
    told = read_motions(file)
    assert (told.algorithm, dict(told.samplers)) == ("incremental", {"on": "uniform"})
    assert told.source("mesh") is None and told.source("problem") is not None


def test_values_are_matrices_and_rows(file: Path) -> None:
    half = np.sqrt(0.5)
    values = {
        "p": {"type": "pose", "position": [1, 2, 3], "quaternion": [0, 0, half, half]},
        "b": {"type": "base-conf", "base": [0.1, 0.2, 0.3]},
        "g": {"type": "grasp", "body": "cup", "opening": 0.04,
              "T_tool_body": {"position": [0, 0, 0.1], "quaternion": [0, 0, 0, 1]}},
        "x": {"type": "of-a-later-version", "anything": 1},
    }  # fmt: skip
    file.write_text(json.dumps({**DOCUMENT, "values": values}))
    read = read_motions(file).values
    quarter = np.array([[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
    assert read["p"].data == pytest.approx(quarter, abs=1e-7)
    assert read["b"].data.tolist() == [0.1, 0.2, 0.3]
    assert read["g"].data.T_tool_body[2, 3] == 0.1 and read["g"].data.opening == 0.04
    assert read["x"].data is None

    values["g"]["T_tool_body"]["position"] = [0, 0, 2.5]  # type: ignore[index]
    file.write_text(json.dumps({**DOCUMENT, "values": values}))
    with pytest.raises(
        InputError, match=r"values.g.T_tool_body.position: farther from the hand than anything"
    ):
        read_motions(file)


def document(*segments: dict, **entries: Any) -> dict[str, Any]:
    """The least plan with one action of these segments."""
    action = {"name": "pick", "arguments": [], "start": 0, "duration": 1}
    return {**DOCUMENT, "actions": [{**action, "segments": list(segments)}], **entries}


IDENTITY = {"position": [0, 0, 0], "quaternion": [0, 0, 0, 1]}


def test_fingers_close_on_a_body_with_what_stands_on_it() -> None:
    load = [{"body": "cup", "T_body_rider": {**IDENTITY, "position": [0, 0, 0.5]}}]
    attach = {"body": "cup", "T_tool_body": IDENTITY, "load": load}
    grips = {"part": "gripper", "times": [0, 0.5], "opening": [0.08, 0.06], "attach": attach}
    opens = {"part": "gripper", "times": [0], "opening": [0.08], "detach": "cup", "arm": "left"}
    closed, opened = read_plan(document(grips, opens)).actions[0].segments
    assert closed.attach is not None and closed.attach.opening == 0.06
    ((rider, T_body_rider),) = closed.attach.load
    assert rider == "cup" and T_body_rider[2, 3] == 0.5
    assert closed.positions.shape == (2, 0) and closed.opening.tolist() == [0.08, 0.06]
    assert (opened.detach, opened.attach, opened.arm) == ("cup", None, "left")


def test_a_motion_that_tells_its_segments_has_the_rows_of_each() -> None:
    drive = {"part": "base", "points": [[0, 0, 0], [1, 2, 3]]}
    values = {
        "m": {"type": "motion", "segments": [drive, {"part": "gripper", "opening": [0.08, 0.06]}]},
        "n": {"type": "motion"},
        "r": {"type": "reach", "approach": [[0.0] * 6], "lift": [[1.0] * 6]},
    }
    read = read_plan({**DOCUMENT, "values": values}).values
    (base, rows, arm), (gripper, openings, _) = read["m"].data
    assert (base, arm, gripper) == ("base", None, "gripper")
    assert rows.tolist() == [[0, 0, 0], [1, 2, 3]] and openings.tolist() == [[0.08], [0.06]]
    assert read["n"].data is None
    assert [one.tolist() for one in read["r"].data] == [[[0.0] * 6], [[1.0] * 6]]


DRIVES = {"part": "base", "times": [0, 1], "positions": [[0, 0, 0], [1, 0, 0]], "opening": 0.08}


@pytest.mark.parametrize(
    ("spoilt", "said"),
    [
        ({**DOCUMENT, "format": "other"}, "not a plan file"),
        ({**DOCUMENT, "version": 2}, "version: version 2 is not known, only 1"),
        (document({**DRIVES, "times": []}), r"segments\[0\].times: at least one time"),
        (document({**DRIVES, "times": [0]}), "1 rows are expected, one a time, not 2"),
        (document({**DRIVES, "holding": "cop"}), "unknown body 'cop'.*Did you mean 'cup'"),
        (document({**DRIVES, "part": "wheel"}), "'wheel' is unknown"),
        ({**DOCUMENT, "initial": [[]]}, r"initial\[0\]: a fact needs a predicate"),
        ({**DOCUMENT, "inputs": {"domain": {"path": "d", "sha256": SHA}}}, "'problem' is missing"),
    ],
)
def test_what_is_wrong_is_named_by_its_place(spoilt: dict[str, Any], said: str) -> None:
    assert len(read_plan(document(DRIVES)).actions[0].segments) == 1
    with pytest.raises(InputError, match=said):
        read_plan(spoilt)
