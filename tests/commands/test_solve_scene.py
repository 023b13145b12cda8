"""The steps of tamp-solve for a scene: what is judged, written, carried out and said, and when."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.commands import solve_scene as module
from tamp.commands.solve_options import Budget, parsed
from tamp.commands.solve_scene import follow_up, judge, plan, solve_scene, tell, write
from tamp.commands.solve_values import FollowUp, Judged, Planned, ReadyProblem, Request, Written
from tamp.errors import InputError
from tamp.plan.violation import Violation
from tamp.symbolic.algorithms.result import Outcome
from tamp.verification.report import Report

HOLDS = Report("p", (), 2, 0.0, 0, None, {}, (), 0.1)
FAILS = replace(HOLDS, violations=(Violation("goal", "it does not hold"),))


def solution(outcome: Outcome = Outcome.SOLVED) -> Any:
    return SimpleNamespace(outcome=outcome, solved=outcome is Outcome.SOLVED, statistics={})


class Said:
    """A progress that keeps its lines."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def begin(self, phase: str) -> None: ...

    def clear(self) -> None: ...

    def update(self, *_: object) -> None: ...

    def line(self, text: str) -> None:
        self.lines.append(text)


def request(*words: str) -> Request:
    return Request(parsed(["scene.yaml", *words]), {}, Budget(10.0, 0.0), Said())


LOADED = ReadyProblem(SimpleNamespace(classifiers={"near": object()}), SimpleNamespace, 0.5)


@pytest.fixture
def judged(monkeypatch: pytest.MonkeyPatch) -> list[object]:
    """What the judge was asked with; it says what is put in front."""
    answers: list[object] = [HOLDS]

    def judge_text(text: str, classifiers: object) -> object:
        assert text == "text of the plan" and classifiers is LOADED.problem.classifiers
        answers.append(text)
        return answers[0]

    monkeypatch.setattr(module, "plan_text", lambda found: "text of the plan")
    monkeypatch.setattr(module, "judge_text", judge_text)
    return answers


@pytest.mark.parametrize("verdict", [HOLDS, FAILS])
def test_a_plan_is_judged_where_that_is_wanted(judged: list[object], verdict: Report) -> None:
    judged[0] = verdict
    found = judge(request("--verify"), LOADED, Planned(solution(), False))
    assert found == Judged(verdict, verdict.holds)


def test_nothing_is_judged_where_nobody_asked_or_nothing_is_there(judged: list[object]) -> None:
    timeout = solution(Outcome.TIMEOUT)
    assert judge(request(), LOADED, Planned(solution(), False)) == Judged(None, True)
    assert judge(request("--verify"), LOADED, Planned(solution(), True)) == Judged(None, True)
    assert judge(request("--verify"), LOADED, Planned(timeout, False)) == Judged(None, False)
    assert len(judged) == 1


def planned_with(
    monkeypatch: pytest.MonkeyPatch,
    asked: bool,
    outcome: Outcome,
    *words: str,
    record: bool = False,
) -> tuple[Planned, dict[str, Any]]:
    """The end of planning, and how it was asked for."""
    got: dict[str, Any] = {}

    def solve_parallel(problem: object, **how: Any) -> Any:
        got.update(how)
        return solution(outcome)

    monkeypatch.setattr(module, "solve_parallel", solve_parallel)
    monkeypatch.setattr(module.guard, "asked", lambda: asked)
    return plan(request(*words), LOADED, record), got


def test_who_was_interrupted_is_stopped_and_keeps_what_was_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for asked, outcome in ((True, Outcome.SOLVED), (False, Outcome.INTERRUPTED)):
        planned, _ = planned_with(monkeypatch, asked, outcome)
        assert planned.stopped and planned.solution.outcome is outcome
    assert not planned_with(monkeypatch, False, Outcome.SOLVED)[0].stopped


def test_options_reach_the_planner(monkeypatch: pytest.MonkeyPatch, judged: list[object]) -> None:
    _, how = planned_with(monkeypatch, False, Outcome.SOLVED)
    assert how["accept"] is None and how["improved"] is None and not how["record"]
    assert planned_with(monkeypatch, False, Outcome.SOLVED, record=True)[1]["record"]
    words = ("--verify", "--optimize", "--seed", "7", "--jobs", "3")
    _, how = planned_with(monkeypatch, False, Outcome.SOLVED, *words)
    assert (how["seed"], how["jobs"]) == (7, 3) and how["improved"] is not None
    assert how["accept"](solution())
    judged[0] = FAILS
    assert not how["accept"](solution())


def written_by(
    monkeypatch: pytest.MonkeyPatch,
    judged: Judged,
    *words: str,
    add: Callable[..., None] | None = None,
) -> Written:
    loaded = SimpleNamespace(domain_name="cupboard")
    monkeypatch.setattr(module, "write_plan", lambda found, out: out)
    monkeypatch.setattr(module, "add_statistics", add or (lambda *_: pytest.fail("not wanted")))
    return write(request("--out", "p.json", *words), loaded, Planned(solution(), False), judged)


def test_only_a_plan_that_holds_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    assert written_by(monkeypatch, Judged(HOLDS, True)) == Written(Path("p.json"), None)
    assert written_by(monkeypatch, Judged(FAILS, False)) == Written(None, None)


def test_statistics_that_cannot_be_kept_lose_no_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    error, added = InputError("full"), list[tuple[object, ...]]()

    def refuse(*what: object) -> None:
        raise error

    words = ("--statistics", "s.json")
    assert written_by(monkeypatch, Judged(None, True), *words, add=refuse) == Written(
        Path("p.json"), error
    )
    kept = written_by(monkeypatch, Judged(None, False), *words, add=lambda *w: added.append(w))
    assert kept == Written(None, None) and added == [(Path("s.json"), "cupboard", {})]


@pytest.fixture
def executed(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The plans that are carried out."""
    from tamp.execution import command

    plans: list[Path] = []

    def carry_out(plan: Path, how: object, registry: object) -> str:
        plans.append(plan)
        return "executed"

    monkeypatch.setattr(command, "carry_out", carry_out)
    return plans


def test_only_a_written_plan_is_carried_out(executed: list[Path]) -> None:
    here, nowhere = Written(Path("p.json"), None), Written(None, None)
    asked, going, stopped = (
        request("--execute"),
        Planned(solution(), False),
        Planned(solution(), True),
    )
    assert follow_up(asked, LOADED, going, here) == FollowUp(None, "executed")
    for wanted, planned, written in (
        (request(), going, here), (asked, stopped, here), (asked, going, nowhere),
    ):  # fmt: skip
        assert follow_up(wanted, LOADED, planned, written) == FollowUp(None, None)
    assert executed == [Path("p.json")]


def test_a_reason_is_looked_for_where_there_is_no_plan(monkeypatch: pytest.MonkeyPatch) -> None:
    from tamp.planner.suggestions import why

    monkeypatch.setattr(why, "suggest_changes", lambda *_, **__: "because")
    monkeypatch.setattr(module, "summary", lambda *_: "no plan")
    nothing, timeout = Written(None, None), solution(Outcome.TIMEOUT)
    asked = request("--why")
    assert follow_up(asked, LOADED, Planned(timeout, False), nothing).why == "because"
    assert isinstance(asked.shown, Said) and "looking for changes" in asked.shown.lines[0]
    for wanted, planned in (
        (request(), Planned(timeout, False)), (asked, Planned(timeout, True)),
        (asked, Planned(solution(), False)),
    ):  # fmt: skip
        assert follow_up(wanted, LOADED, planned, nothing).why is None


def test_the_document_has_what_was_done(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(module, "summary_document", lambda found: {"outcome": "solved"})
    done = SimpleNamespace(json=lambda: "done")
    planned = Planned(solution(), False)

    tell(
        request("--json"),
        LOADED,
        planned,
        Judged(None, True),
        Written(None, None),
        FollowUp(None, None),
    )
    assert json.loads(capsys.readouterr().out) == {"outcome": "solved", "plan": None}
    written = Written(Path("p.json"), None)
    tell(request("--json"), LOADED, planned, Judged(HOLDS, True), written, FollowUp(done, done))
    said = json.loads(capsys.readouterr().out)
    assert said["plan"] == "p.json" and said["verification"]["holds"] is True
    assert said["why"] == said["execution"] == "done"


def outcome_of(monkeypatch: pytest.MonkeyPatch, *words: str, **steps: Any) -> bool | None:
    """What the command returns when its steps end as they are told to."""
    given: dict[str, Any] = {
        "load": LOADED, "plan": Planned(solution(), False), "judge": Judged(None, True),
        "write": Written(Path("p.json"), None), "follow_up": FollowUp(None, None), "tell": None,
        "show": None, **steps,
    }  # fmt: skip
    for name, value in given.items():
        monkeypatch.setattr(module, name, lambda *_, value=value: value)
    return solve_scene(request(*words))


def test_the_command_succeeds_with_a_plan_that_holds_and_reaches_the_goal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    assert outcome_of(monkeypatch) is True
    assert outcome_of(monkeypatch, judge=Judged(FAILS, False)) is False
    for reached in (True, False):
        execution = SimpleNamespace(reached=reached)
        assert outcome_of(monkeypatch, follow_up=FollowUp(None, execution)) is reached


def test_an_interrupted_command_has_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted = Planned(solution(Outcome.INTERRUPTED), True)
    assert outcome_of(monkeypatch, plan=interrupted, judge=Judged(None, False)) is None
    stopped = Planned(solution(), True)
    assert outcome_of(monkeypatch, plan=stopped) is True  # its plan was found and is written
    assert outcome_of(monkeypatch, "--verify", plan=stopped) is None


def test_statistics_are_complained_of_when_all_else_is_done(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    written = Written(Path("p.json"), InputError("full"))
    with pytest.raises(InputError, match="full"):
        outcome_of(monkeypatch, write=written)


def test_an_unknown_algorithm_is_refused_before_anything_is_loaded(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "load", lambda *_: pytest.fail("too late"))
    with pytest.raises(InputError, match=r"unknown algorithm 'adaptiv'.*Did you mean 'adaptive'"):
        solve_scene(request("--algorithm", "adaptiv"))
