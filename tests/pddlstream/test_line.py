"""The benchmark's blocks on a line: plans without overlap, and a check that sees one."""

from __future__ import annotations

import pytest

from benchmarks.line import holds, make
from tamp.pddlstream import Action, solve


@pytest.mark.parametrize("seed", range(3))
def test_two_blocks_come_to_the_red_region(seed: int) -> None:
    problem = make(2, seed)
    solution = solve(problem, max_time=20.0, seed=seed)
    assert solution.plan is not None
    assert holds(solution.plan, problem)


def test_overlaps_and_blocks_left_behind_are_seen() -> None:
    problem = make(2, 0)
    at = {fact[1]: fact[2] for fact in problem.init if fact[0] == "AtPose"}
    carry = [
        Action(name, (block, pose, None))
        for block in at
        for name, pose in (("pick", at[block]), ("place", 6.0))
    ]
    assert not holds(carry, problem)
    carry[-1] = Action("place", ("b1", 7.2, None))
    assert holds(carry, problem)
    assert not holds(carry[:2], problem)


def test_a_generator_goes_before_a_test_of_what_another_one_gives() -> None:
    """Poses drawn for the ground could be in the red region as far as anybody knows: that is not tried first."""
    solution = solve(make(4, 0), max_time=20.0)
    assert solution.solved
    assert solution.statistics["test-region"].calls <= 8
    assert (
        solution.effort.skeletons <= 4
    )  # that no block is there already is learned at once, not one by one
