"""The words of tamp-solve: what goes together, and what is of no use to a kind of problem."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from tamp.commands.solve_options import Budget, parsed
from tamp.errors import InputError


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--html x.html", "--html is for problems with a scene; one in PDDL has none"),
        ("--record", "--record is for problems with a scene; one in PDDL has none"),
        ("--why", "--why is for problems with a scene and streams"),
        ("--execute", "--execute is for problems with a scene; a plan of PDDL alone has no motion"),
        ("--optimize --search eager", "--optimize has searches of its own"),
        ("--optimize --jobs 2", "--optimize improves a problem in PDDL in one process"),
    ],
)
def test_options_that_are_of_no_use_to_a_problem_in_pddl(words: str, said: str) -> None:
    with pytest.raises(InputError) as error:
        parsed(["domain.pddl", "problem.pddl", *words.split()])
    assert str(error.value).startswith(said)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("", "PROBLEM"),
        ("a.pddl b.yaml c.yaml", "expected [DOMAIN] PROBLEM, found 3 files"),
        ("scene.yaml --search astar", "--search and --heuristic are for problems in PDDL"),
        ("scene.yaml --heuristic ff", "--search and --heuristic are for problems in PDDL"),
        ("scene.yaml --optimize --algorithm incremental", "--optimize has searches of its own"),
        ("scene.yaml --time 0", "--time: the time must be positive, not 0"),
        ("scene.yaml --jobs 257", "--jobs: between 1 and 256 processes, not 257"),
        (f"scene.yaml --seed {2**64}", "--seed: the number must be below 2**64"),
        ("scene.yaml --grasp frictoin", "Did you mean 'friction'"),
        ("scene.yaml --planner omlp", "Did you mean 'ompl'"),
    ],
)
def test_what_does_not_go_together_is_refused(words: str, said: str) -> None:
    with pytest.raises(InputError) as error:
        parsed(words.split())
    assert said in str(error.value)


@pytest.mark.parametrize(
    "words",
    [
        "domain.pddl problem.pddl --search astar --heuristic lmcut",
        "domain.pddl problem.pddl --jobs 2",
        "scene.yaml --optimize --jobs 2",
        f"scene.yaml --seed {2**64 - 1} --jobs 256 --time 0.1",
    ],
)
def test_what_goes_together_is_read(words: str) -> None:
    assert parsed(words.split()).files[-1] == words.partition(" --")[0].split()[-1]


def test_the_last_file_says_which_kind_of_problem_it_is() -> None:
    assert parsed(["domain.pddl", "problem.pddl"]).is_pddl
    assert not parsed(["domain.pddl", "scene.yaml"]).is_pddl


def test_outputs_are_named_by_their_options() -> None:
    found = parsed(["scene.yaml", "--png", "a.png", "--statistics", "s.json"]).outputs
    assert found == {
        "--out": Path("plan.json"),
        "--html": None,
        "--png": Path("a.png"),
        "--video": None,
        "--statistics": Path("s.json"),
    }


@pytest.mark.parametrize(("now", "left"), [(102.0, 8.0), (104.9, 5.1), (109.0, 5.0)])
def test_half_of_the_time_is_left_however_long_loading_took(
    now: float, left: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(time, "monotonic", lambda: now)
    assert Budget(10.0, started=100.0).left() == pytest.approx(left)
