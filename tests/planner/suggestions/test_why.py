"""--why names a change that makes a problem solvable, and each change is one that can be."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks.infeasible import named
from tamp.commands.solve import NO_PLAN, SOLVED, run
from tamp.planner.problem import Problem, load_problem
from tamp.planner.solution import Action, Solution
from tamp.planner.suggestions.changes import changes
from tamp.planner.suggestions.why import Suggestions, suggest_changes
from tamp.planner.timed_trajectories import Trajectory
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.result import Outcome
from tests.planner.suggestions.infeasible import BY_NAME, written


@pytest.mark.parametrize(
    ("kind", "change"),
    [
        ("start_too_high", "if board were 0.75 m high"),
        ("start_outside", "if far_table stood at"),
        ("fixed", "could be moved"),
        ("too_tall", "half its size"),
        ("two_places", "without the goal"),
        ("loaded", "without slab"),
    ],
)
def test_the_smallest_change(
    kind: str, change: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "plan.json"
    assert run([str(written(kind, tmp_path)), "--why", "--json", "--out", str(out)]) == NO_PLAN
    document = json.loads(capsys.readouterr().out)
    assert document["outcome"] == "infeasible" and not out.exists()
    found = document["why"]["relaxations"]
    assert any(change in one["change"] and one["actions"] >= 4 for one in found), document["why"]


def test_in_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert (
        run([str(written("loaded", tmp_path)), "--why", "--out", str(tmp_path / "plan.json")])
        == NO_PLAN
    )
    text = capsys.readouterr().out
    assert "It would be solvable without slab" in text and text.count("No plan") == 1


def test_nothing_is_asked_when_there_is_a_plan(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["one_object", "--why", "--json", "--out", str(tmp_path / "plan.json")]) == SOLVED
    assert "why" not in json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("kind", ["start_too_high", "too_wide", "fixed", "two_places"])
@pytest.mark.parametrize("seed", [3, 4])
def test_the_benchmark_names_causes_that_are_there(kind: str, seed: int) -> None:
    number, make = BY_NAME[kind]
    case = make(np.random.default_rng((number, seed)))
    assert not named(case, ("no plan in the time given",)) and not named(case, ())
    assert named(case, (" ".join(group[0] for group in case.cause),))


def outcomes(
    monkeypatch: pytest.MonkeyPatch, chance: dict[str, set[int]], spent: list[float]
) -> None:
    """Let planning succeed for the seeds that are given for a scene's lack of a body, or for the whole scene."""

    def solved(
        problem: Problem, *, max_time: float, seed: int, progress: object = None
    ) -> Solution:
        gone = next((name for name in chance if name and name not in problem.scene.bodies), "")
        spent.append(max_time)
        if seed in chance.get(gone, set()):
            action = Action("pick", (), (), Trajectory(()), 0.0, 1.0)
            return Solution(
                problem, Outcome.SOLVED, seed, "adaptive", plan=(action,), seconds={"total": 0.1}
            )
        return Solution(problem, Outcome.TIMEOUT, seed, "adaptive", seconds={"total": max_time})

    monkeypatch.setattr("tamp.planner.suggestions.why.solve", solved)


def asked(folder: Path, outcome: Outcome = Outcome.TIMEOUT) -> Suggestions:
    path = written("covered", folder, 2)
    problem = load_problem(path)
    solution = Solution(problem, outcome, 0, "adaptive", seconds={"total": 30.0})
    return suggest_changes(solution, lambda scene: load_problem(path, scene=scene), max_time=30.0)


def test_a_body_is_named_only_where_three_seeds_agree(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spent: list[float] = []
    outcomes(monkeypatch, {"monitor": {0, 1, 2}, "other_0": {0, 1}}, spent)
    found = asked(tmp_path)
    assert [one.text for one in found.suggestions] == ["without monitor"]
    assert ("without other_0", 2) in found.failed and len(set(spent)) == 1
    text = found.text()
    assert "It would be solvable without monitor" in text
    assert (
        "tried as well, and did not help: " in text
        and "without other_0 (helps with 2 of 3 seeds)" in text
    )


def test_luck_is_no_cause(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    outcomes(monkeypatch, {"monitor": {0, 1, 2}, "": {1}}, [])
    found = asked(tmp_path)
    assert found.suggestions == () and found.unchanged == (1,)
    assert (
        "With --seed 1 a plan is found as it is" in found.text()
        and "without monitor" not in found.text()
    )


def test_what_is_proven_needs_no_second_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    spent: list[float] = []
    outcomes(monkeypatch, {"monitor": {0, 1, 2}}, spent)
    found = asked(tmp_path, Outcome.INFEASIBLE)
    assert [one.text for one in found.suggestions] == ["without monitor"]
    assert len(spent) == 3 + len(found.failed)


def test_what_the_causes_are_about_is_tried_first_whatever_their_words_say(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = written("covered", tmp_path, 2)
    problem = load_problem(path)
    outcomes(monkeypatch, {}, [])
    tried: list[str] = []
    cause = Cause("other_0 says nothing of it", CauseKind.FAILED, ("monitor",))
    solution = Solution(problem, Outcome.INFEASIBLE, 0, "adaptive", causes=(cause,))
    suggest_changes(
        solution, lambda scene: load_problem(path, scene=scene), max_time=30.0, trying=tried.append
    )
    about = {change.text: change.about for change in changes(problem)}
    first = [text.removeprefix("trying ").rpartition(" (")[0] for text in tried]
    among = ["monitor" in about[text] for text in first if text in about]
    assert True in among and False in among and among == sorted(among, reverse=True)
