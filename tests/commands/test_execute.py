"""tamp-execute: what it asks for of the execution, how it ends and what it prints, without physics."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tamp.commands.execute import main
from tamp.errors import InputError
from tamp.execution import command
from tamp.execution.command import Options
from tamp.execution.report import Execution

REGISTRY: dict[str, Any] = {"on": {}}


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Path, Options]]:
    """What was asked for; plans by the name of `reached.json` reach their goal."""
    made: list[tuple[Path, Options]] = []

    def carry_out(file: Path, options: Options, registry: object) -> Execution:
        assert registry is REGISTRY
        if not file.name.endswith(".json"):
            raise InputError("no such file", file=file)
        made.append((file, options))
        return Execution("plan", options.grasp, options.seed, (), (), file.name == "reached.json")

    monkeypatch.setattr(command, "carry_out", carry_out)
    return made


def run(*words: str) -> int:
    return main(words, lambda: REGISTRY)


def test_what_is_said_reaches_the_execution(asked: list[tuple[Path, Options]]) -> None:
    words = "--grasp constraint --engine mujoco --replan --disturb object-moved --seed 7 --time 2.5"
    run("a.json", *words.split(), "--sampler", "on=x.py", "--problem", "p.yaml", "--quiet")
    run("b.json", "--quiet")
    said = Options(
        grasp="constraint",
        replan=True,
        disturb="object-moved",
        seed=7,
        time=2.5,
        problem=Path("p.yaml"),
        sampler=("on=x.py",),
        engine="mujoco",
    )
    assert asked == [(Path("a.json"), said), (Path("b.json"), Options())]


@pytest.mark.parametrize(("plan", "code"), [("reached.json", 0), ("missed.json", 1)])
def test_the_exit_status_says_whether_the_goal_holds(
    plan: str, code: int, asked: list[tuple[Path, Options]], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(plan) == code
    assert ("Goal reached" if code == 0 else "Goal not reached") in capsys.readouterr().out
    assert run(plan, "--json") == code
    assert json.loads(capsys.readouterr().out)["reached"] is (code == 0)
    assert run(plan, "--quiet") == code
    assert capsys.readouterr().out == ""


def test_bad_input_ends_with_2_and_one_line(
    asked: list[tuple[Path, Options]], capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("plan.yaml", "--quiet") == 2
    said = capsys.readouterr()
    assert "no such file" in said.err and said.err.count("\n") == 1 and said.out == ""
