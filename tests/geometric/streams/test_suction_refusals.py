"""Why a cup holds a body nowhere: proven only where no face closes it, and what is too heavy is weighed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Part, Shape, Sphere
from tamp.geometric.streams.suction import SEAL_GIVE_M
from tamp.geometric.streams.suction_refusals import no_seal, too_heavy_to_suck
from tamp.stream import Rejection, RejectionKind
from tests.geometric.streams.cups import CUP, body, first, with_cup


@pytest.fixture(scope="module")
def robot() -> Robot:
    return with_cup()


@pytest.mark.parametrize(
    ("shape", "proven"),
    [
        (Sphere(0.04), True),
        (Box((0.045, 0.3, 0.03)), False),
        (Box((0.03, 0.3, 0.035)), True),
        (Cylinder(0.015, 0.2), True),
        (Cylinder(0.5, 0.2), False),
    ],
)
def test_no_grasp_is_proven_exactly_where_no_face_closes_the_cup(
    robot: Robot, shape: Shape, proven: bool
) -> None:
    thing = body(shape)
    assert (len(first(robot, thing, 1)) == 0) is proven
    said = no_seal(thing, CUP)
    assert (
        said.given_up is not proven
        and ("closes the cup (the cup is 40 mm" in said.reason) is proven
    )


def test_what_is_too_heavy_is_said(robot: Robot) -> None:
    said = too_heavy_to_suck(body(Box((0.2, 0.2, 0.2)), mass=9.0), robot)
    assert isinstance(said, Rejection) and said.kind is RejectionKind.TOO_HEAVY
    assert "weighs 9 kg: the cup, at 75 N, holds 7.6 kg" in said.reason
    assert too_heavy_to_suck(body(Box((0.2, 0.2, 0.2)), mass=7.0), robot) is None


@pytest.mark.parametrize(
    ("shape", "proven"),
    [
        (Box((0.039, 0.039, 1.0)), True),  # a rim of 4 cm across needs both sides of a face
        (Box((0.039, 0.041, 1.0)), False),
        (Box((1.0, 0.041, 0.041)), False),
        (Cylinder(0.0199, 0.5), True),  # neither an end nor the side, which falls away by 1.8 cm
        (Cylinder(0.0201, 0.5), False),
        (Sphere(0.1), True),  # it falls away by 2 mm
    ],
)
def test_a_face_closes_the_cup_where_the_whole_rim_is_on_it(shape: Shape, proven: bool) -> None:
    assert no_seal(body(shape), CUP).given_up is not proven


@pytest.mark.parametrize("radius", [0.05, 0.5, 5.0])
def test_a_round_side_falls_away_by_no_more_than_the_seal_gives(radius: float) -> None:
    """Under a rim of 2 cm: 4.2 mm of a ball of 5 cm, 0.4 mm of one of 0.5 m, 0.04 mm of one of 5 m."""
    falls = radius - (radius**2 - 0.02**2) ** 0.5
    assert no_seal(body(Sphere(radius)), CUP).given_up is (falls <= SEAL_GIVE_M)
    assert {0.05: True, 0.5: False, 5.0: False}[radius] is (falls > SEAL_GIVE_M)


def test_several_parts_prove_nothing() -> None:
    """Though none of them has a face for it: together they may."""
    thin = Box((0.03, 0.03, 0.3))
    assert not no_seal(body(thin), CUP).given_up
    assert no_seal(body(thin, Part(thin, Pose((0.03, 0.0, 0.0)))), CUP).given_up


def test_up_to_the_weight_that_it_holds_a_body_is_not_too_heavy(robot: Robot) -> None:
    strong = replace(robot, force=98.1)
    assert too_heavy_to_suck(body(Box((0.2, 0.2, 0.2)), mass=9.99), strong) is None
    said = too_heavy_to_suck(body(Box((0.2, 0.2, 0.2)), mass=10.01), strong)
    assert isinstance(said, Rejection) and said.given_up and "holds 10 kg" in said.reason
