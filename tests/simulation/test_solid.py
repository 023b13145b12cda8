"""How pybullet is told of shapes: one by one, and as the pieces of a compound."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tamp.geometric.scene.scene import Box, Cylinder, Part, Shape, Sphere
from tamp.simulation.solid import arrays, described
from tests.simulation.scenes import cube_hull

BULLET: Any = SimpleNamespace(GEOM_SPHERE=2, GEOM_BOX=3, GEOM_CYLINDER=4, GEOM_MESH=5)
"""Its numbers of kinds of shapes."""


@pytest.mark.parametrize(
    ("shape", "told"),
    [
        (Box((0.2, 0.4, 0.6)), {"shapeType": 3, "halfExtents": [0.1, 0.2, 0.3]}),
        (Cylinder(0.1, 0.6), {"shapeType": 4, "radius": 0.1, "height": 0.6}),
        (Sphere(0.1), {"shapeType": 2, "radius": 0.1}),
    ],
)
def test_a_box_is_told_by_halves_and_a_cylinder_whole(shape: Shape, told: dict[str, Any]) -> None:
    assert described(Part(shape), BULLET) == told


def test_a_hull_is_told_by_its_vertices() -> None:
    told = described(Part(cube_hull(0.2)), BULLET)
    assert told["shapeType"] == 5 and len(told["vertices"]) == 8
    assert told["vertices"][0] == [-0.1, -0.1, -0.1]


def test_in_a_compound_each_piece_has_an_entry_of_every_kind() -> None:
    parts = (Part(Box((0.2, 0.4, 0.6))), Part(Sphere(0.1)), Part(Cylinder(0.3, 0.5)))
    assert arrays([described(part, BULLET) for part in parts]) == {
        "shapeTypes": [3, 2, 4],
        "radii": [0.0, 0.1, 0.3],
        "lengths": [0.0, 0.0, 0.5],
        "halfExtents": [[0.1, 0.2, 0.3], [0.0] * 3, [0.0] * 3],
    }
