"""The same seed gives the same plan file, byte for byte but for the clock's readings."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tamp.plan.write import plan_text
from tamp.planner.problem import load_problem
from tamp.planner.solve import solve
from tamp.system.files import find_problem

SOLVE = str(Path(sys.executable).with_name("tamp-solve"))


def without_clock(text: str) -> str:
    """The file's text without the entry "timing", which stands last."""
    head, mark, timing = text.partition('\n "timing": {')
    assert mark and timing.count("{") == 0 and json.loads(text)["timing"]
    return head


def plan(name: str, seed: int = 0, algorithm: str = "adaptive") -> str:
    solution = solve(load_problem(name), max_time=60.0, seed=seed, algorithm=algorithm)
    assert solution.solved, solution.explanation
    return without_clock(plan_text(solution))


@pytest.mark.timeout(150)
@pytest.mark.parametrize(
    ("name", "seed", "algorithm"),
    [
        ("four_objects", 0, "adaptive"),
        ("swap", 1, "adaptive"),
        ("shelves", 2, "adaptive"),
        ("one_object", 0, "incremental"),
    ],
)
def test_twice_in_one_process(name: str, seed: int, algorithm: str) -> None:
    assert plan(name, seed, algorithm) == plan(name, seed, algorithm)


def test_twice_with_one_loaded_problem() -> None:
    """What a first run left in the problem's caches does not change the second."""
    problem = load_problem("two_objects")
    texts = []
    for seed in (0, 5, 0):
        solution = solve(problem, max_time=60.0, seed=seed)
        assert solution.solved
        texts.append(without_clock(plan_text(solution)))
    assert texts[0] == texts[2] != texts[1]


@pytest.mark.timeout(150)
@pytest.mark.parametrize(
    ("name", "algorithm"), [("four_objects", "adaptive"), ("one_object", "incremental")]
)
def test_in_two_processes(name: str, algorithm: str, tmp_path: Path) -> None:
    """With other hash seeds, working directories, names of the files' places and budgets."""
    texts = []
    for number, hash_seed in enumerate(("0", "4242")):
        folder = tmp_path / f"run{number}"
        folder.mkdir()
        problem = str(find_problem(name)) if number else name
        options = [
            "--algorithm",
            algorithm,
            "--time",
            f"{45 + 15 * number}",
            "--out",
            "plan.json",
            "--quiet",
        ]
        environment = {**os.environ, "PYTHONHASHSEED": hash_seed}
        done = subprocess.run(
            [SOLVE, problem, *options],
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=70,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        texts.append(without_clock((folder / "plan.json").read_text()))
    assert texts[0] == texts[1]
    assert texts[0] == plan(name, algorithm=algorithm), (
        "in this process, after other tests, it is the same plan"
    )


def test_other_seeds_give_other_plans() -> None:
    actions = {
        plan("one_object", seed).partition('"actions"')[2].partition('"statistics"')[0]
        for seed in range(3)
    }
    assert len(actions) == 3 and "" not in actions
