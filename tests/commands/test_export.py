"""tamp-export as a user meets it: each format, where it goes, one clear error for each bad input."""

from __future__ import annotations

import csv
import io
import itertools
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.commands.export import main
from tamp.geometric.loading.robots import ROBOTS
from tamp.plan.open import open_plan
from tests.plan.making import moved

PANDA = ROBOTS["panda_mobile"]()
ARM = [joint.name for joint in PANDA.joints]
FINGERS = [joint.name for joint in PANDA.fingers]
BASE = ["base_x", "base_y", "base_yaw"]


def exported(plan: Path, name: str, folder: Path) -> str:
    out = folder / f"deep/{name}"
    assert main([str(plan), "--format", name, "--out", str(out)]) == 0
    return out.read_text(encoding="utf-8")


def test_json_has_every_motion_of_the_plan(stored_plan: Path, tmp_path: Path) -> None:
    document = json.loads(exported(stored_plan, "json", tmp_path))
    plan = json.loads(stored_plan.read_text(encoding="utf-8"))
    assert document["joints"] == {"base": BASE, "arm": ARM, "gripper": FINGERS}
    assert document["duration"] == plan["duration"]
    clock, looked_at = 0.0, 0
    for action, planned in zip(document["actions"], plan["actions"], strict=True):
        assert (action["name"], action["arguments"]) == (planned["name"], planned["arguments"])
        for segment, source in zip(action["segments"], planned["segments"], strict=True):
            assert segment["times"] == pytest.approx([clock + time for time in source["times"]])
            assert segment["joints"] == document["joints"][segment["part"]]
            expected = source.get("positions") or [[width / 2] * 2 for width in source["opening"]]
            assert segment["positions"] == pytest.approx(np.array(expected))
            clock += source["times"][-1]
            looked_at += 1
    assert looked_at >= 8
    assert clock == pytest.approx(plan["duration"])
    assert [s["attach"] for a in document["actions"] for s in a["segments"] if "attach" in s] == [
        "soup_can"
    ]


def test_velocities_rest_at_the_ends_and_keep_the_limits(stored_plan: Path, tmp_path: Path) -> None:
    document = json.loads(exported(stored_plan, "json", tmp_path))
    limits = {"base": np.array(PANDA.velocity[:3]), "arm": np.array(PANDA.velocity[3:])}
    fastest = {"base": 0.0, "arm": 0.0}
    for segment in (segment for action in document["actions"] for segment in action["segments"]):
        velocities = np.array(segment["velocities"])
        assert not velocities[0].any() and not velocities[-1].any()
        if segment["part"] in limits:
            share = np.abs(velocities) / limits[segment["part"]]
            fastest[segment["part"]] = max(fastest[segment["part"]], float(share.max()))
    assert max(fastest.values()) <= 1.0 + 1e-6
    assert min(fastest.values()) > 0.5


def test_csv_has_all_joints_in_every_row(stored_plan: Path, tmp_path: Path) -> None:
    rows = list(csv.DictReader(io.StringIO(exported(stored_plan, "csv", tmp_path))))
    joints = [*BASE, *ARM, *FINGERS]
    assert list(rows[0])[5:] == [*joints, *(f"v_{name}" for name in joints)]
    assert [float(rows[0][name]) for name in joints] == pytest.approx(
        [0.0] * 3 + list(PANDA.home) + [0.04] * 2
    )
    times = [float(row["time"]) for row in rows]
    assert times == sorted(times)
    standing = [row for row in rows if row["part"] == "arm"]
    assert standing and {row["v_base_x"] for row in standing} == {"0.0"}
    where = {(row["base_x"], row["base_y"], row["base_yaw"]) for row in standing}
    assert len(where) == 2  # at the table, at the cupboard
    jump = max(
        abs(float(b[name]) - float(a[name]))
        for a, b in itertools.pairwise(rows)
        for name in (*BASE, *ARM)
    )
    assert jump < 0.2


def test_ros_messages_have_the_shape_of_joint_trajectories(
    stored_plan: Path, tmp_path: Path
) -> None:
    document = json.loads(exported(stored_plan, "ros", tmp_path))
    assert len(document["trajectories"]) >= 8
    for item in document["trajectories"]:
        message: dict[str, Any] = item["message"]
        assert set(message) == {"header", "joint_names", "points"}
        assert (
            message["joint_names"]
            == {"base": BASE, "arm": ARM, "gripper": FINGERS}[item["controller"]]
        )
        stamps = [
            point["time_from_start"]["sec"] + 1e-9 * point["time_from_start"]["nanosec"]
            for point in message["points"]
        ]
        assert stamps[0] == 0.0 and stamps == sorted(stamps)
        for point in message["points"]:
            assert (
                len(point["positions"]) == len(point["velocities"]) == len(message["joint_names"])
            )
            assert 0 <= point["time_from_start"]["nanosec"] < 10**9
    starts = [item["start"] for item in document["trajectories"]]
    assert starts == sorted(starts)


def test_without_out_it_goes_to_the_standard_output(
    stored_plan: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main([str(stored_plan)]) == 0
    assert json.loads(capsys.readouterr().out)["format"] == "tamp-trajectory"


def spoilt(plan: Path, folder: Path, **changes: Any) -> Path:
    document = json.loads(plan.read_text(encoding="utf-8")) | changes
    file = folder / "spoilt.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    return file


def test_bad_input_is_one_line_and_exit_code_two(
    stored_plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    broken = tmp_path / "broken.json"
    broken.write_text('{"format": "tamp-plan", "version"', encoding="utf-8")
    symbolic = tmp_path / "symbolic.json"
    symbolic.write_text('{"format": "tamp-symbolic-plan", "version": 1}', encoding="utf-8")
    cases = [
        (
            [str(stored_plan), "--format", "rso"],
            "unknown format 'rso'. Choices: json, csv, ros. Did you mean 'ros'?",
        ),
        ([str(tmp_path / "none.json")], "no such file"),
        ([str(broken)], "broken.json:1:"),
        ([str(symbolic)], "has no scene and no motion"),
        ([str(spoilt(stored_plan, tmp_path, version=7))], "version 7 is not known, only 1"),
        ([str(stored_plan), "--out", str(tmp_path)], "the output is a folder"),
    ]
    for words, expected in cases:
        assert main(words) == 2
        said = capsys.readouterr().err
        assert expected in said and said.count("\n") == 1


def test_a_plan_whose_problem_changed_is_refused(
    stored_plan: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan, problem = moved(stored_plan, tmp_path)
    assert main([str(plan), "--out", str(tmp_path / "out.json")]) == 0
    problem.write_text(problem.read_text(encoding="utf-8") + "# changed\n", encoding="utf-8")
    assert main([str(plan)]) == 2
    said = capsys.readouterr().err
    assert (
        f"the problem {problem} is not the one that the plan was made from. Plan again with tamp-solve"
        in said
    )
    with pytest.raises(Exception, match="is not the one that the plan was made from"):
        open_plan(plan)
    problem.unlink()
    assert main([str(plan), "--out", str(tmp_path / "out.json")]) == 0  # trajectories need no scene
