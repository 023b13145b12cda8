"""The benchmark's classical domains, small: every search solves them, A* at the least cost."""

from __future__ import annotations

from random import Random

import pytest

from benchmarks.classical_domains import GENERATORS
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.plan_trace import trace
from tamp.symbolic.search.search import Reason, search
from tests.symbolic.search.interpreter import Interpreter

SIZES = {
    "blocks": 3,
    "logistics": 2,
    "gripper": 3,
    "rovers": 1,
    "satellite": 2,
    "depot": 2,
    "miconic": 2,
    "network": 4,
}


@pytest.mark.parametrize("name", GENERATORS)
def test_small_tasks_are_solved_and_optimally(name: str) -> None:
    solved = 0
    for seed in range(3):
        domain, problem = GENERATORS[name](SIZES[name], Random(seed))
        task = parse_task(problem, parse_domain(domain))
        interpreter = Interpreter(task)
        instantiated = instantiate(task)
        best = interpreter.best(20_000)
        for method, heuristic in (
            ("astar", "lmcut"),
            ("greedy", "ff+landmarks"),
            ("wastar", "ff"),
            ("eager", "hadd"),
        ):
            result = search(instantiated, search=method, heuristic=heuristic)
            if best is None:
                assert result.reason is Reason.UNSOLVABLE
                continue
            assert result.plan is not None
            cost = interpreter.run((o.name, o.arguments) for o in result.plan.operators)
            assert cost == best if method == "astar" else cost >= best
            assert len(trace(instantiated, result.plan.operators).steps) == len(
                result.plan.operators
            )
            solved += 1
    assert solved >= 4
