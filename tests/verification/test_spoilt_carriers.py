"""Plans by learned relations, spoilt on purpose: support removed or elsewhere, out of order, a forged certificate."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

import tamp
from benchmarks.spoilt_carriers import SPOIL, forged, spoilt
from grounding.registry import GROUNDINGS
from tamp.plan.write import plan_document
from tamp.planner.problem import Problem, load_problem
from tamp.verification.verify import verify

pytestmark = pytest.mark.slow

Made = tuple[Problem, dict[str, Any]]


@pytest.fixture(scope="module", params=["set_table", "stack_learned", "pack_learned", "tray"])
def made(request: pytest.FixtureRequest) -> Made:
    """A problem and a plan of it."""
    problem = load_problem(request.param, registry=GROUNDINGS)
    solution = tamp.solve(problem, max_time=60.0, seed=0)
    assert solution.solved, solution.explanation
    return problem, json.loads(json.dumps(plan_document(solution)))


def test_what_is_spoilt_is_rejected(made: Made) -> None:
    problem, plan = made
    assert verify(plan, classifiers=problem.classifiers).holds
    tried: list[str] = []
    for kind in SPOIL:
        for seed in range(2):
            copied = spoilt(plan, kind, np.random.default_rng(seed))
            if copied is not None:
                tried.append(kind)
                assert not verify(copied, classifiers=problem.classifiers).holds, (kind, seed)
    assert {*tried} >= {
        "set_table": {"support left out", "support elsewhere"},
        "stack_learned": {"support left out", "support elsewhere", "out of order"},
        "pack_learned": {"support elsewhere"},
        "tray": {"tilted", "left behind", "support left out", "support elsewhere"},
    }[problem.name]


def test_a_forged_certificate_of_a_learned_relation_is_denied(made: Made) -> None:
    problem, plan = made
    wanted = [one for one in problem.classifiers if f"({one} " in plan["goal"]]
    if not wanted:  # the tray
        assert forged(plan, 0, 60.0) is None
        return
    false = forged(plan, 0, 60.0)
    assert false is not None
    judged = verify(false, classifiers=problem.classifiers)
    kinds = {one.kind for one in judged.violations}
    assert not judged.holds and kinds == {"certified", "goal"}, judged.text()
    assert f"the classifier of '{wanted[0]}' denies it" in judged.text()

    trusted = verify(false)
    assert not trusted.checked and wanted[0] in trusted.on_trust
