"""A robot whose making was interrupted: what was done is not done again, and the result is the same."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.commands.robot import main
from tamp.commands.robot_folder import kept_steps, make, spheres
from tamp.commands.robot_folder.kept_steps import kept
from tests.commands.robot_folder.urdf import write_arm


def never(*_: object) -> None:
    raise AssertionError("it was done already")


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(file.relative_to(folder)): file.read_bytes()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


def test_an_interrupted_run_goes_on_and_ends_the_same(
    quick: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    urdf = write_arm(tmp_path)
    words = ["make", str(urdf), "--arm", "foot", "tool", "--quiet", "--out"]
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "first"))
    assert main([*words, str(tmp_path / "whole" / "arm")]) == 0

    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "second"))
    done: list[int] = []
    cover = make.cover

    def interrupted(hull: object) -> object:
        if len(done) == 3:
            raise KeyboardInterrupt
        done.append(1)
        return cover(hull)

    with monkeypatch.context() as patch:
        patch.setattr(make, "cover", interrupted)
        assert main([*words, str(tmp_path / "half" / "arm")]) == 130
    assert not (tmp_path / "half" / "arm").exists()

    again: list[int] = []

    def counted(hull: object) -> object:
        again.append(1)
        return cover(hull)

    monkeypatch.setattr(make, "cover", counted)
    for step in ("table", "meetings", "misjudged", "home"):
        monkeypatch.setattr(make, step, never)
    assert main([*words, str(tmp_path / "half" / "arm")]) == 0
    assert contents(tmp_path / "half" / "arm") == contents(tmp_path / "whole" / "arm")

    fewer = len(again)
    assert fewer > 0
    again.clear()
    assert main([*words, str(tmp_path / "third" / "arm")]) == 0
    assert not again


def test_what_depends_on_something_else_is_computed_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path))
    one = {"a": np.arange(3.0)}
    assert kept("step", ("x", one["a"]), lambda: one)["a"].tolist() == [0.0, 1.0, 2.0]
    assert kept("step", ("x", one["a"]), never)["a"].tolist() == [0.0, 1.0, 2.0]
    other = {"a": np.zeros(1)}
    assert kept("step", ("x", one["a"] + 1e-12), lambda: other)["a"].tolist() == [0.0]
    assert kept("other", ("x", one["a"]), lambda: other)["a"].tolist() == [0.0]
    monkeypatch.setattr(spheres, "LEAVES", 3)
    assert kept("step", ("x", one["a"]), lambda: other)["a"].tolist() == [0.0]


def test_a_damaged_result_is_computed_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path))
    kept("step", 1, lambda: {"a": np.zeros(2)})
    (file,) = (tmp_path / "robots").iterdir()
    file.write_bytes(file.read_bytes()[:40])
    assert kept("step", 1, lambda: {"a": np.ones(2)})["a"].tolist() == [1.0, 1.0]
    assert kept("step", 1, never)["a"].tolist() == [1.0, 1.0]


def test_a_cache_that_cannot_be_written_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("no folder")
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "file"))
    assert kept("step", 1, lambda: {"a": np.zeros(2)})["a"].tolist() == [0.0, 0.0]


def test_every_step_s_module_counts() -> None:
    assert {module.__name__.rpartition(".")[2] for module in kept_steps.MODULES} == {
        "convex", "home", "reach_table", "self_collision", "spheres",
    }  # fmt: skip
