"""Whatever a generator proposes, what comes back are poses and placements that the planner can use."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from numpy.random import Generator as Random

import tamp
from tamp.geometric.samplers.guarded_call import SamplerFault, propose_safely
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import Placement
from tamp.system.deadline import Deadline

SCENE = tamp.load_problem("one_object").scene
BODY, REGION = SCENE.movable[0], next(iter(SCENE.surfaces))
GOOD = Placement(REGION, 0, 0.1, -0.1, 0.2)


class Says:
    """Proposes what it is given."""

    def __init__(self, *items: Any) -> None:
        self._items = items

    def propose(self, scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
        return list(self._items)


def asked(*items: Any, count: int = 4) -> list[Any]:
    rng = np.random.default_rng(0)
    return propose_safely(
        Says(*items), SCENE, (BODY, REGION), count, rng, Deadline(10.0), seconds=5.0
    )


def test_placements_and_poses_may_be_mixed() -> None:
    assert asked(GOOD, tamp.Pose(), GOOD) == [GOOD, tamp.Pose(), GOOD]
    assert asked(GOOD, GOOD, count=1) == [GOOD]
    assert tamp.Placement is Placement


def test_numbers_of_numpy_become_plain_ones() -> None:
    (made,) = asked(Placement(REGION, np.int64(0), np.float32(0.5), np.array(0.25), 0.0))  # type: ignore[arg-type]
    assert made == Placement(REGION, 0, 0.5, 0.25, 0.0)
    assert type(made.face) is int and type(made.x) is float


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (Placement("nowhere", 0, 0.0, 0.0, 0.0), "in 'nowhere', which there is not"),
        (Placement(REGION, 99, 0.0, 0.0, 0.0), "face 99 of a body that rests on"),
        (Placement(REGION, -1, 0.0, 0.0, 0.0), "face -1"),
        (Placement(REGION, 0, math.nan, 0.0, 0.0), "not finite"),
        (Placement(REGION, 0, 0.0, 0.0, math.inf), "not finite"),
        (Placement(REGION, 0, 1e6, 0.0, 0.0), "more than 1000 m away"),
        (Placement(REGION, 0.5, 0.0, 0.0, 0.0), "without three numbers and a face"),  # type: ignore[arg-type]
        (Placement(REGION, 0, "left", 0.0, 0.0), "without three numbers"),  # type: ignore[arg-type]
        (tamp.Pose((math.nan, 0.0, 0.0)), "not finite"),
        ((0.0, 0.0, 0.0), "a tuple, not a pose"),
    ],
)
def test_what_cannot_be_used_is_named_when_nothing_else_was_proposed(wrong: Any, said: str) -> None:
    with pytest.raises(SamplerFault, match=said):
        asked(wrong)
    assert asked(wrong, GOOD) == [GOOD]
