"""What does not stand as it was given is rolled onto the face beside, warned of, or refused with the reason."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.initial_poses import place_bodies
from tamp.geometric.loading.steadying import MAX_TIP_RAD, steady, tip
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Sphere
from tests.geometric.making import body, drafts, hull

TABLE = "table: {box: [1.0, 0.6, 0.5], fixed: true, at: [0, 0, 0.25]}\n"


def steadied(folder: Path, text: str) -> tuple[dict[str, Body], tuple[str, ...]]:
    given = drafts(folder, text)
    return steady(place_bodies(given)[0], given)


def leaning(degrees: float, size: tuple[float, float, float] = (0.1, 0.2, 0.3)) -> Body:
    """A box turned about the world's x axis."""
    return Body(
        "box",
        (Part(Box(size)),),
        Pose.from_xyz_rpy((0, 0, 1.0), (math.radians(degrees), 0, 0)),
        True,
    )


@pytest.mark.parametrize("degrees", [-15.0, 3.0, 19.0])
def test_a_leaning_box_rolls_back_onto_its_face(degrees: float) -> None:
    given = leaning(degrees)
    turn = tip(given)
    assert turn is not None
    R = turn @ given.pose.rotation
    assert abs(R[2, 2]) == pytest.approx(1.0, abs=1e-6)  # its z is vertical again
    angle = math.acos((np.trace(turn) - 1) / 2)
    assert math.degrees(angle) == pytest.approx(abs(degrees), abs=1e-3)


def test_an_upright_box_needs_no_turn() -> None:
    assert tip(leaning(0.0)) == pytest.approx(np.eye(3))


def test_beyond_the_limit_it_is_not_rolled() -> None:
    assert math.degrees(MAX_TIP_RAD) == pytest.approx(20.0)
    assert tip(leaning(25.0)) is None


def test_a_box_past_its_balance_rolls_on_to_the_other_side() -> None:
    # Of 0.1 by 0.3 m its balance is at atan(1/3) = 18.4 degrees: at 80 degrees 10 are left to lie on its side.
    given = leaning(80.0, (0.2, 0.3, 0.1))
    turn = tip(given)
    assert turn is not None
    assert abs((turn @ given.pose.rotation)[2, 1]) == pytest.approx(
        1.0, abs=1e-6
    )  # its y is vertical now


def test_one_that_leans_on_a_corner_rolls_over_two_edges() -> None:
    given = Body(
        "box", (Part(Box((0.2, 0.2, 0.2))),), Pose.from_xyz_rpy((0, 0, 1), (0.1, 0.15, 0.7)), True
    )
    turn = tip(given)
    assert turn is not None
    R = turn @ given.pose.rotation
    assert np.abs(R[2]).max() == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(("degrees", "rolls"), [(16.0, True), (40.0, False)])
def test_many_small_turns_count_together(degrees: float, rolls: bool) -> None:
    """A prism of 72 sides lies on one of them; its centre of mass is low when it has turned by some degrees."""
    angle = np.radians(np.arange(72) * 5.0 + 2.5)
    circle = 0.1 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    points = np.concatenate([np.column_stack([np.full(72, x), circle]) for x in (-0.1, 0.1)])
    off = np.radians(degrees)
    centre = (0.0, 0.09 * np.sin(off), -0.09 * np.cos(off))  # so far from straight down, about x
    log = Body("log", (Part(hull(points)),), Pose((0, 0, 1.0)), True, center_of_mass=centre)
    turn = tip(log)
    assert (turn is not None) == rolls
    if turn is not None:
        # Onto the side that is straight below the centre, or the one before it.
        assert math.degrees(math.acos((np.trace(turn) - 1) / 2)) == pytest.approx(degrees, abs=5.1)


def test_what_is_round_lies_still_as_it_is() -> None:
    assert tip(body("can", Cylinder(0.03, 0.1), (0, 0, 1))) == pytest.approx(np.eye(3))


def test_a_ball_is_a_polyhedron_that_rolls_a_little_at_most() -> None:
    turn = tip(body("ball", Sphere(0.05), (0, 0, 1)))
    assert turn is not None
    assert math.acos(min(1.0, (np.trace(turn) - 1) / 2)) < MAX_TIP_RAD


def test_a_tilted_body_is_laid_down_with_a_word_about_it(tmp_path: Path) -> None:
    text = TABLE + "box: {box: [0.1, 0.1, 0.1], on: table, rpy: [5 deg, 0, 0]}"
    bodies, warnings = steadied(tmp_path, text)
    assert len(warnings) == 1
    assert warnings[0].startswith("box is tipped by 5.0 deg onto its nearest face: ")
    assert abs(bodies["box"].pose.rotation[2, 2]) == pytest.approx(1.0, abs=1e-6)
    low = bodies["box"].pose.position[2] - 0.05
    assert low == pytest.approx(0.501, abs=1e-6)  # the contact gap above the table


def test_over_the_edge_is_refused_with_how_far(tmp_path: Path) -> None:
    ladle = TABLE + "rod: {box: [0.8, 0.05, 0.05], on: table, at: [0.45, 0]}"
    bodies, _ = steadied(tmp_path, ladle)
    assert bodies["rod"].support == "table"  # its middle is above the table
    tall = "pin: {box: [0.04, 0.04, 0.04], fixed: true, at: [3, 0, 0.02]}\nrod: {box: [0.8, 0.02, 0.02], on: pin}"
    assert steadied(tmp_path, tall)[1] == ()
    with pytest.raises(InputError, match=r"stick.on: stick does not stand on 'table': .*Move it"):
        steadied(
            tmp_path, TABLE + "stick: {box: [0.02, 0.02, 0.3], on: table, rpy: [45 deg, 0, 0]}"
        )


def test_in_the_air_there_is_a_warning_and_no_support(tmp_path: Path) -> None:
    bodies, warnings = steadied(tmp_path, TABLE + "cup: {sphere: 0.05, at: [0, 0, 0.8]}")
    assert bodies["cup"].support is None
    assert len(warnings) == 1 and warnings[0].startswith("cup hangs in the air: ")
    assert "say 'on:', or 'fixed: true'" in warnings[0]


def test_a_body_knows_which_movable_ones_carry_it(tmp_path: Path) -> None:
    text = (
        "a: {box: [0.2, 0.2, 0.1], on: floor}\nb: {box: [0.1, 0.1, 0.1], on: a}\n"
        + TABLE.replace("[0, 0", "[3, 0")
    )
    bodies, warnings = steadied(tmp_path, text + "c: {box: [0.1, 0.1, 0.1], on: table}")
    assert warnings == ()
    assert (bodies["a"].carriers, bodies["b"].carriers, bodies["c"].carriers) == ((), ("a",), ())
