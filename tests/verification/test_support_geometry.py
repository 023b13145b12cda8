"""How bodies stand."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.loading.footing import Ground
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import (
    Body,
    Box,
    Cavity,
    Cylinder,
    Part,
    RobotStart,
    Room,
    Scene,
    Sphere,
    Surface,
)
from tamp.geometric.stability.stable_poses import stable_faces
from tamp.simulation.engines import open_world
from tamp.simulation.settle import settle
from tamp.verification.support_geometry import Supports, outside

TABLE = Body(
    "table", (Part(Box((1.0, 1.0, 0.1))),), Pose((0, 0, 0.5)), movable=False,
    surfaces=(Surface("table", "table", Pose((0, 0, 0.05)), (1.0, 1.0)),),
    cavities=(Cavity("air", "table", Pose((0, 0, 0.05)), (0.4, 0.4, 0.15)),),
)  # fmt: skip
STEP = Body("step", (Part(Box((0.2, 0.2, 0.1))),), Pose((0.3, 0, 0.6)), movable=False)


def scene(*bodies: Body) -> Scene:
    return Scene(
        "s",
        {b.name: b for b in (TABLE, *bodies)},
        RobotStart("panda_mobile", (0, 0, 0)),
        Room((-2, 2), (-2, 2)),
    )


def block(x: float, z: float, name: str = "block", *parts: Part) -> Body:
    return Body(name, parts or (Part(Box((0.06, 0.06, 0.1))),), Pose((x, 0, z)), movable=True)


@pytest.mark.parametrize(
    ("x", "z", "on", "stable"),
    [
        (0.0, 0.601, {"table"}, True),
        (0.0, 0.6, {"table"}, True),
        (0.0, 0.595, set(), False),
        (0.0, 0.609, {"table"}, True),
        (0.0, 0.612, set(), False),
        (0.49, 0.601, {"table"}, True),
        (0.51, 0.601, {"table"}, False),
        (0.8, 0.051, {"floor"}, True),
    ],
)
def test_a_block_on_a_table(x: float, z: float, on: set[str], stable: bool) -> None:
    with open_world(scene(block(x, z))) as world:
        stand = Supports(world).stand("block")
        assert stand.stable is stable
        if stable:
            assert stand.on == on
        assert np.allclose(world.pose("block"), Pose((x, 0, z)).matrix)


@pytest.mark.parametrize(
    ("x", "centre", "stable"), [(0.49, 0.02, False), (0.51, -0.02, True), (0.49, -0.02, True)]
)
def test_the_files_centre_of_mass_counts(x: float, centre: float, stable: bool) -> None:
    """The planner's side, the judge's and physics agree on a body whose file says where its mass is."""
    uneven = replace(block(x, 0.601), center_of_mass=(centre, 0.0, 0.0))
    with open_world(scene(uneven)) as world:
        assert Supports(world).stand("block").stable is stable
    assert (Ground(scene(uneven).bodies).footing(uneven).why is None) is stable
    settled = settle(scene(uneven), {"block": uneven.pose}, 1.0)["block"]
    assert (settled.moved < 0.003) is stable
    assert all(
        abs(abs(face.centre).max() - abs(centre)) < 1e-9 or not face.centre.any()
        for face in stable_faces(uneven)
    )


@pytest.mark.parametrize("shape", [Sphere(0.04), Cylinder(0.04, 0.08)])
def test_a_ball_and_a_can_stand(shape: Sphere | Cylinder) -> None:
    with open_world(scene(block(0.0, 0.591, "round", Part(shape)))) as world:
        assert Supports(world).stand("round").stable


def test_a_bridge_stands_on_two_bodies() -> None:
    pillars = [block(x, 0.601, name) for x, name in ((-0.1, "left"), (0.1, "right"))]
    beam = block(0.0, 0.662, "beam", Part(Box((0.3, 0.05, 0.02))))
    with open_world(scene(*pillars, beam)) as world:
        supports = Supports(world)
        stand = supports.stand("beam")
        assert stand.on == {"left", "right"} and stand.stable
        assert supports.on("beam", TABLE.surfaces[0], stand) is not None
        assert not supports.stand("beam", absent=frozenset({"left"})).stable
        assert supports.stand("beam").stable, "the absent body is back"


def test_on_and_inside_say_why_not() -> None:
    with open_world(scene(block(0.0, 0.601))) as world:
        supports = Supports(world)
        surface, cavity = TABLE.surfaces[0], TABLE.cavities[0]

        def why(x: float, z: float) -> tuple[str | None, str | None]:
            world.place("block", Pose((x, 0, z)).matrix)
            stand = supports.stand("block")
            return supports.on("block", surface, stand), supports.inside("block", cavity, stand)

        assert why(0.0, 0.601) == (None, None)
        assert why(0.3, 0.601)[0] is None
        assert "protrudes by 130.0 mm" in str(why(0.3, 0.601)[1])
        assert "above the surface" in str(why(0.0, 0.62)[0])
        assert "beyond" in str(why(0.52, 0.601)[0])
        assert "nothing" in str(why(0.0, 0.62)[1])


def test_outside_of_a_hull() -> None:
    square = np.array(list(itertools.product((0.0, 1.0), repeat=2)))
    assert outside(np.array([0.5, 0.5]), square) == pytest.approx(-0.5)
    assert outside(np.array([2.0, 2.0]), square) == pytest.approx(2**0.5)
    assert outside(np.array([0.5, 0.1]), np.array([[0.0, 0.0], [1.0, 0.0]])) == pytest.approx(0.1)
    assert outside(np.array([1.0, 1.0]), np.array([[0.0, 1.0]])) == pytest.approx(1.0)
