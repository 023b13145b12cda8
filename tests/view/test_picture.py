"""The rasteriser against geometry, and pictures that show what is there."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tamp.errors import InputError
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Sphere
from tamp.view.mesh import Mesh, read_mesh, shape_mesh, simplified
from tamp.view.picture import Renderer, framing, write_png, write_video
from tamp.view.rasterizer import BACKGROUND, Camera, render, triangles
from tamp.view.timeline import Timeline, timeline_of
from tests.view.images import pixels

RED, GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0)
FRONT = Camera((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), 40.0)


def volume(mesh: Mesh) -> float:
    """Positive when the faces look outwards."""
    a, b, c = mesh.vertices[mesh.faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def test_shapes_are_closed_and_look_outwards() -> None:
    assert volume(shape_mesh(Box((0.2, 0.3, 0.5)), RED)) == pytest.approx(0.03)
    assert volume(shape_mesh(Cylinder(0.1, 0.4), RED)) == pytest.approx(
        math.pi * 0.01 * 0.4, rel=0.01
    )
    assert volume(shape_mesh(Sphere(0.1), RED)) == pytest.approx(4 / 3 * math.pi * 0.001, rel=0.02)
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    hull = Hull(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
    assert volume(shape_mesh(hull, RED)) == pytest.approx(1 / 6)


def test_a_coarser_mesh_keeps_its_shape() -> None:
    fine = shape_mesh(Sphere(0.5), RED)
    coarse = simplified(fine, 0.15)
    assert len(coarse.faces) < 0.7 * len(fine.faces)
    assert volume(coarse) == pytest.approx(volume(fine), rel=0.1)


def test_a_mesh_file_keeps_its_colours_and_is_scaled(tmp_path: Path) -> None:
    (tmp_path / "m.mtl").write_text("newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n", encoding="utf-8")
    faces = "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\n"
    text = f"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n{faces}"
    (tmp_path / "m.obj").write_text(text, encoding="utf-8")
    meshes = read_mesh(tmp_path / "m.obj", (0.1, 0.1, 0.1), None)
    assert sorted(mesh.colour for mesh in meshes) == [GREEN, RED]
    assert max(float(mesh.vertices.max()) for mesh in meshes) == pytest.approx(0.1)
    (one,) = read_mesh(tmp_path / "m.obj", (1.0, 1.0, 1.0), GREEN)
    assert one.colour == GREEN and len(one.faces) == 2


def test_a_box_covers_the_pixels_that_it_should() -> None:
    image = render([triangles(shape_mesh(Box((1.0, 1.0, 1.0)), RED))], FRONT, (200, 100))
    red = (image[:, :, 0] > 80) & (image[:, :, 1] < 40)
    half = 50 / math.tan(math.radians(20)) * 0.5 / 3.5  # its front is 3.5 m away
    rows, columns = np.nonzero(red)
    assert (rows.min(), rows.max()) == pytest.approx((50 - half, 50 + half - 1), abs=1.0)
    assert (columns.min(), columns.max()) == pytest.approx((100 - half, 100 + half - 1), abs=1.0)
    assert image[2, 2] == pytest.approx(np.round(255 * np.array(BACKGROUND)))


def test_the_nearer_one_hides_the_other() -> None:
    near = shape_mesh(Box((0.5, 0.1, 0.5)), GREEN).moved(
        np.array([[1.0, 0, 0, 0], [0, 1, 0, -1], [0, 0, 1, 0], [0, 0, 0, 1]])
    )
    far = shape_mesh(Box((1.0, 1.0, 1.0)), RED)
    for order in ([near, far], [far, near]):
        middle = render([triangles(mesh) for mesh in order], FRONT, (64, 64))[32, 32]
        assert middle[1] > 100 and middle[0] < 20


def test_what_is_behind_the_eye_is_not_drawn() -> None:
    behind = np.eye(4)
    behind[1, 3] = -8.0
    parts = [
        triangles(shape_mesh(Box((1.0, 1.0, 1.0)), RED).moved(behind)),
        triangles(shape_mesh(Box((0.1,) * 3), GREEN)),
    ]
    image = render(parts, FRONT, (64, 64)).astype(int)
    assert not (image[:, :, 0] > image[:, :, 1] + 50).any()


def test_bodies_throw_shadows() -> None:
    floor = Mesh(
        np.array([[-3.0, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]]),
        np.array([[0, 1, 2], [0, 2, 3]]),
        (0.8,) * 4,
    )
    lifted = np.eye(4)
    lifted[2, 3] = 0.8
    camera = Camera((0.0, -0.5, 6.0), (0.0, 0.0, 0.0))
    box = triangles(shape_mesh(Box((0.5, 0.5, 0.1)), RED).moved(lifted))
    image = render([triangles(floor), box], camera, (120, 120)).astype(int)
    grey = image[np.abs(image[:, :, 0] - image[:, :, 2]) < 5][:, 0]
    levels, counts = np.unique(grey, return_counts=True)
    dark = levels[counts > 20].min()
    assert dark < 0.9 * np.median(grey)


def test_everything_is_in_view(timeline: Timeline) -> None:
    for size in ((800, 600), (400, 900)):
        camera = framing(timeline, size)
        ahead = np.array(camera.target) - np.array(camera.eye)
        ahead /= np.linalg.norm(ahead)
        right = np.cross(ahead, [0.0, 0.0, 1.0])
        right /= np.linalg.norm(right)
        up = np.cross(right, ahead)
        half = math.tan(math.radians(camera.angle) / 2)
        for body in timeline.scene.bodies.values():
            offset = np.array(body.pose.position) - camera.eye
            depth = offset @ ahead
            assert abs(offset @ up) < half * depth
            assert abs(offset @ right) < half * depth * size[0] / size[1]


def test_a_picture_shows_start_middle_and_end(timeline: Timeline, tmp_path: Path) -> None:
    file = tmp_path / "new" / "plan.png"
    write_png(timeline, file, size=(200, 150))
    image = pixels(file)
    assert image.shape == (150, 600, 3)
    first, middle, last = np.split(image, 3, axis=1)
    assert min(part.std() for part in (first, middle, last)) > 20.0
    assert min(np.abs(first - middle).mean(), np.abs(middle - last).mean()) > 1.0
    write_png(timeline, file, times=(0.0,), size=(200, 150))
    assert pixels(file) == pytest.approx(first)
    write_png(timeline_of(timeline.scene, timeline.robot), file, size=(200, 150))
    assert pixels(file).shape == (150, 200, 3)


def test_the_hand_leaves_its_path_behind(timeline: Timeline) -> None:
    """Against the same pictures without paths: what else is orange, and where the plan leads, do not count."""
    renderer, bare = Renderer(timeline, (400, 300)), Renderer(timeline, (400, 300))
    bare._trails = []
    seen: list[int] = []
    for share in (0.0, 0.5, 1.0):
        with_path, without = (
            one.frame(share * timeline.duration).astype(int) for one in (renderer, bare)
        )
        orange = (with_path[:, :, 0] - with_path[:, :, 2] > 110) & (with_path[:, :, 1] < 160)
        seen.append(int((orange & (with_path != without).any(axis=2)).sum()))
    assert seen[0] == 0 and 0 < seen[1] <= seen[2] and seen[2] > 40


@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_a_moving_picture_moves(timeline: Timeline, tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"plan{suffix}"
    write_video(timeline, file, speed=timeline.duration / 0.5, size=(96, 72))
    with Image.open(file) as image:
        assert getattr(image, "n_frames") == 5  # noqa: B009
        assert image.size == (96, 72)
        first = np.asarray(image.convert("RGB"), dtype=float)
        image.seek(4)
        assert np.abs(np.asarray(image.convert("RGB"), dtype=float) - first).mean() > 1.0


def test_what_cannot_be_written_is_an_input_error(timeline: Timeline, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="cannot write the picture"):
        write_png(timeline, tmp_path / "file" / "out.png", times=(0.0,), size=(32, 32))
    with pytest.raises(
        InputError, match=r"no moving picture is written as '\.mp4'. Choices: \.gif, \.webp"
    ):
        write_video(timeline, tmp_path / "out.mp4")
    with pytest.raises(InputError, match="nothing moves without a plan"):
        write_video(timeline_of(timeline.scene, timeline.robot), tmp_path / "out.gif")
