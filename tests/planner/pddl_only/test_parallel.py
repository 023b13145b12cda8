"""A portfolio of searches: which, and what comes of the first that answers."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tamp.commands.solve import SOLVED, run
from tamp.planner.pddl_only import parallel as module
from tamp.planner.pddl_only.parallel import SATISFICING_SEARCHES, portfolio, solve_symbolic_parallel
from tamp.planner.pddl_only.problem import SymbolicProblem
from tamp.planner.pddl_only.solve import SymbolicSolution
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.search.operators import NO_FACTS
from tamp.system.race import RaceResult


def test_several_searches_at_a_time_give_the_plan_of_one(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["d.pddl", "p.pddl", "--jobs", "3", "--json", "--verify"]) == SOLVED
    document = json.loads(capsys.readouterr().out)
    named = document["statistics"]
    assert (named["search"], named["heuristic"]) in portfolio(None, None, 3)
    again = [
        "d.pddl",
        "p.pddl",
        "--search",
        named["search"],
        "--heuristic",
        named["heuristic"],
        "--json",
    ]
    assert run(again) == SOLVED
    assert json.loads(capsys.readouterr().out)["actions"] == document["actions"]


def test_searches_beside_an_optimal_one_are_optimal(
    files: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pairs = portfolio("astar", None, 9)
    assert (
        pairs[0] == ("astar", "lmcut")
        and len(pairs) > 2
        and all(search == "astar" for search, _ in pairs)
    )
    assert run(["d.pddl", "p.pddl", "--jobs", "2", "--search", "astar"]) == SOLVED
    assert "(optimal)" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("asked", "jobs", "expected"),
    [
        ((None, None), 1, [("greedy", "ff+landmarks")]),
        ((None, None), 3, [("greedy", "ff+landmarks"), ("wastar", "ff+landmarks"), ("eager", "ff")]),
        (("eager", "ff"), 9, [("eager", "ff"), *SATISFICING_SEARCHES[:2], *SATISFICING_SEARCHES[3:]]),
        (("astar", "blind"), 9, [("astar", "blind"), ("astar", "lmcut"), ("astar", "hmax")]),
        (("astar", "hadd"), 2, [("astar", "hadd"), SATISFICING_SEARCHES[0]]),
    ],
)  # fmt: skip
def test_what_is_asked_for_is_first_and_the_others_promise_as_much(
    asked: tuple[str | None, str | None], jobs: int, expected: list[tuple[str, str]]
) -> None:
    assert portfolio(*asked, jobs) == expected


def test_one_job_is_the_search_itself_in_this_process(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "race", lambda *_: pytest.fail("there is nothing to race"))
    alone = solve_symbolic_parallel(errands, jobs=1, search="astar", heuristic=None, max_time=20.0)
    assert alone.solved and alone.optimal and alone.cost == 15.0


def raced(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch, race: Callable[..., Any]
) -> SymbolicSolution:
    monkeypatch.setattr(module, "race", race)
    return solve_symbolic_parallel(errands, jobs=2, search=None, heuristic=None, max_time=20.0)


def test_only_a_plan_or_a_proof_ends_the_race(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    def race(members: list[Any], ends: Callable[..., bool], deadline: Any) -> RaceResult:
        assert len(members) == 2
        said = {outcome: ends(0, {"outcome": outcome}) for outcome in Outcome}
        assert {outcome for outcome in said if said[outcome]} == {
            Outcome.SOLVED,
            Outcome.INFEASIBLE,
        }
        return RaceResult(1, members[1](lambda told: None))

    solution = raced(errands, monkeypatch, race)
    assert solution.solved and solution.problem is errands
    assert (solution.search, solution.heuristic) == ("wastar", "ff+landmarks")
    drive = solution.plan[0]
    assert drive.name == "drive" and len(drive.arguments) == 3
    assert drive.positive == drive.added == NO_FACTS  # no more than a report reads


def test_a_race_that_nobody_ends_is_out_of_time_or_interrupted(
    errands: SymbolicProblem, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    nobody = raced(errands, monkeypatch, lambda *_: None)
    assert nobody.outcome is Outcome.TIMEOUT and nobody.search == "greedy"
    assert raced(errands, monkeypatch, interrupted).outcome is Outcome.INTERRUPTED
