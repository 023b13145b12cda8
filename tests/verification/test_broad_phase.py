"""The broad phase over time leaves nothing out: the engine asked of every near pair says the same."""

from __future__ import annotations

import copy
import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from benchmarks.engine_verdicts import SPOIL
from tamp.geometric.scene.pose import Array
from tamp.simulation.solid import Solid
from tamp.simulation.world import World
from tamp.verification import collision_sweep
from tamp.verification.broad_phase import Pairs, Still
from tamp.verification.collision_sweep import CLEARANCE_RANGE_M, Sweeper
from tamp.verification.link_frames import LinkFrames
from tamp.verification.report import Report
from tamp.verification.trajectory_sampling import SampledMotion
from tamp.verification.verify import verify
from tests.needs import INSTALLED

SPOILT = 10


class EveryPair:
    """What a broad phase replaces: each state by itself, boxes against boxes, and the engine."""

    def __init__(self, world: World) -> None:
        self._world = world

    def apart(self, pair: tuple[int, int], way: float, within: float) -> bool:
        return False

    def distance(
        self, pair: tuple[int, int], solids: tuple[Solid, Solid], way: float, reach: float
    ) -> float:
        return self._world.distance(*solids, CLEARANCE_RANGE_M)


def every_still(
    motion: SampledMotion, still: Still, within: Array
) -> Iterator[tuple[int, int, int, float]]:
    """All pairs in all states that are looked at at all, said to be as near as can be."""
    for state in range(len(motion.rows)):
        low, high = motion.low[:, None, state], motion.high[:, None, state]
        gaps = np.maximum(low - still.high, still.low - high).max(axis=2)
        for mover, piece in np.argwhere((gaps < CLEARANCE_RANGE_M) & np.isfinite(within)).tolist():
            yield state, mover, piece, -np.inf


def every_itself(motion: SampledMotion, pairs: Pairs) -> Iterator[tuple[int, int]]:
    for state in np.flatnonzero(motion.shaped).tolist():
        for number, (first, second) in enumerate(pairs.tolist()):
            low, high = motion.low[:, state], motion.high[:, state]
            if (low[first] <= high[second]).all() and (low[second] <= high[first]).all():
                yield state, number


def said(report: Report) -> dict[str, Any]:
    """What a report says, with figures that rounding does not move, without its seconds."""
    text = json.dumps({key: value for key, value in report.json().items() if key != "seconds"})
    return json.loads(text, parse_float=lambda figure: round(float(figure), 5))


@pytest.mark.parametrize("engine", INSTALLED)
def test_reports_are_those_without_a_broad_phase(
    plan: dict[str, Any], engine: str, rng: np.random.Generator, monkeypatch: pytest.MonkeyPatch
) -> None:
    plans = [plan]
    for number in range(SPOILT):
        plans.append(copy.deepcopy(plan))
        SPOIL[list(SPOIL)[number % len(SPOIL)]](plans[-1], rng)
    quick = [said(verify(one, engine=engine)) for one in plans]

    monkeypatch.setattr(collision_sweep, "near_still", every_still)
    monkeypatch.setattr(collision_sweep, "near_itself", every_itself)
    monkeypatch.setattr(collision_sweep, "Advancement", EveryPair)
    monkeypatch.setattr(LinkFrames, "__call__", LinkFrames.engines)
    monkeypatch.setattr(Sweeper, "hand_may_meet", lambda *_: True)
    thorough = [said(verify(one, engine=engine)) for one in plans]

    assert quick == thorough
    assert quick[0]["holds"]
    kinds = {violation["kind"] for one in quick for violation in one["violations"]}
    assert {"collision", "grasp", "certified"} & kinds


@pytest.mark.parametrize("engine", INSTALLED)
def test_few_distances_are_asked_for(
    plan: dict[str, Any], engine: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[float] = []
    opened = collision_sweep.Advancement

    class Counting(opened):
        def distance(self, *arguments: Any) -> float:
            asked.append(0.0)
            return super().distance(*arguments)

    monkeypatch.setattr(collision_sweep, "Advancement", Counting)
    states = verify(plan, engine=engine).states
    few = len(asked)
    monkeypatch.setattr(Counting, "apart", lambda *_: False)
    assert verify(plan, engine=engine).states == states
    assert 0 < 2 * few < len(asked)
