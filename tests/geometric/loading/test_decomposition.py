"""Convex pieces cover a mesh closely, its notches as well, and are the same for the same mesh."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial import ConvexHull

from tamp.geometric.loading.decomposition import (
    _MOST_TRIANGLES,
    MOST_PIECES,
    _clip,
    _closed,
    _coarser,
    _grid,
    _Piece,
    _winding,
    decompose,
)
from tamp.geometric.loading.mesh_surface import open_edges, read_surface
from tamp.geometric.loading.meshes import find_mesh
from tests.geometric.loading.mesh_files import ONE, beyond, corner, on_surface

pytestmark = pytest.mark.usefixtures("own_cache")


@pytest.mark.parametrize("name", ["objects/bowl.obj", "objects/mug.obj"])
def test_pieces_contain_a_hollow_mesh_closely(name: str) -> None:
    scale = (0.05,) * 3 if "duck" in name else ONE
    surface = read_surface(find_mesh(name, Path()), scale)  # type: ignore[arg-type]
    pieces = decompose(surface.vertices, surface.faces)
    assert 1 < len(pieces) <= MOST_PIECES
    assert beyond(on_surface(surface.vertices, surface.faces, 5000), pieces).max() < 0.001
    total = sum(ConvexHull(piece).volume for piece in pieces)
    assert total < 0.5 * ConvexHull(surface.vertices).volume or "duck" in name
    assert total < 0.9 * ConvexHull(surface.vertices).volume


def test_pieces_contain_the_solid_where_cuts_meet_inside_it() -> None:
    vertices, faces = corner()
    assert open_edges(faces) == 0
    pieces = decompose(vertices, faces)
    points = np.random.default_rng(0).uniform(0, 0.2, size=(4000, 3))
    solid = points[(points < 0.1).any(axis=1)]
    assert len(solid) > 3000
    assert beyond(solid, pieces).max() < 1e-6
    assert sum(ConvexHull(piece).volume for piece in pieces) == pytest.approx(
        0.2**3 * 7 / 8, rel=0.02
    )


@pytest.mark.parametrize("most", [1, 2, 4])
def test_there_are_never_more_pieces_than_asked_for(most: int) -> None:
    vertices, faces = corner()
    pieces = decompose(vertices, faces, most)
    assert len(pieces) == min(most, 3)  # three suffice
    assert beyond(vertices, pieces).max() < 0.001
    if (
        most == 1
    ):  # the hull: the notch of a cube of 0.2 m, but for its outermost corner's tetrahedron
        assert ConvexHull(pieces[0]).volume == pytest.approx(0.2**3 - 0.1**3 / 6, rel=0.01)


def test_the_grid_tells_solid_from_the_air_within_the_hull() -> None:
    """Of the 40^3 points of a cube without an octant 7/8 are solid; in the hull is 5/6 of the octant."""
    vertices, faces = corner()
    inside, air = _grid(vertices[faces], vertices.min(axis=0), vertices.max(axis=0))
    assert len(inside) == 40**3 * 7 // 8 and (inside < 0.1).any(axis=1).all()
    assert (air > 0.1).all()
    assert len(air) == pytest.approx(20**3 * 5 / 6, rel=0.05)


@pytest.mark.parametrize(
    ("point", "expected"),
    [((0.05, 0.05, 0.05), 1.0), ((0.15, 0.15, 0.15), 0.0), ((0.15, 0.05, 0.1), 1.0),
     ((0.5, 0.0, 0.0), 0.0)],
)  # fmt: skip
def test_the_surface_winds_once_round_what_is_inside(
    point: tuple[float, float, float], expected: float
) -> None:
    """A cube without an octant: in it, in its notch, beside the notch, outside."""
    vertices, faces = corner()
    assert _winding(np.array(point), vertices[faces]) == pytest.approx(expected, abs=1e-9)


def test_triangles_are_clipped_to_the_half_below() -> None:
    """A right triangle of legs 1, cut at half of its height: 1/4 of its area above, 3/4 below."""
    triangle = np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]])
    for sign, area in ((1.0, 0.375), (-1.0, 0.125)):
        kept = _clip(triangle, np.array([0.0, 0.0, sign]), sign * 0.5)
        a, b, c = kept.transpose(1, 0, 2)
        crosses = np.cross(b - a, c - a)
        assert np.linalg.norm(crosses, axis=1).sum() / 2 == pytest.approx(area)
        assert (crosses[:, 1] < 0.0).all()  # turned as before
        assert (sign * kept[:, :, 2] <= sign * 0.5 + 1e-12).all()
    assert len(_clip(triangle, np.array([0.0, 0.0, 1.0]), -0.1)) == 0
    assert np.array_equal(_clip(triangle, np.array([0.0, 0.0, 1.0]), 2.0), triangle)


def test_a_fine_surface_is_simplified_but_still_contained() -> None:
    """A ball of 20480 triangles, of which some thousand are cut."""
    ball = trimesh.creation.icosphere(subdivisions=5, radius=0.1)
    vertices, faces = np.array(ball.vertices), np.array(ball.faces)
    assert len(faces) > _MOST_TRIANGLES >= len(_coarser(vertices[faces])) > 1000
    pieces = decompose(vertices, faces)
    assert beyond(vertices, pieces).max() < 0.0005
    assert np.abs(np.concatenate(pieces)).max() <= 0.1 + 1e-9


@pytest.mark.parametrize(
    ("at", "least", "added"),
    [
        ((0.05, 0.05, 0.05), 0.05, [(0.05, 0.05, 0.05)]),
        ((0.05, 0.15, 0.15), 0.15, [(0.05, 0.15, 0.15)]),
        ((0.15, 0.15, 0.15), 0.15, []),  # in the notch
        (
            (0.05, 0.05, 0.05),
            0.04,
            [(0.04, 0.05, 0.05)],
        ),  # another cut leaves the first corner outside
    ],
)
def test_where_cuts_meet_in_the_solid_the_cell_has_a_corner(
    at: tuple[float, ...], least: float, added: list[tuple[float, ...]]
) -> None:
    """The cell x <= at of a cube whose octant from 0.1 m on is air, and x <= least once more."""
    vertices, faces = corner()
    planes = np.array([(1, 0, 0, at[0]), (0, 1, 0, at[1]), (0, 0, 1, at[2]), (1, 0, 0, least)])
    nothing, surface = np.zeros((0, 3)), vertices[faces]
    points = _closed(_Piece(surface[:1], planes, nothing, nothing, 0.0, 0.0), surface)
    assert {tuple(row) for row in np.round(points[3:], 9).tolist()} == set(added)
