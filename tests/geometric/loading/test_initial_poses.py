"""Where bodies stand at the start: on what they name, at their place in its frame, or where they are put."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.initial_poses import MAX_COORDINATE_M, place_bodies
from tamp.geometric.scene.scene import CONTACT_GAP, Body
from tests.geometric.making import drafts

TABLE = "table: {box: [1.0, 0.6, 0.5], fixed: true, at: [2, 1, 0.25], yaw: 90 deg}\n"
"""Its top, of its own name, is 0.5 m high; its x points along the world's y."""


def placed(folder: Path, text: str) -> dict[str, Body]:
    bodies, warnings = place_bodies(drafts(folder, text))
    assert warnings == ()
    return bodies


def test_on_puts_a_body_at_a_place_in_the_surfaces_frame(tmp_path: Path) -> None:
    cup = placed(tmp_path, TABLE + "cup: {box: [0.1, 0.1, 0.2], on: table, at: [0.3, 0.1]}")["cup"]
    assert cup.support == "table"
    assert cup.pose.position == pytest.approx((2.0 - 0.1, 1.0 + 0.3, 0.5 + CONTACT_GAP + 0.1))
    assert cup.pose.yaw == pytest.approx(math.pi / 2)  # upright as the surface is turned


def test_without_a_place_it_stands_in_the_middle(tmp_path: Path) -> None:
    ball = placed(tmp_path, TABLE + "ball: {sphere: 0.05, on: table}")["ball"]
    assert ball.pose.position == pytest.approx((2.0, 1.0, 0.55 + CONTACT_GAP))


def test_a_body_that_lies_has_its_lowest_point_on_the_surface(tmp_path: Path) -> None:
    can = placed(
        tmp_path, "can: {cylinder: {radius: 0.03, height: 0.2}, on: floor, rpy: [90 deg, 0, 0]}"
    )["can"]
    assert can.pose.position[2] == pytest.approx(0.03 + CONTACT_GAP)
    assert can.support is None  # the floor is no surface of the scene


def test_a_pile_is_placed_from_below_in_whatever_order_it_is_listed(tmp_path: Path) -> None:
    text = "c: {box: [0.1, 0.1, 0.1], on: b}\nb: {box: [0.1, 0.1, 0.1], on: a}\na: {box: [0.1, 0.1, 0.1], on: floor}"
    bodies = placed(tmp_path, text)
    assert list(bodies) == ["c", "b", "a"]
    heights = [bodies[name].pose.position[2] for name in "abc"]
    step = 0.1 + CONTACT_GAP
    assert heights == pytest.approx(
        [0.05 + CONTACT_GAP, 0.05 + CONTACT_GAP + step, 0.05 + CONTACT_GAP + 2 * step]
    )
    assert [bodies[name].support for name in "abc"] == [None, "a", "b"]


@pytest.mark.parametrize(
    ("above", "support"), [(0.0019, "table"), (-0.0019, "table"), (0.0021, None)]
)
def test_a_posed_body_within_two_millimetres_of_a_surface_rests_on_it(
    tmp_path: Path, above: float, support: str | None
) -> None:
    z = 0.5 + above + 0.05
    cup = placed(tmp_path, TABLE + f"cup: {{box: [0.1, 0.1, 0.1], at: [2, 1, {z}]}}")["cup"]
    assert cup.support == support
    assert cup.pose.position[2] == pytest.approx(0.55 + CONTACT_GAP if support else z)


def test_beside_the_surface_it_hangs_as_it_was_given(tmp_path: Path) -> None:
    cup = placed(tmp_path, TABLE + "cup: {box: [0.1, 0.1, 0.1], at: [2.31, 1, 0.55]}")[
        "cup"
    ]  # the half depth is 0.3
    assert cup.support is None and cup.pose.position == (2.31, 1.0, 0.55)


def test_a_fixed_body_stays_where_it_was_given(tmp_path: Path) -> None:
    box = placed(tmp_path, TABLE + "box: {box: [0.1, 0.1, 0.1], fixed: true, at: [2, 1, 0.5515]}")[
        "box"
    ]
    assert box.pose.position == (2.0, 1.0, 0.5515) and box.support is None


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "a: {sphere: 0.1, on: tabel}",
            "a.on: unknown surface or body 'tabel'.*Did you mean 'table'",
        ),
        (
            "a: {sphere: 0.1, on: table, at: [0.51, 0]}",
            "a.at: a's centre is 0.010 m outside of 'table'.*reaches 1 x 0.6 m",
        ),
        (
            "a: {sphere: 0.1, on: table, pose: {position: [0, 0, 0]}}",
            "a.pose: 'on' and 'pose' both say where it is",
        ),
        (
            "a: {sphere: 0.1, at: [0, 0, 1], pose: {position: [0, 0, 0]}}",
            "a.at: 'pose' and 'at' both say where it is",
        ),
        ("a: {sphere: 0.1}", "a: nothing says where it is. Give 'on: <surface>', 'at:"),
        (
            "a: {sphere: 0.1, at: [0, 0]}",
            "a.at: expected 3 numbers, found 2. Or say what it stands on",
        ),
        ("a: {sphere: 0.1, on: a}", "a.on: these stand on each other in a circle: a on a"),
        ("a: {sphere: 0.1, on: b}\nb: {sphere: 0.1, on: a}", "in a circle: a on b on a"),
        (
            "a: {sphere: 0.1, on: b}\nb: {sphere: 0.1, on: floor}",
            "a.on: 'b' has no flat top to stand on",
        ),
        (
            "a: {sphere: 0.1, at: [0, 0, 0.09]}",
            "a: it reaches 0.010 m below the floor. Or say 'fixed: true'",
        ),
        (
            f"a: {{sphere: 0.1, at: [{2 * MAX_COORDINATE_M}, 0, 1]}}",
            "a: it is farther than 100000 m from the world's origin",
        ),
    ],
)
def test_what_cannot_stand_is_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        place_bodies(drafts(tmp_path, TABLE + text))


def test_a_body_with_two_places_has_to_be_asked_for_one(tmp_path: Path) -> None:
    two = (
        "rack: {box: [1, 1, 1], fixed: true, at: [0, 0, 0.5], surfaces:"
        " {low: {at: [0, 0, 0.5], size: [0.2, 0.2]}, high: {at: [0.3, 0, 0.5], size: [0.2, 0.2]}}}\n"
    )
    with pytest.raises(
        InputError, match=r"a.on: 'rack' has several places to stand. Choices: low, high"
    ):
        place_bodies(drafts(tmp_path, two + "a: {sphere: 0.05, on: rack}"))
    assert placed(tmp_path, two + "a: {sphere: 0.05, on: high}")["a"].pose.position[
        0
    ] == pytest.approx(0.3)


def test_a_declared_surface_that_leans_carries_nothing(tmp_path: Path) -> None:
    ramp = (
        "ramp: {box: [1, 1, 0.1], fixed: true, at: [0, 0, 1], rpy: [0, 10 deg, 0],"
        " surfaces: {slope: {at: [0, 0, 0.05], size: [0.5, 0.5]}}}\n"
    )
    with pytest.raises(
        InputError, match="ramp: 'slope' is not horizontal, nothing can stand on it"
    ):
        place_bodies(drafts(tmp_path, ramp))
