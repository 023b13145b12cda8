"""In a narrow place most random grasps are such that the hand gets in; elsewhere none is left out."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tamp.geometric.streams.approach import test_approach as approach_test
from tamp.geometric.streams.grasps import sample_grasps
from tamp.geometric.streams.narrow_ways import KEEP_EVERY, LOOKED_AT, promising
from tamp.geometric.streams.sampling import sample_grasp
from tamp.geometric.values import Grasp
from tamp.planner.problem import load_problem
from tests.geometric.streams.scenes import call, values

DEEP = """\
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  cupboard: {furniture: cupboard, size: [0.36, 0.62, 1.14], compartments: 2, plinth: 0.4, at: [-1.6, 0.3, 0.0]}
  thing: {box: [0.06, 0.14, 0.2], on: cupboard_2, at: [0.0, 0.1]}
goal: (on thing cupboard_top)
"""


def test_random_grasps_in_a_deep_compartment_reach_into_it(tmp_path: Path) -> None:
    file = tmp_path / "deep.yaml"
    file.write_text(DEEP, encoding="utf-8")
    context = load_problem(file).context
    thing = context.scene.bodies["thing"]

    def share(grasps: list[Grasp]) -> float:
        return sum(
            approach_test(context, "thing", thing.pose, one, call()) is True for one in grasps
        ) / len(grasps)

    advised = values(sample_grasp(context, "thing", call()), 300)[150:]
    plain = values(sample_grasps(thing, context.robot, np.random.default_rng(0)), 300)[150:]
    assert share(plain) < 0.25 < 0.4 < share(advised)
    assert share(advised) < 1.0  # some others still come: it may be grasped elsewhere


def tools(seed: int) -> Iterator[np.ndarray | None]:
    rng = np.random.default_rng(seed)
    while True:
        T = np.eye(4)
        T[:3, 2] = rng.normal(size=3)
        T[:3, 2] /= np.linalg.norm(T[:3, 2])
        yield None if rng.random() < 0.2 else T


def test_where_there_is_room_nothing_is_left_out() -> None:
    found = promising(tools(0), lambda T: bool(T[2, 2] < 0.0))
    for ours, plain in itertools.islice(zip(found, tools(0), strict=False), 500):
        assert ours is plain or (ours == plain).all()


def test_where_no_way_is_free_every_tenth_comes_through() -> None:
    drawn = 0

    def counted() -> Iterator[np.ndarray]:
        nonlocal drawn
        for T in tools(1):
            if T is not None:
                drawn += 1
                yield T

    found = list(itertools.islice(promising(counted(), lambda _: False), LOOKED_AT + 5))
    assert len(found) == LOOKED_AT + 5 and drawn == LOOKED_AT + 5 * KEEP_EVERY
