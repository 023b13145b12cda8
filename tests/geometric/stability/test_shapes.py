from __future__ import annotations

from dataclasses import replace

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Hull, Part
from tamp.geometric.stability.shapes import MAX_CACHED_SHAPES, once_a_shape

CORNERS = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def _tetrahedron(scale: float = 1.0) -> Body:
    return Body("one", (Part(Hull(CORNERS * scale, FACES)),), Pose((1.0, 0.0, 0.0)), movable=True)


def _counting() -> tuple[list[Body], object]:
    asked: list[Body] = []

    @once_a_shape
    def look(body: Body) -> int:
        asked.append(body)
        return len(asked)

    return asked, look


def test_bodies_of_one_shape_are_looked_at_once_wherever_they_stand_and_whatever_their_name() -> (
    None
):
    asked, look = _counting()
    again = replace(_tetrahedron(), name="other", pose=Pose((0.0, 2.0, 0.0)), mass=3.0)
    assert look(_tetrahedron()) == look(again) == 1  # type: ignore[operator]
    assert len(asked) == 1


def test_another_scale_place_of_a_part_or_centre_of_mass_is_another_shape() -> None:
    _, look = _counting()
    moved = replace(_tetrahedron(), parts=(Part(_tetrahedron().parts[0].shape, Pose((0.1, 0, 0))),))
    bodies = [
        _tetrahedron(), _tetrahedron(1.5), moved,
        replace(_tetrahedron(), center_of_mass=(0.01, 0.0, 0.0)),
        replace(_tetrahedron(), parts=(Part(Box((0.1, 0.1, 0.1))),)),
    ]  # fmt: skip
    assert [look(body) for body in bodies] == [1, 2, 3, 4, 5]  # type: ignore[operator]


def test_no_more_shapes_are_remembered_than_said() -> None:
    asked, look = _counting()
    for k in range(MAX_CACHED_SHAPES + 1):
        look(_tetrahedron(1.0 + k))  # type: ignore[operator]
    look(_tetrahedron(1.0 + MAX_CACHED_SHAPES))  # type: ignore[operator]
    assert len(asked) == MAX_CACHED_SHAPES + 1
    look(_tetrahedron(1.0))  # type: ignore[operator]
    assert len(asked) == MAX_CACHED_SHAPES + 2
