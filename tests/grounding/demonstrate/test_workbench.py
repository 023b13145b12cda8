"""Bodies that are put down and let go, against what geometry says."""

from __future__ import annotations

import math

import numpy as np
import pytest

from grounding.demonstrate.workbench import Workbench
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body, Box, Cylinder, Part

TABLE = Body("table", (Part(Box((1.0, 0.8, 0.7))),), Pose((0.0, 0.0, 0.35)), False)
BASE = Body("base", (Part(Box((0.2, 0.2, 0.1))),), Pose((0.0, 0.0, 0.751)), True)


TALL = Box((0.06, 0.06, 0.12))


def bodies(pose: Pose, shape: Box | Cylinder = TALL) -> dict[str, Body]:
    return {"table": TABLE, "base": BASE, "one": Body("one", (Part(shape),), pose, True)}


def low(where: dict[str, Body], pose: Pose) -> float:
    return float(bounds(where["one"].parts, pose)[0][2])


@pytest.mark.parametrize("height", [0.75, 0.9, 1.4, 0.3])
@pytest.mark.parametrize(("x", "top"), [(0.02, 0.801), (0.3, 0.7)])
@pytest.mark.parametrize("yaw", [0.0, 0.7])
def test_put_down_ends_just_above_what_is_below(
    height: float, x: float, top: float, yaw: float, workbench
) -> None:
    """Also from inside of it: a hand is careless."""
    where = bodies(Pose.from_xyz_yaw(x, 0.05, height, yaw))
    pose = workbench.put_down("one", where)
    assert pose.position[:2] == pytest.approx((x, 0.05)) and pose.yaw == pytest.approx(yaw)
    assert 0.3 * CONTACT_GAP < low(where, pose) - top < 2.0 * CONTACT_GAP


def test_put_down_beside_a_wall_goes_all_the_way(workbench) -> None:
    where = bodies(Pose((0.1 + 0.03 + 0.0004, 0.0, 1.0)))  # 0.4 mm beside the base
    pose = workbench.put_down("one", where)
    assert low(where, pose) == pytest.approx(0.7 + CONTACT_GAP, abs=0.0011)


def test_put_down_twice_changes_nothing(workbench) -> None:
    where = bodies(Pose((0.3, 0.0, 1.0)))
    first = workbench.put_down("one", where)
    again = workbench.put_down("one", bodies(first))
    assert again.position == pytest.approx(first.position, abs=1e-4)


def test_beside_the_table_it_lands_on_the_floor(workbench) -> None:
    where = bodies(Pose((0.9, 0.0, 1.0)))
    assert low(where, workbench.put_down("one", where)) == pytest.approx(CONTACT_GAP, abs=0.001)


def test_what_leans_falls_and_what_stands_stays(workbench) -> None:
    tilted = Pose.from_xyz_rpy((0.3, 0.0, 0.79), (math.radians(50.0), 0.0, 0.0))
    where = bodies(tilted)
    rest = workbench.drop("one", where)
    assert abs(abs(rest.rotation[2]).max() - 1.0) < 1e-3  # on a face
    assert low(where, rest) == pytest.approx(0.7 + CONTACT_GAP, abs=0.002)
    standing = workbench.put_down("one", bodies(Pose((0.3, 0.0, 1.0))))
    assert workbench.drop("one", bodies(standing)).position == pytest.approx(
        standing.position, abs=0.002
    )


@pytest.mark.parametrize(
    ("pose", "kind", "says"),
    [
        (Pose((0.3, 0.0, 0.761)), None, ""),
        (Pose((0.3, 0.0, 0.861)), "hangs", "hangs 10 cm above"),
        (Pose((0.3, 0.0, 0.781)), "hangs", "hangs 21 mm above"),
        (Pose((0.3, 0.0, 0.74)), "overlaps", "20 mm inside table"),
        (Pose((0.0, 0.0, 0.8)), "overlaps", "inside base"),
        (Pose((0.12, 0.0, 0.863)), "falls", "would not stay"),
        (Pose((0.515, 0.0, 0.761)), "falls", "would not stay"),
        (Pose((2.0, 0.0, 0.03)), "overlaps", "inside the floor"),
    ],
)
def test_troubles(pose: Pose, kind: str | None, says: str, workbench: Workbench) -> None:
    found = list(workbench.troubles(bodies(pose), ("one",)))
    assert [one.kind for one in found] == ([] if kind is None else [kind])
    assert all(says in one.text and one.text.startswith("one ") for one in found)


def test_sixty_things_put_down_never_overlap(workbench: Workbench) -> None:
    rng = np.random.default_rng(3)
    for _ in range(60):
        shape = (
            Cylinder(*rng.uniform(0.02, 0.06, 2))
            if rng.random() < 0.5
            else Box(tuple(rng.uniform(0.02, 0.12, 3)))
        )
        turn = rng.normal(size=4)
        pose = Pose(
            tuple(rng.uniform((-0.3, -0.3, 0.6), (0.3, 0.3, 1.1))),
            tuple(turn / np.linalg.norm(turn)),
        )
        where = bodies(workbench.put_down("one", bodies(pose, shape)), shape)
        assert [
            one.kind for one in workbench.troubles(where, ("one",)) if one.kind != "falls"
        ] == []
