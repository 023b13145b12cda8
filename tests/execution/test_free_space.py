"""Free places in a world as it stands: 5 mm of air to all others, on the same as before."""

from __future__ import annotations

from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tamp.execution.free_space import CLEARANCE_M, FreeSpace
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, Body, Box, Part
from tests.geometric.making import body, scene, table

SIDE, TOP = 0.1, 0.5
CUBE = Box((SIDE, SIDE, SIDE))
AT = {"Cup": (0.0, 0.0), "jar": (0.3, 0.0), "held": (0.0, 0.2)}
"""Where cubes stand on a table of 1 x 0.6 m about the origin."""


def on_table(x: float, y: float, above: float = 0.0) -> Array:
    """A cube's pose on the table's top, as in physics: without the planner's air."""
    return Pose((x, y, TOP + SIDE / 2 + above)).matrix


def world(touches: tuple[tuple[str, str], ...] = (), bound: str | None = None) -> Any:
    cubes = [body(name, CUBE, (9.0, 9.0, 9.0)) for name in AT]
    made = scene(table(), table("other", (1.5, 0.0)), *cubes, half=5.0)
    return SimpleNamespace(
        scene=made, bound=bound, robot_links={"hand", "arm"}, pose=lambda name: on_table(*AT[name]),
        touches=lambda: dict.fromkeys(touches, 1.0),
    )  # fmt: skip


@pytest.fixture(scope="module")
def space() -> Iterator[FreeSpace]:
    with FreeSpace(world()) as made:
        yield made


@pytest.mark.parametrize(
    ("x", "y", "fits"),
    [
        (0.0, 0.0, True), (-0.3, -0.2, True), (0.05, 0.05, True),
        (0.3, 0.0, False), (0.3 - SIDE - 0.003, 0.0, False), (0.3 - SIDE - 0.007, 0.0, True),
        (0.0, 0.2 - SIDE - 0.003, False), (0.0, 0.2 - SIDE - 0.007, True),
        (-0.49, 0.0, True), (-0.52, 0.0, False), (1.5, 0.0, False), (3.0, 3.0, False),
    ],
)  # fmt: skip
def test_a_body_fits_where_it_stands_on_the_same_apart_from_all_others(
    space: FreeSpace, x: float, y: float, fits: bool
) -> None:
    """Its own place does not count as taken; off the edge it would fall, on the other table it would be
    elsewhere; and it is back where it was after each question.
    """
    assert CLEARANCE_M == 0.005
    before = space._copy.pose("Cup")
    assert space.fits("Cup", on_table(x, y)) is fits
    assert np.array_equal(space._copy.pose("Cup"), before)


def test_neither_on_another_body_nor_in_the_air_nor_in_the_table(space: FreeSpace) -> None:
    assert not space.fits("Cup", on_table(0.3, 0.0, above=SIDE))
    assert not space.fits("Cup", on_table(-0.3, 0.0, above=0.02))
    assert not space.fits("Cup", on_table(-0.3, 0.0, above=-0.01))


def new(x: float, y: float, z: float = TOP, side: float = 0.04) -> Body:
    return Body("new", (Part(Box((side, side, side))),), Pose((x, y, z + side / 2)), True)


@pytest.mark.parametrize(
    ("x", "y", "z", "free"),
    [
        (-0.3, 0.0, TOP, True), (0.0, 0.0, TOP, False), (0.3 - 0.07 - 0.003, 0.0, TOP, False),
        (0.3 - 0.07 - 0.007, 0.0, TOP, True), (0.3, 0.0, TOP + SIDE + CONTACT_GAP, True),
        (-0.3, 0.0, TOP + 0.05, False), (-0.3, 0.0, TOP - 0.01, False),
        (-0.3, 0.0, TOP - CONTACT_GAP - 5e-4, False), (3.0, 3.0, 0.0, True),
        (-0.525, 0.0, TOP, False),
    ],
)  # fmt: skip
def test_a_new_body_is_free_where_it_stands_on_anything_apart_from_the_rest(
    space: FreeSpace, x: float, y: float, z: float, free: bool
) -> None:
    """On the table, on another cube, on the floor; not in the air, in the table or over its edge."""
    assert space.free(new(x, y, z)) is free


def test_a_body_across_two_tables_belongs_on_both() -> None:
    """On one of them alone it would stand as well, but not on the same as before."""
    made = world()
    cube = body("Cup", CUBE, (9.0, 9.0, 9.0))
    made.scene = scene(table(), table("other", (1.0, 0.0)), cube, half=5.0)
    made.pose = lambda name: on_table(0.5, 0.0)
    with FreeSpace(made) as found:
        for x, fits in ((0.5, True), (0.52, True), (0.3, False), (0.7, False)):
            assert found.fits("Cup", on_table(x, 0.1)) is fits


def test_what_the_robot_touches_or_holds_is_not_left_alone() -> None:
    touching = (("hand", "Cup"), ("held", "jar"))
    with FreeSpace(world(touching, bound="held")) as made:
        assert made.untouched == ["jar"]
    with FreeSpace(world()) as made:
        assert sorted(made.untouched) == ["Cup", "held", "jar"]


def test_the_lowest_point_of_a_body_by_its_pddl_name(space: FreeSpace) -> None:
    """PDDL writes names small; a cube on its edge is lower by what its diagonal is longer."""
    turned = Pose.from_xyz_rpy((0.0, 0.0, 2.0), (np.pi / 4, 0.0, 0.0)).matrix
    assert space.lowest("cup", turned) == pytest.approx(2.0 - SIDE / np.sqrt(2) - CONTACT_GAP)
    assert space.lowest("jar", on_table(0.0, 0.0)) == pytest.approx(TOP - CONTACT_GAP)
    assert space.lowest("pan", turned) is None
