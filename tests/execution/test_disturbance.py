"""When a disturbance takes place: at moments that its kind allows, by seed."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.execution.disturbance import DISTURBANCES, schedule
from tamp.plan.read import PlanFile
from tests.plan.making import arm, base, close, let_go, plan_of

HOME = np.zeros(7)
DRIVE, CARRY = (
    base([0, 1], [[0, 0, 0], [1, 0, 0]]),
    base([0, 1], [[0, 0, 0], [1, 0, 0]], holding="cup"),
)
REACH = arm([0, 1], [HOME, HOME + 0.1])

PLAN = plan_of(
    ("move", (), [DRIVE]),
    ("pick", ("cup",), [REACH, close("cup"), REACH]),
    ("move", (), [CARRY]),
    ("place", ("cup",), [REACH, let_go("cup"), REACH]),
    ("move", (), [DRIVE]),
)


def moments(kind: str, plan: PlanFile = PLAN, count: int = 300) -> set[tuple[int, int]]:
    made = [schedule(kind, plan, np.random.default_rng(seed)) for seed in range(count)]
    return {(one.action, one.segment) for one in made if one is not None}


@pytest.mark.parametrize(
    ("kind", "possible"),
    [
        (
            "object-moved",
            {(0, 0), (1, 0), (1, 2), (2, 0), (3, 0), (3, 2), (4, 0)},
        ),  # never while fingers move
        ("object-removed", {(0, 0), (1, 0), (1, 2), (2, 0), (3, 0), (3, 2), (4, 0)}),
        ("object-dropped", {(2, 0)}),  # while the base drives with it
        ("grasp-slips", {(2, 0)}),
        ("surface-blocked", {(0, 0), (1, 0), (1, 2), (2, 0)}),  # before the last thing is put down
    ],
)
def test_each_kind_has_its_moments_and_all_of_them_come_up(
    kind: str, possible: set[tuple[int, int]]
) -> None:
    assert moments(kind) == possible
    assert kind in DISTURBANCES


@pytest.mark.parametrize("kind", ["object-dropped", "grasp-slips", "surface-blocked"])
def test_a_plan_without_such_a_moment_is_not_disturbed(kind: str) -> None:
    assert moments(kind, plan_of(("move", (), [DRIVE]))) == set()


def test_one_seed_one_moment_within_the_segment() -> None:
    first, second = (schedule("object-moved", PLAN, np.random.default_rng(5)) for _ in range(2))
    assert first == second and first is not None and 0.05 <= first.share <= 0.95
    moved = [schedule("object-moved", PLAN, np.random.default_rng(seed)) for seed in range(200)]
    shares = [one.share for one in moved if one is not None]
    assert len(shares) == 200
    assert min(shares) < 0.1 and max(shares) > 0.9


def test_an_unknown_kind_is_refused_with_the_choices() -> None:
    with pytest.raises(
        InputError, match=r"unknown disturbance 'object-move'.*Did you mean 'object-moved'"
    ):
        schedule("object-move", PLAN, np.random.default_rng(0))
