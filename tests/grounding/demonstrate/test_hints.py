"""Hints: each of the house's lazy hands gets the one that names what it does, a varied one gets none."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.demonstrate.hints import contradictions, hints, next_step
from grounding.demonstrate.relation import parse_relation
from grounding.relations.demonstration_file import Demonstration
from tamp.geometric.loading.furniture import FURNITURE, FurnitureOptions
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, RobotStart, Room, Scene

STACK = parse_relation("stack(a, b)")


def shown(
    number: int,
    holds: bool = True,
    height: float | None = None,
    table_yaw: float | None = None,
    yaw: float | None = None,
    size: float | None = None,
    round_: bool = False,
) -> Demonstration:
    """A stack of two on a table; what is not said is different each time."""
    rng = np.random.default_rng([7, number])
    height = rng.uniform(0.4, 1.0) if height is None else height
    table_yaw = rng.uniform(-math.pi, math.pi) if table_yaw is None else table_yaw
    yaws = rng.uniform(-math.pi, math.pi, 2) if yaw is None else (yaw, yaw)
    edges = rng.uniform(0.05, 0.12, (2, 3)) if size is None else np.full((2, 3), size)
    stand = Pose.from_xyz_yaw(*rng.uniform(-1, 1, 2), 0.0, table_yaw)
    built = FURNITURE["table"].build("table", (1.2, 0.8, height), FurnitureOptions())
    bodies = {"table": Body("table", built.parts, stand, False, surfaces=built.surfaces)}
    x, y, z = stand.position[0], stand.position[1], height + 0.001
    for name, edge, turn in zip(("b", "a"), edges, yaws, strict=True):
        shape = Cylinder(edge[0], edge[2]) if round_ else Box(tuple(edge))
        z += edge[2] / 2
        bodies[name] = Body(
            name, (Part(shape),), Pose.from_xyz_yaw(x, y, z, turn), True, support="table"
        )
        z += edge[2] / 2 + 0.001
    scene = Scene(
        "s", bodies, RobotStart("panda_mobile", (0.0, 0.0, 0.0)), Room((-9.0, 9.0), (-9.0, 9.0))
    )
    return Demonstration(scene, ("a", "b"), holds, f"s_{number}.yaml:9")


def texts(demonstrations: list[Demonstration]) -> list[str]:
    return [one.text for one in hints(STACK, demonstrations)]


def test_what_is_varied_is_not_complained_of() -> None:
    assert texts([shown(n, holds=n % 2 == 0) for n in range(10)]) == []
    assert texts([shown(n) for n in range(2)]) == []  # too early to say


@pytest.mark.parametrize(
    ("lazy", "says"),
    [
        ({"height": 0.72}, "all surfaces were 0.72 m high"),
        ({"table_yaw": 0.3}, "all furniture was turned the same way"),
        ({"yaw": 0.5}, "a was always turned the same way"),
        ({"size": 0.06}, "a was always 6 x 6 x 6 cm large"),
    ],
)
def test_what_is_the_same_is_named(lazy: dict[str, float], says: str) -> None:
    found = texts(
        [*(shown(n, **lazy) for n in range(4)), *(shown(n, holds=False) for n in range(9, 12))]
    )
    assert any(says in text for text in found), found
    assert len(found) <= 2  # a and b have one yaw, one size


def test_what_is_round_need_not_be_turned() -> None:
    assert not any(
        ": turn it" in text for text in texts([shown(n, yaw=0.2, round_=True) for n in range(4)])
    )


def test_a_label_that_is_missing() -> None:
    assert any("does not hold" in text for text in texts([shown(n) for n in range(3)]))
    assert any(
        "says where stack holds" in text
        for text in texts([shown(n, holds=False) for n in range(3)])
    )


def test_the_same_labelled_both_ways() -> None:
    one, other = shown(1), shown(1, holds=False)
    (found,) = contradictions([shown(0), one, shown(2, holds=False), other])
    assert found.kind == "contradiction" and found.files == ("s_1.yaml", "s_1.yaml")
    assert not list(contradictions([one, shown(1)]))
    assert not list(contradictions([one, shown(3, holds=False)]))


def test_next_steps_lead_to_the_end() -> None:
    seen = []
    for holding, other in ((0, 0), (1, 0), (3, 1), (5, 5), (10, 9), (10, 10)):
        labels = [shown(n, holds=n < holding) for n in range(holding + other)]
        seen.append(next_step(STACK, labels))
    assert "press H" in seen[0] and "press N" in seen[1] and "press Learn" in seen[-1]
    assert len(set(seen)) == 5
