"""Rasterizer: triangles to pixels by a depth buffer (z-buffer), with a light and its shadows; no
window, graphics card or driver.

Not pybullet's software renderer, which was tried on one picture (`one_object`, 960 x 720): it
took 0.29 s of processor time against 0.20 s here, drew jagged edges and the shadow of a table's top
on that top itself, and is there with one of the two engines only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array
from tamp.system.compilation import njit
from tamp.view.mesh import Mesh, unit

NEAR = 0.05
"""Metres before the eye within which nothing is drawn."""

FINE = 2
"""Each pixel is the mean of this many by this many."""

CREASE = 0.75
"""Cosine of the angle between faces below which their edge is drawn sharp."""

SUN: Array = unit(np.array([0.35, -0.5, 0.8]))
"""Where the light comes from."""

MAP, SMALL_MAP, SMALL = 2048, 1024, 400
"""Cells across the map of shadows, and across that of a picture with fewer rows than SMALL."""

BIAS = 0.012
"""Metres that a shadow's surface keeps from itself."""

SHADOW = 0.55
"""What is left of the sun's light in the shadow."""

BACKGROUND = (0.94, 0.95, 0.96)


@dataclass(frozen=True)
class Camera:
    """A camera: where the eye is and what it looks at, metres in the world; the angle of view from
    top to bottom, degrees.
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    angle: float = 40.0


@dataclass(frozen=True, eq=False)
class Triangles:
    """Corners (n, 3, 3) in the world, their normals (n, 3, 3), and colours (n, 3)."""

    corners: Array
    normals: Array
    colours: Array

    def moved(self, T_a_b: Array) -> Triangles:
        """Transform the triangles of frame b to frame a."""
        turn = T_a_b[:3, :3].T
        return Triangles(self.corners @ turn + T_a_b[:3, 3], self.normals @ turn, self.colours)


def triangles(mesh: Mesh) -> Triangles:
    """Shade a mesh with the normals of its corners: shared where faces meet smoothly, the face's
    own at edges.

    Faces share a normal by their angles at the vertex (Thuermer and Wuethrich 1998): by area, or
    by number, the corner of a box would lean to the side that is cut into more triangles there.
    """
    corners = mesh.vertices[mesh.faces]
    own = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    along = unit(np.roll(corners, -1, axis=1) - corners)
    back = -np.roll(along, 1, axis=1)
    angles = np.arccos(np.clip(np.einsum("nij,nij->ni", along, back), -1.0, 1.0))
    _, member = np.unique(np.round(mesh.vertices, 5), axis=0, return_inverse=True)
    member = member.ravel()[mesh.faces]
    summed = np.zeros((int(member.max(initial=0)) + 1, 3))
    for corner in range(3):
        np.add.at(summed, member[:, corner], angles[:, corner, None] * own)
    own = np.repeat(own[:, None], 3, axis=1)
    shared = unit(summed)[member]
    smooth = np.einsum("nij,nij->ni", own, shared) > CREASE
    colours = np.repeat(np.array([mesh.colour[:3]]), len(corners), axis=0)
    return Triangles(corners, np.where(smooth[:, :, None], shared, own), colours)


def render(parts: Sequence[Triangles], camera: Camera, size: tuple[int, int]) -> NDArray[np.uint8]:
    """Render a picture.

    Args:
        parts: In the world.
        camera: Who looks.
        size: Columns and rows.

    Returns:
        Rows x columns x RGB.
    """
    corners = np.concatenate([part.corners for part in parts])
    normals = np.concatenate([part.normals for part in parts])
    colours = np.concatenate([part.colours for part in parts])
    columns, rows = size[0] * FINE, size[1] * FINE
    screen = _screen(corners, camera, columns, rows)
    depth, ids = np.full((rows, columns), np.inf), np.full((rows, columns), -1, dtype=np.int32)
    weights = np.zeros((rows, columns, 3), dtype=np.float32)
    _fill(screen, True, depth, ids, weights)
    frame, scale, offset, shadows = _shadows(corners, SMALL_MAP if size[1] < SMALL else MAP)
    pixels = np.empty((rows, columns, 3))
    _shade(
        ids, weights, corners, normals, colours, np.array(camera.eye), SUN, np.array(BACKGROUND),
        frame, scale, offset, shadows, pixels,
    )  # fmt: skip
    total = sum(pixels[down::FINE, across::FINE] for down in range(FINE) for across in range(FINE))
    return np.round(255.0 / FINE**2 * total).astype(np.uint8)


def _screen(corners: Array, camera: Camera, columns: int, rows: int) -> Array:
    """Project corners to columns, rows and distances, shape (n, 3, 3)."""
    eye, target = np.array(camera.eye), np.array(camera.target)
    ahead = unit((target - eye)[None])[0]
    right = unit(np.cross(ahead, [0.0, 0.0, 1.0])[None])[0]
    view = (corners - eye) @ np.stack([right, np.cross(ahead, right), ahead], axis=1)
    depth = np.where(view[:, :, 2] > NEAR, view[:, :, 2], -1.0)
    scale = rows / 2 / np.tan(np.radians(camera.angle) / 2)
    plane = view[:, :, :2] / np.where(depth > 0.0, depth, 1.0)[:, :, None] * scale
    return np.concatenate([plane + np.array([columns / 2, rows / 2]), depth[:, :, None]], axis=2)


def _shadows(corners: Array, cells: int) -> tuple[Array, Array, Array, Array]:
    """Compute the shadow map, what the sun sees: the axes (3, 3) of its view, the scale and offset
    (3,) of its map, the map of distances.
    """
    side = unit(np.cross(SUN, np.array([0.0, 0.0, 1.0])))
    frame = np.stack([side, np.cross(SUN, side), -SUN], axis=1)
    raised = corners[corners[:, :, 2].max(axis=1) > 0.001]  # the floor throws no shadow
    raised = raised if len(raised) else corners
    seen = raised @ frame
    low, high = seen.min(axis=(0, 1)), seen.max(axis=(0, 1))
    scale = np.full(3, (cells - 3) / float((high - low)[:2].max()))
    scale[2] = 1.0
    offset = 1.0 - low * scale  # columns, rows and distances from 1 on
    depth, ids = np.full((cells, cells), np.inf), np.full((cells, cells), -1, dtype=np.int32)
    _fill(seen * scale + offset, False, depth, ids, np.zeros((1, 1, 3), dtype=np.float32))
    return frame, scale, offset, depth


@njit(cache=True)
def _fill(screen, perspective, depth, ids, weights):
    """Enter triangles (n, 3, [column, row, distance]) into a depth buffer; those partly behind the
    eye are left out.
    """
    rows, columns = depth.shape
    for n in range(screen.shape[0]):
        ax, ay, az = screen[n, 0, 0], screen[n, 0, 1], screen[n, 0, 2]
        bx, by, bz = screen[n, 1, 0], screen[n, 1, 1], screen[n, 1, 2]
        cx, cy, cz = screen[n, 2, 0], screen[n, 2, 1], screen[n, 2, 2]
        if min(az, bz, cz) <= 0.0:
            continue
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0.0:
            continue
        left, right = max(0, int(min(ax, bx, cx))), min(columns - 1, int(max(ax, bx, cx)))
        top, bottom = max(0, int(min(ay, by, cy))), min(rows - 1, int(max(ay, by, cy)))

        for row in range(top, bottom + 1):
            y = row + 0.5
            for column in range(left, right + 1):
                x = column + 0.5
                u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                w = 1.0 - u - v
                if u < 0.0 or v < 0.0 or w < 0.0:
                    continue
                if perspective:
                    u, v, w = u / az, v / bz, w / cz
                    z = 1.0 / (u + v + w)
                    u, v, w = u * z, v * z, w * z
                else:
                    z = u * az + v * bz + w * cz

                if z < depth[row, column]:
                    depth[row, column] = z
                    ids[row, column] = n
                    if perspective:
                        weights[row, column, 0] = u
                        weights[row, column, 1] = v
                        weights[row, column, 2] = w


@njit(cache=True)
def _shade(
    ids,
    weights,
    corners,
    normals,
    colours,
    eye,
    sun,
    background,
    frame,
    scale,
    offset,
    shadows,
    pixels,
):
    """Shade pixels by the triangles that they see: some light from everywhere, some from above, the
    sun's.
    """
    rows, columns = ids.shape
    last = shadows.shape[0] - 1
    point, normal = np.zeros(3), np.zeros(3)
    for row in range(rows):
        for column in range(columns):
            n = ids[row, column]
            if n < 0:
                pixels[row, column] = background
                continue

            facing, length, lit = 0.0, 0.0, 0.0

            for axis in range(3):
                point[axis], normal[axis] = 0.0, 0.0
                for corner in range(3):
                    point[axis] += weights[row, column, corner] * corners[n, corner, axis]
                    normal[axis] += weights[row, column, corner] * normals[n, corner, axis]
                facing += normal[axis] * (eye[axis] - point[axis])
                length += normal[axis] * normal[axis]

            sign = (1.0 if facing >= 0.0 else -1.0) / max(
                np.sqrt(length), 1e-9
            )  # the inside of what is open shows, too
            for axis in range(3):
                lit += sign * normal[axis] * sun[axis]
            if lit > 0.0:
                x, y, z = offset[0], offset[1], offset[2]
                for axis in range(3):
                    x += point[axis] * frame[axis, 0] * scale[0]
                    y += point[axis] * frame[axis, 1] * scale[1]
                    z += point[axis] * frame[axis, 2] * scale[2]
                light = 0.0
                for across in (-0.7, 0.7):
                    for along in (-0.7, 0.7):
                        c, r = min(max(int(x + across), 0), last), min(max(int(y + along), 0), last)
                        light += 0.25 * (SHADOW if z - BIAS > shadows[r, c] else 1.0)
                lit *= light

            brightness = 0.5 + 0.12 * sign * normal[2] + 0.45 * max(lit, 0.0)
            for axis in range(3):
                pixels[row, column, axis] = min(max(colours[n, axis] * brightness, 0.0), 1.0)
