"""One seed, one plan: in one process and in two, whatever the order of sets."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tamp.symbolic.algorithms.result import Outcome
from tests.symbolic.algorithms.test_fluents import Corridor
from tests.symbolic.algorithms.test_pick_and_place import crowded
from tests.symbolic.algorithms.toys import ALGORITHMS, plan_text, solve


def plans(algorithm: str, seed: int) -> str:
    """Two plans with their values, and how much work they were."""
    results = [
        solve(algorithm, crowded(1).problem("(on a0 slot0)"), seed=seed),
        solve(algorithm, Corridor(2, goes_on=True).problem("(holding b)"), seed=seed),
    ]
    assert all(result.outcome is Outcome.SOLVED for result in results)
    return "\n".join(
        f"{plan_text(r)} {r.outcome} {r.effort.draws} {r.effort.expanded}" for r in results
    )


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_same_seed_same_plan_in_one_process(algorithm: str) -> None:
    assert plans(algorithm, 3) == plans(algorithm, 3)


def test_other_seeds_other_values() -> None:
    assert len({plans("adaptive", seed) for seed in range(3)}) == 3


@pytest.mark.parametrize("algorithm", ALGORITHMS)
def test_same_seed_same_plan_in_two_processes(algorithm: str, root: Path) -> None:
    code = f"from tests.symbolic.algorithms.test_determinism import plans; print(plans({algorithm!r}, 3))"
    texts = []
    for hash_seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": hash_seed, "PYTHONPATH": str(root)}
        run = subprocess.run(
            [sys.executable, "-c", code],
            cwd=root,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        texts.append(run.stdout.strip())
    assert texts[0] == texts[1]
    assert texts[0] == plans(algorithm, 3)
