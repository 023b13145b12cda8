"""Overlaps are found with the depth by which one body has to move, and touching is none."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tamp.geometric.loading.overlaps import OVERLAP_TOLERANCE_M, Overlap, find_overlaps
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Shape, Sphere
from tests.geometric.making import body, cuboid, hull, scene

CUBE = Box((0.2, 0.2, 0.2))


def overlaps(*bodies: Body) -> list[Overlap]:
    return list(find_overlaps(scene(*bodies)))


@pytest.mark.parametrize("shape", [CUBE, hull(cuboid((0.2, 0.2, 0.2)))], ids=["box", "hull"])
@pytest.mark.parametrize("depth", [0.002, 0.01, 0.05])
def test_boxes_overlap_by_what_one_is_in_the_other(shape: Shape, depth: float) -> None:
    (found,) = overlaps(body("a", CUBE, (0, 0, 0.1)), body("b", shape, (0.2 - depth, 0.01, 0.1)))
    assert (found.first, found.second) == ("a", "b")
    assert found.depth == pytest.approx(depth, rel=0.05)


def test_a_ball_in_a_box_and_a_ball_in_a_ball() -> None:
    (found,) = overlaps(body("box", CUBE, (0, 0, 0.1)), body("ball", Sphere(0.1), (0.17, 0, 0.1)))
    assert found.depth == pytest.approx(0.03, rel=0.05)
    slanted = 0.18 * math.sqrt(0.5)
    (found,) = overlaps(
        body("one", Sphere(0.1), (0, 0, 0)), body("two", Sphere(0.1), (slanted, slanted, 0))
    )
    assert found.depth == pytest.approx(0.02, rel=0.05)


@pytest.mark.parametrize(
    ("gap", "count"),
    [(0.01, 0), (0.0, 0), (-0.5 * OVERLAP_TOLERANCE_M, 0), (-2.0 * OVERLAP_TOLERANCE_M, 1)],
)
def test_touching_within_a_millimetre_is_no_overlap(gap: float, count: int) -> None:
    assert len(overlaps(body("a", CUBE, (0, 0, 0)), body("b", CUBE, (0.2 + gap, 0, 0)))) == count


def test_boxes_around_them_may_overlap_where_they_do_not() -> None:
    # Two round cans whose corners of the bounding boxes meet: the circles are apart.
    near = 0.17
    assert (
        overlaps(
            body("a", Cylinder(0.1, 0.2), (0, 0, 0)), body("b", Cylinder(0.1, 0.2), (near, near, 0))
        )
        == []
    )


def test_the_deepest_of_several_parts_counts() -> None:
    comb = Body(
        "comb", tuple(Part(CUBE, Pose((x, 0.0, 0.0))) for x in (-1.0, 0.0, 1.0)), Pose(), True
    )
    pin = body("pin", CUBE, (1.15, 0.0, 0.0))
    (found,) = overlaps(comb, pin)
    assert found.depth == pytest.approx(0.05, rel=0.05)


def test_each_pair_comes_once_in_the_scenes_order() -> None:
    row = [body(name, CUBE, (0.1 * i, 0, 0)) for i, name in enumerate("cab")]
    # The outer two only touch.
    assert [(o.first, o.second) for o in overlaps(*row)] == [("c", "a"), ("a", "b")]


def test_a_turned_body_is_judged_as_it_stands() -> None:
    plank = body("plank", Box((1.0, 0.1, 0.1)), (0, 0, 0))
    post = body("post", CUBE, (0.0, 0.4, 0.0))
    assert overlaps(plank, post) == []
    turned = replace(plank, pose=Pose.from_xyz_yaw(0, 0, 0, math.pi / 2))
    assert [o.second for o in overlaps(turned, post)] == ["post"]


def test_no_bodies_and_one_body() -> None:
    assert overlaps() == [] and overlaps(body("a", CUBE, (0, 0, 0))) == []
