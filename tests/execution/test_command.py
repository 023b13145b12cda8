"""tamp-execute as a user meets it: exit codes, JSON, one clear error for each bad input."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from tamp.commands.solve import execute, run


def exit_of(*words: str) -> int:
    with pytest.raises(SystemExit) as end:
        execute(list(words))
    return int(end.value.code or 0)


def copy(plan_file: Path, folder: Path, **changed: object) -> Path:
    document = json.loads(plan_file.read_text(encoding="utf-8")) | changed
    (folder / "plan.json").write_text(json.dumps(document), encoding="utf-8")
    return folder / "plan.json"


def test_a_plan_that_works_exits_with_0(
    plan_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_of(str(plan_file), "--json", "--grasp", "constraint") == 0
    document = json.loads(capsys.readouterr().out)
    assert document["format"] == "tamp-execution" and document["reached"] is True
    assert len(document["actions"]) == 4 and document["grasp"] == "constraint"


def test_a_goal_that_is_missed_exits_with_1(
    plan_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_of(str(plan_file), "--disturb", "object-dropped") == 1
    said = capsys.readouterr().out
    assert (
        "is dropped" in said
        and "lost: Can is not in the hand" in said
        and "Goal not reached" in said
    )


def test_solve_can_execute(
    plan_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    problem = plan_file.with_name("short_way.yaml")
    assert (
        run([str(problem), "--seed", "1", "--execute", "--out", str(tmp_path / "plan.json")]) == 0
    )
    assert "Goal reached" in capsys.readouterr().out
    assert run(["d.pddl", "p.pddl", "--execute"]) == 2
    assert "--execute is for problems with a scene" in capsys.readouterr().err
    assert run([str(problem), "--execute", "--grasp", "frictoin"]) == 2
    assert "Did you mean 'friction'?" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--disturb", "object-movd"], "unknown disturbance 'object-movd'. Choices: object-moved"),
        (["--grasp", "magnet"], "unknown grasp 'magnet'"),
        (["--time", "0"], "the time must be positive"),
        (["--problem", "nowhere.yaml"], "no such file: nowhere.yaml"),
    ],
)
def test_bad_options(
    plan_file: Path, words: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exit_of(str(plan_file), *words) == 2
    assert said in capsys.readouterr().err


def test_bad_plans(plan_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def error(file: Path) -> str:
        assert exit_of(str(file)) == 2
        said = capsys.readouterr().err
        assert said.count("\n") == 1
        return said

    assert "no such file" in error(tmp_path / "missing.json")
    assert "version 7 is not known" in error(copy(plan_file, tmp_path, version=7))
    (tmp_path / "plan.json").write_text("{ no json", encoding="utf-8")
    assert "plan.json:1:3: not JSON" in error(tmp_path / "plan.json")
    changed = copy(plan_file, tmp_path)
    problem = shutil.copy(plan_file.with_name("short_way.yaml"), tmp_path)
    document = json.loads(changed.read_text(encoding="utf-8"))
    document["inputs"]["problem"]["path"] = str(problem)
    changed.write_text(json.dumps(document), encoding="utf-8")
    Path(problem).write_text(Path(problem).read_text() + "# changed\n")
    assert "is not the one that the plan was made from" in error(changed)


def test_pauses_of_hours_are_left_out(
    plan_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = json.loads(plan_file.read_text(encoding="utf-8"))
    segment = next(one for one in plan["actions"][1]["segments"] if one["part"] == "arm")
    segment["times"].append(segment["times"][-1] + 20_000.0)
    segment["positions"].append(segment["positions"][-1])
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(plan), encoding="utf-8")
    assert exit_of(str(file), "--grasp", "constraint") == 0
    assert "19,990 s of pauses in the plan were left out" in capsys.readouterr().out
    segment["positions"][-1] = [angle * 0.999 for angle in segment["positions"][-1]]
    file.write_text(json.dumps(plan), encoding="utf-8")
    assert exit_of(str(file)) == 2
    assert "physics carries out at most 7,200 s" in capsys.readouterr().err
    segment["times"][-1] = -1.0
    file.write_text(json.dumps(plan), encoding="utf-8")
    assert exit_of(str(file)) == 2
    assert "do not increase" in capsys.readouterr().err


def test_motions_out_of_range_are_refused_at_once(
    plan_file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    document = json.loads(plan_file.read_text(encoding="utf-8"))
    arm = document["actions"][1]["segments"][0]
    arm["positions"] = [[5.0 * (-1) ** k] * 7 for k in range(200)]
    arm["times"] = [20.0 * k for k in range(200)]
    assert exit_of(str(copy(plan_file, tmp_path, actions=document["actions"]))) == 2
    assert "panda_joint1 is out of range: 5" in capsys.readouterr().err
