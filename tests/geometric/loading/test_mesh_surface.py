"""A mesh's surface: repaired where it is open, turned outward, refused where it is no solid."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from tamp.errors import InputError
from tamp.geometric.loading.mesh_surface import open_edges, read_surface
from tamp.geometric.loading.meshes import load_mesh
from tamp.system.files import cache_folder
from tests.geometric.loading.mesh_files import (
    CUBE,
    CUBE_FACES,
    ONE,
    beyond,
    corner,
    hulls,
    on_surface,
    write_obj,
)

pytestmark = pytest.mark.usefixtures("own_cache")


def test_an_open_mesh_is_closed_with_a_warning(tmp_path: Path) -> None:
    mesh = load_mesh(write_obj(tmp_path / "open.obj", CUBE, CUBE_FACES[:-1]))
    assert len(mesh.parts) == 1 and ConvexHull(hulls(mesh)[0]).volume == pytest.approx(0.001)
    assert (
        len(mesh.warnings) == 1
        and "not watertight (3 open edges): they were closed" in mesh.warnings[0]
    )


def test_a_mesh_that_stays_open_is_taken_as_a_surface(tmp_path: Path) -> None:
    vertices, faces = corner()
    keep = ~((vertices[faces][:, :, 2] == 0).all(axis=1))
    keep[:6] &= np.arange(6) % 3 > 0
    mesh = load_mesh(write_obj(tmp_path / "open.obj", vertices, faces[keep]))
    assert mesh.warnings and "not watertight" in mesh.warnings[0]
    assert beyond(on_surface(vertices, faces[keep], 2000), hulls(mesh)).max() < 0.001


def test_corners_apart_and_inside_out_are_repaired(tmp_path: Path) -> None:
    """A triangle soup, as STL holds it, with its corners rounded apart, and a cube turned inside out."""
    soup = np.array(CUBE)[np.array(CUBE_FACES)].reshape(-1, 3)
    apart = soup + np.random.default_rng(0).uniform(-1e-7, 1e-7, soup.shape)
    for points in (soup, apart):
        mesh = load_mesh(write_obj(tmp_path / "soup.obj", points, np.arange(36).reshape(-1, 3)))
        assert len(mesh.parts) == 1
    surface = read_surface(
        write_obj(tmp_path / "out.obj", CUBE, np.array(CUBE_FACES)[:, ::-1]), ONE
    )
    assert surface.volume == pytest.approx(0.001) and not surface.warnings


def test_two_bodies_that_touch_are_closed(tmp_path: Path) -> None:
    vertices = np.concatenate([CUBE, np.add(CUBE, (0.1, 0.1, 0))])
    faces = np.concatenate([CUBE_FACES, np.array(CUBE_FACES) + 8])
    mesh = load_mesh(write_obj(tmp_path / "two.obj", vertices, faces))
    assert not mesh.warnings and len(mesh.parts) == 2
    assert sum(ConvexHull(piece).volume for piece in hulls(mesh)) == pytest.approx(0.002, rel=0.01)


@pytest.mark.parametrize(
    ("vertices", "faces", "message"),
    [
        ([], [], "empty|cannot read"),
        (CUBE, [], "empty|cannot read"),
        ([*CUBE[:-1], (float("nan"), 0, 0)], CUBE_FACES, "not finite"),
        ([*CUBE[:-1], (float("inf"), 0, 0)], CUBE_FACES, "not finite"),
        ([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)], "flat"),
        ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)], "one line"),
        ([(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 1, 1)], "no area|one line"),
        (np.array(CUBE) * 1000, CUBE_FACES, "100 x 100 x 100 m large.*scale: 0.001"),
        (np.where(np.array(CUBE) > 0, 1e308, -1e308), CUBE_FACES, "inf x inf x inf m large"),
        (np.array(CUBE) / 1000, CUBE_FACES, "m small.*scale: 1000"),
    ],
)
def test_what_is_no_solid_is_refused(
    tmp_path: Path, vertices: object, faces: object, message: str
) -> None:
    path = write_obj(tmp_path / "bad.obj", vertices, faces)
    with pytest.raises(InputError, match=message) as caught:
        load_mesh(path)
    assert "bad.obj" in caught.value.message and "\n" not in str(caught.value)
    assert not cache_folder().exists()


@pytest.mark.parametrize(
    ("faces", "count"),
    [
        ([(0, 1, 2)], 3),
        ([(0, 1, 2), (2, 1, 3)], 4),
        ([(0, 1, 2), (1, 2, 3)], 5),  # turned differently: the edge between is open as well
        (CUBE_FACES, 0),
        (CUBE_FACES[1:], 3),
        ([*CUBE_FACES, *CUBE_FACES], 0),
    ],
)
def test_edges_run_through_once_each_way_are_closed(faces: list, count: int) -> None:
    assert open_edges(np.array(faces)) == count


@pytest.mark.parametrize("scale", [ONE, (-1.0, 1.0, 1.0), (2.0, -3.0, -1.0)])
def test_scaled_and_mirrored_it_stays_outward(
    tmp_path: Path, scale: tuple[float, float, float]
) -> None:
    surface = read_surface(write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES), scale)
    a, b, c = surface.vertices[surface.faces].transpose(1, 0, 2)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    assert surface.volume == pytest.approx(0.001 * abs(np.prod(scale))) == volume


def test_two_sheets_enclose_nothing(tmp_path: Path) -> None:
    """Opposite sides of a cube: each is closed by its own back, without a warning of a division by no volume."""
    surface = read_surface(write_obj(tmp_path / "sides.obj", CUBE, CUBE_FACES[:4]), ONE)
    assert surface.volume is None and open_edges(surface.faces) == 0
    assert surface.warnings == (
        "the mesh 'sides.obj' is not watertight (8 open edges): they were closed",
    )


def test_a_surface_that_stays_open_faces_the_same_way_when_it_is_mirrored(tmp_path: Path) -> None:
    """A cube without an octant about its middle, without its bottom and more."""
    vertices, faces = corner()
    keep = ~((vertices[faces][:, :, 2] == 0).all(axis=1))
    keep[:6] &= np.arange(6) % 3 > 0
    file = write_obj(tmp_path / "open.obj", vertices - 0.1, faces[keep])
    volumes = []
    for scale in (ONE, (1.0, -1.0, 1.0)):
        surface = read_surface(file, scale)
        assert surface.volume is None and "stay open" in surface.warnings[0]
        a, b, c = surface.vertices[surface.faces].transpose(1, 0, 2)
        volumes.append(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
    assert volumes[0] == pytest.approx(volumes[1]) and volumes[0] > 0.002
