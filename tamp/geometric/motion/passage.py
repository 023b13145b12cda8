"""The width of the way that leads the base from its start to anywhere: what lies behind a door that
is too narrow.

The base is thought of as the largest disc in it, and of the fixed bodies there are only slices at
its height: where even the disc cannot go, the base cannot. Movable bodies could be taken away, so
they are left out.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box, Scene
from tamp.geometric.stability.hulls import part_mesh
from tamp.geometric.stability.slices import cut, distances

if TYPE_CHECKING:
    from jaxtyping import Float

MIN_CELL_M = 0.03
"""Side of the cells into which the floor is divided at least, metres."""

MAX_CELLS = 40_000
"""Cells of the floor at most; a larger room has larger ones."""

MAX_CELL_M = 0.08
"""Larger cells than this tell nothing of doors, metres."""

SLICE_SHARES = (0.1, 0.5, 0.9)
"""Heights of the base, as shares, at which the fixed bodies are cut."""

LOOK_SPACING_M = 0.05
"""Spacing of the points that are looked at along a straight way, metres."""

DOOR_SHARE = 1.2
"""Gaps wider than this times the base are no doors that anybody would blame."""


@dataclass(frozen=True, eq=False)
class Slice:
    """A convex polygon (n, 2) of a fixed body at the base's height, counterclockwise, metres."""

    body: str
    corners: Array


@dataclass(frozen=True)
class Gap:
    """The narrowest place (2,) of the widest way: its width and the base's, metres, and the bodies
    beside it.
    """

    place: tuple[float, float]
    width: float
    base: float
    bodies: tuple[str, ...]

    @property
    def text(self) -> str:
        """Say it in words."""
        if self.width < 2 * MIN_CELL_M:
            return f"no way leads there: {' and '.join(self.bodies)} in between"
        return f"the door is {self.width:.2f} m, the base {self.base:.2f} m wide"


class Passage:
    """The floor as the base sees it from its start.

    Args:
        scene: The fixed bodies, the room and where the base starts.
        robot: Whose base is a box; of another one nothing is said.
    """

    def __init__(self, scene: Scene, robot: Robot) -> None:
        self._scene = scene
        box = _base(robot)
        self.radius, self._heights = (0.0, (0.0, 0.0)) if box is None else box
        x, y = scene.room.x, scene.room.y
        self.cell = max(MIN_CELL_M, math.sqrt((x[1] - x[0]) * (y[1] - y[0]) / MAX_CELLS))
        self.is_mapped = box is not None and self.cell <= MAX_CELL_M
        self._start = np.array(scene.robot.base[:2])
        self._open: list[tuple[float, float]] = []

    @property
    def slack(self) -> float:
        """Return what a way through cells may miss of the width of a gap on each side, metres."""
        return self.cell * math.sqrt(0.5) + 1e-3

    @cached_property
    def slices(self) -> list[Slice]:
        """Return the outlines of all fixed bodies at the base's height."""
        low, high = self._heights
        found: list[Slice] = []
        for name in self._scene.fixed:
            body = self._scene.bodies[name]
            for part in body.parts:
                vertices, triangles = part_mesh(part)
                placed = body.pose.apply(vertices)
                for share in SLICE_SHARES:
                    corners = cut(placed, triangles, low + share * (high - low))
                    if corners is not None:
                        found.append(Slice(name, corners))
        return found

    def clearance(self, points: Float[Array, "n 2"]) -> Float[Array, " n"]:
        """Compute the distances (n,) of points (n, 2) from the slices; infinite without any."""
        least = np.full(len(points), np.inf)
        for piece in self.slices:
            np.minimum(least, distances(points, piece.corners), out=least)
        return least

    def open_towards(self, target: Float[Array, " 2"], reach: float) -> bool:
        """Check whether the disc gets within `reach` metres of a point (2,) in a straight line, or
        in two.
        """
        x, y = float(target[0]), float(target[1])
        # As for most poses, after the first few.
        if any(math.hypot(a - x, b - y) <= reach for a, b in self._open):
            return True

        for middle in (
            None,
            *(
                self._start + 1.2 * np.array([math.cos(a), math.sin(a)])
                for a in np.arange(8) * 0.785
            ),
        ):
            first = self._start if middle is None else middle
            way = target - first
            distance = float(np.linalg.norm(way))
            last = first + way * max(0.0, 1.0 - 0.8 * reach / max(distance, 1e-9))
            corners = [self._start, last] if middle is None else [self._start, middle, last]
            if all(self._inside(point) for point in corners) and self._free(corners):
                self._open.append((float(last[0]), float(last[1])))
                return True

        return False

    def _inside(self, point: Array) -> bool:
        x, y = self._scene.room.x, self._scene.room.y
        return bool(x[0] <= point[0] <= x[1] and y[0] <= point[1] <= y[1])

    def _free(self, corners: list[Array]) -> bool:
        points: list[Array] = []
        for a, b in pairwise(corners):
            count = max(2, math.ceil(float(np.linalg.norm(b - a)) / LOOK_SPACING_M))
            points += [a + share * (b - a) for share in np.linspace(0.0, 1.0, count)]
        return bool((self.clearance(np.array(points)) >= self.radius).all())

    @cached_property
    def _floor(self) -> tuple[Array, Array, Array]:
        """Return coordinates of the cells along x and y, and their clearances (nx, ny)."""
        room = self._scene.room
        xs = np.arange(room.x[0], room.x[1] + self.cell, self.cell)
        ys = np.arange(room.y[0], room.y[1] + self.cell, self.cell)
        points = np.stack(np.meshgrid(xs, ys, indexing="ij"), axis=-1).reshape(-1, 2)
        return xs, ys, self.clearance(points).reshape(len(xs), len(ys))

    @cached_property
    def _widest(self) -> tuple[Array, NDArray[np.intp]]:
        """Return for each cell the clearance of the widest way from the start, and the cell before
        it on that way.
        """
        xs, ys, free = self._floor
        columns = len(ys)
        flat = free.ravel().tolist()
        i = int(np.argmin(np.abs(xs - self._start[0])))
        start = i * columns + int(np.argmin(np.abs(ys - self._start[1])))
        best = [-1.0] * len(flat)
        before = np.full(len(flat), -1, dtype=np.intp)
        best[start] = max(flat[start], self.radius)  # it stands there
        queue = [(-best[start], start)]
        while queue:
            negative, cell = heapq.heappop(queue)
            width = -negative
            if width < best[cell]:
                continue

            row, column = divmod(cell, columns)
            for r in (row - 1, row, row + 1):
                for c in (column - 1, column, column + 1):
                    if 0 <= r < len(xs) and 0 <= c < columns:
                        other = r * columns + c
                        through = min(width, flat[other])
                        if through > best[other]:
                            best[other] = through
                            before[other] = cell
                            heapq.heappush(queue, (-through, other))

        return np.array(best).reshape(free.shape), before

    def closed(self, low: Float[Array, " 2"], high: Float[Array, " 2"], reach: float) -> Gap | None:
        """Return the gap that keeps the base from within `reach` metres of a box (2,), (2,); None
        unless that is proven.
        """
        if not self.is_mapped or self.open_towards((low + high) / 2, reach):
            return None
        xs, ys, _ = self._floor
        dx = np.maximum(np.maximum(low[0] - xs, xs - high[0]), 0.0)
        dy = np.maximum(np.maximum(low[1] - ys, ys - high[1]), 0.0)
        near = np.hypot(dx[:, None], dy[None]) <= reach + self.slack
        widest, _ = self._widest
        if not near.any() or float(widest[near].max()) >= self.radius - self.slack:
            return None
        _, _, free = self._floor
        # Behind a door there is room to stand; beside a wall there is no door.
        roomy = near & (free >= self.radius)
        return self._gap(int(np.argmax(np.where(roomy if roomy.any() else near, widest, -1.0))))

    def narrow(self, goal: Float[Array, " 2"]) -> Gap | None:
        """Find the narrowest place on the widest way to a base position (2,), where the base hardly
        fits through it.
        """
        if not self.is_mapped:
            return None
        xs, ys, _ = self._floor
        target = int(np.argmin(np.abs(xs - goal[0]))) * len(ys) + int(
            np.argmin(np.abs(ys - goal[1]))
        )
        gap = self._gap(target)
        beside = math.dist(gap.place, goal[:2]) < self.radius
        return gap if gap.width <= DOOR_SHARE * gap.base and not beside else None

    def _gap(self, target: int) -> Gap:
        """Find the narrowest place on the way to a cell."""
        xs, ys, free = self._floor
        _, before = self._widest
        flat = free.ravel()
        cell, least = target, target
        while cell >= 0:
            if flat[cell] < flat[least]:
                least = cell
            cell = int(before[cell])

        point = np.array([xs[least // len(ys)], ys[least % len(ys)]])
        place = (float(point[0]), float(point[1]))
        nearest = [(piece.body, _nearest(point, piece.corners)) for piece in self.slices]
        nearest.sort(key=lambda item: float(np.linalg.norm(item[1] - point)))
        name, first = nearest[0]
        if flat[least] <= 0.0:
            return Gap(place, 0.0, 2 * self.radius, (name,))

        across = first - point
        for other, second in nearest[1:]:
            if (second - point) @ across < -0.5 * np.linalg.norm(across) * np.linalg.norm(
                second - point
            ):
                names = tuple(dict.fromkeys((name, other)))
                return Gap(place, float(np.linalg.norm(second - first)), 2 * self.radius, names)

        return Gap(place, 2 * float(flat[least]), 2 * self.radius, (name,))


def _base(robot: Robot) -> tuple[float, tuple[float, float]] | None:
    """Compute the radius of the largest disc about the base's origin that is in the base, and
    between which heights.
    """
    parts = robot.link(robot.base).parts
    if (
        len(parts) != 1
        or not isinstance(parts[0].shape, Box)
        or parts[0].pose.quaternion[:3] != (0.0, 0.0, 0.0)
    ):
        return None
    size, (x, y, z) = parts[0].shape.size, parts[0].pose.position
    return min(size[0] / 2 - abs(x), size[1] / 2 - abs(y)), (z - size[2] / 2, z + size[2] / 2)


def _nearest(point: Array, corners: Array) -> Array:
    """Return the point of a polygon's edge that is nearest to a point (2,)."""
    best, least = corners[0], math.inf
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        edge = b - a
        on = a + np.clip((point - a) @ edge / max(float(edge @ edge), 1e-12), 0.0, 1.0) * edge
        if (distance := float(np.linalg.norm(on - point))) < least:
            best, least = on, distance
    return best
