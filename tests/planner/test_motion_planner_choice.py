from __future__ import annotations

from pathlib import Path

import pytest

import tamp
from tamp.errors import InputError
from tamp.geometric.motion import compiled_planner
from tamp.geometric.motion.planners import PLANNERS
from tamp.verification.verify import verify


@pytest.mark.parametrize("planner", PLANNERS)
def test_a_plan_by_either_planner_holds(planner: str, tmp_path: Path) -> None:
    problem = tamp.load_problem("one_object", planner=planner)
    solution = tamp.solve(problem, max_time=60, seed=1)
    assert solution.solved
    tamp.write_plan(solution, tmp_path / "plan.json")
    assert verify(tmp_path / "plan.json").holds


def test_ompl_is_asked_where_it_was_chosen(monkeypatch: pytest.MonkeyPatch) -> None:
    def unasked(*_: object, **__: object) -> None:
        raise AssertionError("the compiled planner was asked")

    monkeypatch.setattr(compiled_planner, "connect_compiled", unasked)
    monkeypatch.setattr("tamp.geometric.motion.arm.connect_compiled", unasked)
    monkeypatch.setattr("tamp.geometric.motion.base.connect_compiled", unasked)
    assert tamp.solve(tamp.load_problem("two_objects", planner="ompl"), max_time=60, seed=0).solved


def test_an_unknown_planner_is_refused_with_the_choices() -> None:
    with pytest.raises(InputError, match="unknown planner 'prm'") as caught:
        tamp.load_problem("one_object", planner="prm")
    assert set(PLANNERS) <= set(caught.value.choices)
