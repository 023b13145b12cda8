"""A plan in physics: it works as planned, and when somebody interferes it is mended or the reason is told."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.execution.disturbance import DISTURBANCES, schedule
from tamp.execution.execute import execute
from tamp.execution.execution_options import ExecutionOptions
from tamp.execution.replan import Replanner
from tamp.execution.report import Execution
from tamp.plan.open import Stored


class Sceptic:
    """A classifier that is told what it was asked."""

    def __init__(self) -> None:
        self.asked: list[list[str]] = []

    def classify(self, scene: object, arguments: list[str]) -> float:
        self.asked.append(list(arguments))
        return 0.25


def mended(stored: Stored, disturbance: str, seed: int = 0) -> Execution:
    replanner = Replanner(stored, max_time=20.0)
    return execute(
        stored, ExecutionOptions(replanner=replanner, disturbance=disturbance, seed=seed)
    )


@pytest.mark.parametrize("grasp", ["friction", "constraint"])
def test_a_plan_reaches_its_goal(stored: Stored, grasp: str) -> None:
    sceptic = Sceptic()
    done = execute(stored, ExecutionOptions(grasp=grasp, classifiers={"on": ("sceptic", sceptic)}))
    assert done.reached and not done.explanation
    assert [action.name for action in done.actions] == [
        action.name for action in stored.plan.actions
    ]
    assert [(part.fact, part.holds, part.probability) for part in done.goal] == [
        ("(on can left)", True, 0.25)
    ]
    assert sceptic.asked == [["Can", "left"]]
    assert not done.kinds and not any(action.displaced for action in done.actions)
    assert max(action.base for action in done.actions) < 0.01
    assert max(action.arm for action in done.actions) < math.radians(3)
    assert done.simulated == pytest.approx(stored.plan.duration, rel=0.5)
    assert "Goal reached" in done.text() and done.json()["reached"] is True


def test_the_same_seed_gives_the_same_run(stored: Stored) -> None:
    assert mended(stored, "object-dropped", 3) == mended(stored, "object-dropped", 3)


@pytest.mark.parametrize(
    "name", ["object-moved", "object-dropped", "grasp-slips", "surface-blocked"]
)
def test_a_disturbed_plan_is_mended(stored: Stored, name: str) -> None:
    done = mended(stored, name, seed=1)
    assert done.disturbance
    assert sum(action.event is not None for action in done.actions) == 1
    assert done.kinds, "nothing was noticed"
    assert done.replans + done.kept >= 1
    assert done.reached, done.text()


def test_what_is_dropped_is_lost_without_a_new_plan(stored: Stored) -> None:
    done = execute(stored, ExecutionOptions(disturbance="object-dropped"))
    assert not done.reached and done.replans == 0
    assert "lost" in done.kinds
    (part,) = done.goal
    assert not part.holds and part.why
    assert "Goal not reached" in done.text()


def removes(stored: Stored, seed: int) -> tuple[int, int]:
    """During which action, and which of the two bodies is taken away with a seed."""
    rng = np.random.default_rng(seed)
    scheduled = schedule("object-removed", stored.plan, rng)
    assert scheduled is not None
    return scheduled.action, int(rng.integers(2))


def test_a_body_that_is_gone_is_missed_when_the_goal_needs_it(stored: Stored) -> None:
    """The block is of no use; the can is."""
    runs = {}
    for choice in (0, 1):
        seed = next(seed for seed in range(500) if removes(stored, seed) == (0, choice))
        done = mended(stored, "object-removed", seed)
        runs[done.disturbance] = done
    without = runs["block is taken away"]
    (noticed,) = [action for action in without.actions if action.event]
    assert [one.kind for one in noticed.deviations] == ["gone"]
    assert noticed.after == "the rest of the plan still holds"
    assert without.reached and without.replans == 0
    gone = runs["Can is taken away"]
    assert not gone.reached and gone.explanation == ("Can is gone, and the goal needs it",)
    assert gone.goal[0].why == "it is gone"


def test_a_disturbance_needs_a_moment(stored: Stored) -> None:
    empty = replace(stored.plan, actions=())
    for name in DISTURBANCES:
        assert schedule(name, empty, np.random.default_rng(0)) is None
        for seed in range(20):
            scheduled = schedule(name, stored.plan, np.random.default_rng(seed))
            assert scheduled is not None and 0 <= scheduled.action < len(stored.plan.actions)


def test_unknown_names_are_refused(stored: Stored) -> None:
    with pytest.raises(InputError, match=r"unknown disturbance 'object-eaten'.*object-moved"):
        execute(stored, ExecutionOptions(disturbance="object-eaten"))
    with pytest.raises(InputError, match=r"unknown grasp 'magnet'.*friction"):
        execute(stored, ExecutionOptions(grasp="magnet"))
