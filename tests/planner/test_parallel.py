"""Planning by several processes: whose plan counts, and what ends the race."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.plan.write import plan_text
from tamp.planner import parallel as module
from tamp.planner.parallel import solve_parallel
from tamp.planner.problem import load_problem
from tamp.planner.solution import Action, Solution
from tamp.planner.solve import solve
from tamp.planner.timed_trajectories import Trajectory
from tamp.symbolic.algorithms.result import Outcome, SearchStatistics
from tamp.system.deadline import Deadline
from tamp.system.race import SEED_STRIDE, RaceResult, member_seed


def test_two_processes_improve_and_the_best_plan_of_both_is_kept() -> None:
    told: list[Solution] = []
    solution = solve_parallel(
        load_problem("one_object"), jobs=2, max_time=4.0, improved=told.append
    )
    assert solution.solved and {plan.seed for plan in told} <= {0, 1000}
    assert solution.duration == min(plan.duration for plan in told)


def test_whoever_wins_its_seed_makes_the_plan_again() -> None:
    problem = load_problem("one_object")
    won = solve_parallel(problem, jobs=2, seed=5, accept=lambda solution: solution.seed != 5)
    assert won.solved and won.seed == member_seed(5, 1) == 5 + SEED_STRIDE
    alone = solve(load_problem("one_object"), seed=won.seed)
    assert (
        plan_text(won).partition('"statistics"')[0] == plan_text(alone).partition('"statistics"')[0]
    )


def test_a_proof_of_infeasibility_is_an_answer() -> None:
    solution = solve_parallel(load_problem("impossible_size"), jobs=2, max_time=30.0)
    assert not solution.solved and "pitcher" in "\n".join(solution.explanation)


def plan_of(
    cost: float, outcome: Outcome = Outcome.SOLVED, seed: int = 0, problem: Any = None
) -> Solution:
    action = Action("move", (), (), Trajectory(()), 0.0, cost)
    plan = (action,) if outcome is Outcome.SOLVED else ()
    return Solution(problem, outcome, seed, "adaptive", plan)


PROBLEM: Any = SimpleNamespace()


class Raced:
    """A race in this process, run after run, that the first answer ends which may."""

    def __init__(self, interrupted: bool = False) -> None:
        self._interrupted = interrupted

    def __call__(self, members: Any, ends: Any, deadline: Any, hear: Any) -> RaceResult | None:
        for number, run in enumerate(members):
            answer = run(partial(hear, number))
            if ends(number, answer):
                return RaceResult(number, answer)
        if self._interrupted:
            raise KeyboardInterrupt
        return None


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """What `solve` was asked for; it answers with a plan whose seed and algorithm are those."""
    calls: list[dict[str, Any]] = []

    def solved(problem: Any, **options: Any) -> Solution:
        calls.append(options)
        return replace(plan_of(4.0, seed=options["seed"]), algorithm=options["algorithm"])

    monkeypatch.setattr(module, "solve", solved)
    monkeypatch.setattr(module, "prepare_loops", lambda: None)
    return calls


def test_one_job_is_a_run_in_this_process(
    asked: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "race", lambda *_: pytest.fail("there is nothing to race"))
    found = solve_parallel(PROBLEM, jobs=1, max_time=7.0, seed=3, algorithm="incremental")
    (options,) = asked
    assert found.seed == 3
    assert (options["seed"], options["algorithm"], options["max_time"]) == (3, "incremental", 7.0)


def test_each_run_has_its_seed_and_the_third_another_algorithm(
    asked: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "race", Raced())
    solve_parallel(PROBLEM, jobs=4, seed=3, accept=lambda plan: False)
    assert [one["seed"] for one in asked] == [member_seed(3, number) for number in range(4)]
    algorithms = [one["algorithm"] for one in asked]
    assert algorithms == ["adaptive", "adaptive", "incremental", "adaptive"]
    assert [one["progress"] is None for one in asked] == [False, True, True, True]


def ending(number: int, outcome: Outcome, *, good: bool = True, optimizing: bool = False) -> bool:
    settings = module._Settings(PROBLEM, 0, "adaptive", None, False, optimizing)
    return module._ends(settings, number, {"good": good, "parts": {"outcome": outcome}})


@pytest.mark.parametrize("number", [0, 1])
def test_a_good_plan_or_a_proof_ends_the_race_whoever_has_it(number: int) -> None:
    for outcome in (Outcome.SOLVED, Outcome.INFEASIBLE):
        assert ending(number, outcome)
    assert not ending(number, Outcome.SOLVED, good=False)
    assert not ending(number, Outcome.SOLVED, optimizing=True)
    assert not ending(number, Outcome.TIMEOUT)


@pytest.mark.parametrize("outcome", [Outcome.EXHAUSTED, Outcome.INTERRUPTED, Outcome.INFEASIBLE])
def test_the_first_run_ends_it_without_a_plan_too(outcome: Outcome) -> None:
    assert ending(0, outcome) and ending(0, outcome, optimizing=True)
    assert ending(1, outcome) is (outcome is Outcome.INFEASIBLE)


@pytest.mark.parametrize(
    ("solution", "accepts", "optimizing", "good"),
    [
        (plan_of(1.0), False, False, False),
        (plan_of(1.0), True, False, True),
        (plan_of(1.0), None, False, True),
        (plan_of(1.0), False, True, True),  # the best of all is looked at later
        (plan_of(1.0, Outcome.INFEASIBLE), False, False, True),
    ],
)
def test_only_a_plan_of_a_race_is_shown_to_who_accepts_it(
    solution: Solution, accepts: bool | None, optimizing: bool, good: bool,
    monkeypatch: pytest.MonkeyPatch,
) -> None:  # fmt: skip
    accept = None if accepts is None else lambda plan: bool(accepts)
    settings = module._Settings(PROBLEM, 0, "adaptive", accept, False, optimizing)
    monkeypatch.setattr(module, "_planned", lambda *_: solution)
    answer = module._member(settings, Deadline(9.0), 1, lambda told: None)
    assert answer["good"] is good
    assert Solution(problem=solution.problem, **answer["parts"]) == solution
    assert "problem" not in answer["parts"]


def test_the_best_plan_of_all_that_are_told_is_kept() -> None:
    kept: list[float] = []
    settings = module._Settings(PROBLEM, 0, "adaptive", None, False, True)
    best = module._Best(settings, None, lambda plan: kept.append(plan.cost))
    for number, cost in ((0, 5.0), (1, 4.0), (0, 4.5), (2, 3.0)):
        best.hear(number, module._parts(plan_of(cost)))
    assert kept == [5.0, 4.0, 3.0]
    assert best.plan is not None and best.plan.cost == 3.0 and best.plan.problem is PROBLEM

    deaf = module._Best(settings, None, None)
    deaf.hear(0, module._parts(plan_of(5.0)))
    assert deaf.plan is None


def test_progress_is_passed_on_and_told_seldom(monkeypatch: pytest.MonkeyPatch) -> None:
    now, told, heard = [100.0], [], []
    monkeypatch.setattr(module.time, "monotonic", lambda: now[0])
    say = module._seldom(told.append)
    for step in (0.0, 0.04, 0.04, 0.04, 0.2):
        now[0] += step
        say(SearchStatistics(draws=len(told)))
    assert [one.draws for one in told] == [0, 1, 2]

    settings = module._Settings(PROBLEM, 0, "adaptive", None, False, False)
    module._Best(settings, heard.append, None).hear(0, told[1])
    module._Best(settings, None, None).hear(0, told[1])
    assert heard == [told[1]]


def test_a_race_that_nobody_ends_is_out_of_time_or_interrupted(
    asked: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    for interrupted, outcome in ((False, Outcome.TIMEOUT), (True, Outcome.INTERRUPTED)):
        monkeypatch.setattr(module, "race", Raced(interrupted=interrupted))
        found = solve_parallel(PROBLEM, jobs=2, seed=3, accept=lambda plan: False)
        assert found.outcome is outcome and found.plan == () and found.seed == 3


def test_an_interruption_keeps_the_best_plan(
    asked: list[dict[str, Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def optimized(problem: Any, *, seed: int, improved: Any, **_: Any) -> Solution:
        improved(plan_of(9.0 - seed / 1000, seed=seed))
        return plan_of(1.0)

    monkeypatch.setattr(module, "optimize", optimized)
    monkeypatch.setattr(module, "race", Raced(interrupted=True))
    found = solve_parallel(PROBLEM, jobs=2, improved=lambda plan: None)
    assert found.solved and found.cost == 8.0 and found.problem is PROBLEM
