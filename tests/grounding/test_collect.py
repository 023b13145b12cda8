"""Demonstrations in problem files become a data set, or are refused with the file and the line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tamp
from grounding.cli import BAD_INPUT, DONE, run
from grounding.collect import Demonstration, collect, read_demonstrations, unstable
from grounding.dataset import read_dataset, write_dataset
from tests.grounding.shown import scene


@pytest.mark.parametrize("apart", [False, True])
def test_contradicting_demonstrations_are_refused_with_both_places(
    apart: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    goals = ["(and (flat jar table) (not (flat jar table)))"]
    goals = ["(flat jar table)", "(not (flat jar table))"] if apart else goals
    files = [scene(tmp_path / f"{number}.yaml", goal) for number, goal in enumerate(goals)]
    assert run(["collect", "flat", *map(str, files), "--out", str(tmp_path / "x.npz")]) == BAD_INPUT
    said = capsys.readouterr().err
    assert "'flat' is said to hold and not to hold in the same situation" in said
    assert said.count(".yaml:7:") == 2
    assert not (tmp_path / "x.npz").exists()
    scene(files[-1], "(not (flat jar table))", x=0.31)  # elsewhere it may be otherwise
    assert run(["collect", "flat", str(files[-1]), "--out", str(tmp_path / "x.npz")]) == DONE


def test_a_demonstration_that_hangs_is_warned_of_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = scene(tmp_path / "s.yaml", "(upright jar table)")
    path.write_text(path.read_text().replace("on: table, at: [-0.3, 0.1]", "at: [1.3, 0.1, 0.9]"))
    assert run(["collect", "upright", str(path), "--out", str(tmp_path / "x.npz")]) == DONE
    said = capsys.readouterr().err
    assert (
        f"warning: {path}:7:7: jar hangs 125 mm above the place (1 scene): no plan will put it down so"
        in said
    )


TRAY_SCENE = """robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0]}}
  tray:
    {{box: [0.3, 0.2, 0.02], on: table, at: [0.3, 0.0], surfaces: {{tray_top: {{at: [0, 0, 0.01], size: [0.3, 0.2]}}}}}}
  can: {{cylinder: {{radius: 0.033, height: 0.102}}, on: tray_top, at: [0.05, 0.02]}}
  jar: {{cylinder: {{radius: 0.03, height: 0.15}}, on: table, at: [-0.3, 0.1]}}
goal: {goal}
"""


def tray_scene(folder: Path, goal: str) -> Path:
    path = folder / "scene.yaml"
    path.write_text(TRAY_SCENE.format(goal=goal))
    return path


def test_goals_say_what_holds(tmp_path: Path) -> None:
    path = tray_scene(
        tmp_path, "(and (Stacked can tray_top) (not (stacked jar TABLE)) (on jar table))"
    )
    first, second = read_demonstrations("stacked", [path])
    assert (first.arguments, first.holds) == (("can", "tray_top"), True)
    assert (second.arguments, second.holds) == (("jar", "table"), False)
    data = collect("stacked", [first, second])
    assert data.relation == "stacked" and data.holds.tolist() == [True, False]
    write_dataset(tmp_path / "stacked.npz", data)
    again = read_dataset(tmp_path / "stacked.npz")
    assert [example.names for example in again] == [
        ("tray", "can", "table", "jar"),
        ("table", "jar", "tray", "can"),
    ]
    situation = again[0].situation
    assert np.allclose(
        situation.T_world_region, first.scene.world_pose(first.scene.surfaces["tray_top"]).matrix
    )
    assert np.allclose(situation.body.matrix, first.scene.bodies["can"].pose.matrix)


def test_bodies_of_one_name_and_two_shapes_are_told_apart(tmp_path: Path) -> None:
    one = next(iter(read_demonstrations("stacked", [tray_scene(tmp_path, "(stacked jar table)")])))
    text = (tmp_path / "scene.yaml").read_text().replace("height: 0.15", "height: 0.2")
    (tmp_path / "scene.yaml").write_text(text)
    other = next(iter(read_demonstrations("stacked", [tmp_path])))
    data = collect("stacked", [one, other])
    first, second = (example.situation.body.form.corners[1, 2] for example in data)
    assert (first, second) == pytest.approx((0.075, 0.1))
    assert {"jar", "jar#2", "table"} <= {*data.templates} and len(data.templates) == 5


def test_what_would_not_stay_is_warned_of(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tray_scene(tmp_path, "(and (stacked can tray_top) (stacked jar table))")
    path.write_text(
        path.read_text().replace("at: [-0.3, 0.1]", "at: [-0.3, 0.1], rpy: [90 deg, 0 deg, 0 deg]")
    )
    assert run(["collect", "stacked", str(path), "--out", str(tmp_path / "x.npz")]) == DONE
    said = capsys.readouterr().err.splitlines()
    face = f"warning: {path}:9:35: jar stands on none of its stable faces (1 scene): no plan will put it down so"
    assert face in said


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        ("(on jar table)", "scene.yaml:9: the goal says nothing of 'stacked'"),
        ("(stacked jar)", "a demonstration names a body, and a surface or container"),
        ("(stacked jra table)", "scene.yaml:9:16: unknown object 'jra'"),
        ("(stacked jar can)", "scene.yaml:9: 'can' is no surface or container"),
        ("(stacked table table)", "'table' is a part of 'table' itself"),
    ],
)
def test_what_is_wrong_with_a_demonstration(
    goal: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert (
        run(
            [
                "collect",
                "stacked",
                str(tray_scene(tmp_path, goal)),
                "--out",
                str(tmp_path / "x.npz"),
            ]
        )
        == BAD_INPUT
    )
    assert message in capsys.readouterr().err


def test_there_must_be_demonstrations(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(tamp.InputError, match="no demonstrations of 'stacked'"):
        collect("stacked", [])
    found = next(
        iter(read_demonstrations("stacked", [tray_scene(tmp_path, "(stacked jar table)")]))
    )
    with pytest.raises(tamp.InputError, match="'lamp' is no body"):
        collect("stacked", [Demonstration(found.scene, ("lamp", "table"))])
    (tmp_path / "empty").mkdir()
    assert run(["collect", "stacked", str(tmp_path / "empty")]) == BAD_INPUT
    assert "no .yaml files in this folder" in capsys.readouterr().err
    assert run(["train", "stacked"]) == BAD_INPUT
    assert "tamp-learn collect stacked FILES makes its data" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("height", "words"),
    [("0.72", None), ("0.60", "is sunk 120 mm into the place"), ("0.724", None)],
)
def test_what_is_sunk_is_warned_of_and_a_few_millimetres_are_not(
    height: str, words: str | None, tmp_path: Path
) -> None:
    """The jar is 0.15 m tall, so its middle is 0.075 m above its foot; the table is 0.72 m high."""
    path = tray_scene(tmp_path, "(stacked jar table)")
    at = f"at: [1.3, 0.1, {float(height) + 0.075}]"
    path.write_text(path.read_text().replace("on: table, at: [-0.3, 0.1]", at))
    said = unstable(collect("stacked", read_demonstrations("stacked", [path])))
    assert (
        said == []
        if words is None
        else [one.partition("jar ")[2] for one in said]
        == [f"{words} (1 scene): no plan will put it down so"]
    )
