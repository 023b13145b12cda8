"""The pieces of a mesh file: computed once, kept under content and scale, shipped with shipped meshes."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.loading.decomposition import decompose
from tamp.geometric.loading.mesh_pieces import compute_pieces, mesh_pieces, pieces_name
from tamp.geometric.loading.mesh_surface import open_edges
from tamp.geometric.loading.meshes import find_mesh, load_mesh
from tamp.geometric.scene.scene import Hull
from tamp.system.files import cache_folder, shipped
from tests.clock import unhindered
from tests.geometric.loading.mesh_files import CUBE, CUBE_FACES, ONE, corner, hulls, write_obj

pytestmark = pytest.mark.usefixtures("own_cache")


def test_a_nearly_convex_mesh_is_one_hull() -> None:
    mesh = load_mesh(find_mesh("objects/mustard_bottle.obj", Path()))
    assert len(mesh.parts) == 1 and not mesh.warnings
    assert np.ptp(hulls(mesh)[0], axis=0) == pytest.approx((0.095, 0.058, 0.19), abs=1e-6)


def test_hulls_are_closed_turned_outward_and_read_only() -> None:
    mesh = load_mesh(find_mesh("objects/bowl.obj", Path()))
    assert mesh.parts
    for part in mesh.parts:
        assert isinstance(part.shape, Hull)
        vertices, faces = part.shape.vertices, part.shape.faces
        assert open_edges(faces) == 0
        a, b, c = vertices[faces].transpose(1, 0, 2)
        outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - vertices.mean(axis=0))
        assert (outward > 0).all()
        with pytest.raises(ValueError, match="read-only"):
            vertices[0, 0] = 1.0


def test_the_same_file_gives_the_same_pieces() -> None:
    path = find_mesh("objects/mustard_bottle.obj", Path())
    vertices, faces = corner()
    for first, second in ((compute_pieces(path, ONE)[0], compute_pieces(path, ONE)[0]),):
        assert all(
            np.array_equal(a.vertices, b.vertices) for a, b in zip(first, second, strict=True)
        )
    again = decompose(vertices, faces)
    assert all(np.array_equal(a, b) for a, b in zip(decompose(vertices, faces), again, strict=True))


def test_shipped_pieces_are_what_would_be_computed() -> None:
    folder = shipped("problems") / "assets" / "pieces"
    for name, factor in (("objects/mustard_bottle.obj", 1.0), ("objects/mug_col.obj", 0.85)):
        path, scale = find_mesh(name, Path()), (factor,) * 3
        assert (folder / pieces_name(path, scale)).is_file()
        kept, _ = mesh_pieces(path, scale)
        new, _ = compute_pieces(path, scale)
        assert all(np.allclose(a.vertices, b.vertices) for a, b in zip(kept, new, strict=True))
    assert not cache_folder().exists()


def test_the_second_load_reads_the_cache(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "corner.obj", *corner())
    first = load_mesh(path)
    kept = list((cache_folder() / "meshes").iterdir())
    assert [file.suffix for file in kept] == [".npz"]
    started = unhindered()
    second = load_mesh(path)
    assert unhindered() - started < 0.1
    assert all(np.array_equal(a, b) for a, b in zip(hulls(first), hulls(second), strict=True))
    code = (
        "import sys; from pathlib import Path; from tamp.geometric.loading.meshes import load_mesh;"
    )
    code += f"load_mesh(Path({str(path)!r}));"
    code += "print([name for name in ('trimesh', 'scipy') if name in sys.modules])"
    assert (
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        ).stdout
        == "[]\n"
    )
    kept[0].write_bytes(b"broken")
    third = load_mesh(path)
    assert all(np.array_equal(a, b) for a, b in zip(hulls(first), hulls(third), strict=True))
    assert kept[0].stat().st_size > 100


def test_another_content_or_scale_is_another_entry(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)
    assert np.ptp(hulls(load_mesh(path))[0], axis=0) == pytest.approx((0.1, 0.1, 0.1))
    assert np.ptp(hulls(load_mesh(path, (2.0, 1.0, 0.5)))[0], axis=0) == pytest.approx(
        (0.2, 0.1, 0.05)
    )
    write_obj(path, np.array(CUBE) * 3, CUBE_FACES)
    assert np.ptp(hulls(load_mesh(path))[0], axis=0) == pytest.approx((0.3, 0.3, 0.3))


def test_a_cache_that_cannot_be_written_is_no_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("TAMP_CACHE", str(tmp_path / "file" / "below"))
    assert load_mesh(write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)).parts


def test_the_name_of_kept_pieces_tells_all_that_they_depend_on(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)
    other = write_obj(tmp_path / "other.obj", CUBE, CUBE_FACES)
    turned = (0.0, 0.0, 1.0, 0.0)
    names = {pieces_name(path, ONE), pieces_name(path, (1.0, 1.0, 2.0)), pieces_name(other, ONE)}
    names |= {pieces_name(path, ONE, turned), pieces_name(path, ONE, (0.0, 1.0, 0.0, 0.0))}
    assert len(names) == 5
    assert pieces_name(path, ONE) == pieces_name(path, ONE)
    other.rename(tmp_path / "in another folder.obj")
    (tmp_path / "below").mkdir()
    again = write_obj(tmp_path / "below" / "cube.obj", CUBE, CUBE_FACES)
    assert pieces_name(again, ONE) == pieces_name(path, ONE)


def test_pieces_are_wanted_in_another_frame(tmp_path: Path) -> None:
    """A cube of 0.2 x 0.1 x 0.05 m from the origin on, turned by a quarter about z."""
    path = write_obj(tmp_path / "cube.obj", CUBE, CUBE_FACES)
    quarter = (0.0, 0.0, 0.5**0.5, 0.5**0.5)
    ((hull,), _) = mesh_pieces(path, (2.0, 1.0, 0.5), quarter)
    assert hull.vertices.min(axis=0) == pytest.approx((-0.1, 0.0, 0.0), abs=1e-9)
    assert hull.vertices.max(axis=0) == pytest.approx((0.0, 0.2, 0.05), abs=1e-9)


def test_what_is_kept_is_read_back_with_its_warnings(tmp_path: Path) -> None:
    path = write_obj(tmp_path / "open.obj", CUBE, CUBE_FACES[:-1])
    computed, kept = mesh_pieces(path, ONE), mesh_pieces(path, ONE)
    assert "not watertight" in kept[1][0] and kept[1] == computed[1]
    for a, b in zip(computed[0], kept[0], strict=True):
        assert np.array_equal(a.vertices, b.vertices) and np.array_equal(a.faces, b.faces)
        assert not b.vertices.flags.writeable and not b.faces.flags.writeable


def test_one_hull_up_to_fifteen_percent_of_air(tmp_path: Path) -> None:
    """A cube with a pit in its top, whose volume is a third of its depth: 12 % and 18 % of air."""
    for air, pieces in ((0.12, 1), (0.18, 2)):
        depth = 0.3 * (1 - 1 / (1 + air))  # a pyramid's volume is a third of base times height
        vertices = [*CUBE, (0.05, 0.05, 0.1 - depth)]
        sides = [face for face in CUBE_FACES if not all(CUBE[k][2] == 0.1 for k in face)]
        top = [1, 5, 7, 3]
        pit = [(a, b, 8) for a, b in zip(top, [*top[1:], top[0]], strict=True)]
        path = write_obj(tmp_path / f"pit{pieces}.obj", vertices, [*sides, *pit])
        hulls, warnings = compute_pieces(path, ONE)
        assert not warnings and (len(hulls) > 1) is (pieces > 1)
