"""Pictures of a timeline: PNG, and moving ones."""

from __future__ import annotations

import io
import itertools
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from tamp.errors import InputError
from tamp.geometric.robot.kinematics import ArmsKinematics
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.system.outputs import write_whole
from tamp.view.appearance import body_meshes, robot_meshes
from tamp.view.mesh import Mesh, simplified
from tamp.view.rasterizer import Camera, Triangles, render, triangles
from tamp.view.timeline import Timeline
from tamp.view.trails import trails
from tamp.view.video_formats import VIDEO_FORMATS, check_suffix

if TYPE_CHECKING:
    from PIL import Image

FLOOR_COLOURS = ((0.86, 0.85, 0.83, 1.0), (0.83, 0.82, 0.8, 1.0))
VIEW = np.array([0.28, -0.86, 0.62])
"""Where from the scene's middle the eye is."""

AROUND = 6
"""Metres of floor around the room."""

FILLED = 0.94
"""The share of a picture's height and width that the scene takes."""

FRAMES = 8
"""Of a moving picture, a second."""

PAUSE = 10.0
"""Seconds of a plan's time in which nothing moves that are shown; what is longer is cut."""

MOST_BYTES = 600_000_000
"""Of a moving picture's frames in memory."""

MOST_TRIANGLES = 1_000_000
"""Of all bodies; beyond, each is drawn coarsely: a crowd of thousands has no room for details."""

TILES = 100
"""Of the floor, on each side at most."""


class Renderer:
    """The renderer of a timeline: what is drawn of it, prepared once for all its pictures.

    Args:
        timeline: What happens.
        size: Columns and rows of a picture.
        camera: Who looks; by default somebody who has everything in view.
    """

    def __init__(
        self, timeline: Timeline, size: tuple[int, int], camera: Camera | None = None
    ) -> None:
        self.timeline, self.size = timeline, size
        self.camera = camera or framing(timeline, size)
        self._kinematics = ArmsKinematics(timeline.robot)
        looks = robot_meshes(timeline.robot)
        self._robot = {
            name: [triangles(mesh) for mesh in meshes if len(mesh.faces)]
            for name, meshes in looks.items()
        }
        bodies = timeline.scene.bodies
        meshes = {name: body_meshes(body) for name, body in bodies.items()}
        crowd = sum(len(mesh.faces) for some in meshes.values() for mesh in some) > MOST_TRIANGLES
        self._bodies = {
            name: [triangles(_coarse(mesh) if crowd else mesh) for mesh in some]
            for name, some in meshes.items()
        }
        self._floor = _floor(timeline)
        self._trails = trails(timeline, self._kinematics)

    def frame(self, time: float) -> NDArray[np.uint8]:
        """Render the picture at a time, with the paths up to then; rows x columns x RGB."""
        row = self.timeline.row(time)
        links = self._kinematics.link_poses(row)
        parts = [*self._floor, *(trail.until(time) for trail in self._trails)]
        parts += [part.moved(links[name]) for name, some in self._robot.items() for part in some]
        for name, pose in self.timeline.poses(time, self._kinematics).items():
            parts += [part.moved(pose) for part in self._bodies[name]]
        return render(parts, self.camera, self.size)


def framing(timeline: Timeline, size: tuple[int, int], angle: float = 30.0) -> Camera:
    """Place a camera that has all bodies, and the robot wherever it goes, in view."""
    boxes = [bounds(body.parts, body.pose) for body in timeline.scene.bodies.values()]
    boxes += [
        (np.array([x - 0.3, y - 0.3, 0.0]), np.array([x + 0.3, y + 0.3, 0.4]))
        for x, y in timeline.rows[::20, :2]
    ]
    boxes += [(np.array([*timeline.rows[0, :2], 0.4]), np.array([*timeline.rows[0, :2], 1.1]))]
    if timeline.inspected or timeline.robot.beside:
        boxes += _links(timeline)
    corners = np.array(
        [
            corner
            for low, high in boxes
            for corner in itertools.product(*zip(low, high, strict=True))
        ]
    )
    ahead = -VIEW / np.linalg.norm(VIEW)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    frame = np.stack([right, np.cross(ahead, right), ahead])
    half = math.tan(math.radians(angle) / 2) * FILLED
    reach = np.array([half * size[0] / size[1], half])
    target, distance = corners.mean(axis=0), 1.0
    for _ in range(20):  # until the corners' outline is in the middle, and fills the picture
        seen = (corners - target) @ frame.T
        distance = float(np.max(np.abs(seen[:, :2]) / reach - seen[:, 2:]))
        plane = seen[:, :2] / (seen[:, 2:] + distance)
        target = target + (plane.min(axis=0) + plane.max(axis=0)) / 2 * distance @ frame[:2]

    return Camera(_three(target - ahead * distance), _three(target), angle)


def _links(timeline: Timeline) -> list[tuple[Array, Array]]:
    """Return the boxes around the robot's links where it starts."""
    robot, row = timeline.robot, timeline.rows[0]
    poses = ArmsKinematics(robot).link_poses(row)
    return [
        bounds(link.parts, Pose.from_matrix(poses[link.name])) for link in robot.links if link.parts
    ]


def write_png(
    timeline: Timeline, file: Path, times: Sequence[float] = (), size: tuple[int, int] = (800, 600)
) -> None:
    """Write one picture, or one beside the other for several times; by default a plan's start,
    middle and end.

    Raises:
        InputError: The file cannot be written.
    """
    from PIL import Image

    ends = [action.end for action in timeline.actions[:-1]] or [timeline.duration]
    middle = min(ends, key=lambda end: abs(end - timeline.duration / 2))
    chosen = times or ((0.0, middle, timeline.duration) if timeline.actions else (0.0,))
    renderer = Renderer(timeline, size)
    frames = [renderer.frame(min(max(time, 0.0), timeline.duration)) for time in chosen]
    image = Image.fromarray(np.concatenate(frames, axis=1))
    _save(file, image, "PNG", {"optimize": True})


def write_video(
    timeline: Timeline, file: Path, speed: float = 6.0, size: tuple[int, int] = (480, 360)
) -> float:
    """Write a video of the plan, `speed` times as fast as the robot; return the seconds of long
    pauses that were cut.

    Raises:
        InputError: Nothing moves, it would be far too long, the file's ending is unknown, or it
            cannot be written.
    """
    from PIL import Image

    check_suffix(file)
    suffix = file.suffix.lower()
    if not timeline.actions:
        raise InputError(
            "nothing moves without a plan", file=file, remedy="A picture is made by --png"
        )
    moments, cut = moments_of(timeline, speed)
    deep = 1 if suffix == ".gif" else 3
    most = MOST_BYTES // (size[0] * size[1] * deep)
    if len(moments) > most:
        what = (
            f"the plan moves for {timeline.duration - cut:,.0f} s: {len(moments):,} frames, "
            f"and {most:,} are the most"
        )
        faster = math.ceil(speed * len(moments) / most)
        raise InputError(
            what, file=file, remedy=f"With --speed {faster} or a smaller --size it has room"
        )
    renderer = Renderer(timeline, size)
    images = [Image.fromarray(renderer.frame(float(moments[len(moments) // 2])))]
    palette = images[0].quantize(128, dither=Image.Dither.NONE) if suffix == ".gif" else None
    images = [
        _coloured(Image.fromarray(renderer.frame(float(moment))), palette) for moment in moments
    ]
    options = {"save_all": True, "append_images": images[1:], "duration": 1000 // FRAMES, "loop": 0}
    _save(file, images[0], VIDEO_FORMATS[suffix], options)
    return cut


def moments_of(timeline: Timeline, speed: float) -> tuple[Array, float]:
    """Choose the times of a video's frames, and return how many seconds of pauses they leave out.

    Raises:
        InputError: There would be more than anybody has memory for.
    """
    spans = np.diff(timeline.times)
    still = (np.diff(timeline.rows, axis=0) == 0.0).all(axis=1)
    cuts = np.where(still & (spans > PAUSE), spans - PAUSE, 0.0)
    shown = timeline.times - np.concatenate([[0.0], np.cumsum(cuts)])
    length = float(shown[-1] - shown[0])
    if length * FRAMES / speed > MOST_BYTES:
        raise InputError(f"the plan moves for {length:,.0f} s, which no moving picture can show")
    at = np.append(np.arange(float(shown[0]), float(shown[-1]), speed / FRAMES), shown[-1])
    return np.interp(at, shown, timeline.times), float(cuts.sum())


def _coloured(image: Image.Image, palette: Image.Image | None) -> Image.Image:
    """Quantize a picture to colours that the scene has, the same in all frames."""
    from PIL import Image

    return image if palette is None else image.quantize(palette=palette, dither=Image.Dither.NONE)


def _coarse(mesh: Mesh) -> Mesh:
    if len(mesh.faces) <= 50:
        return mesh
    return simplified(mesh, float(np.ptp(mesh.vertices, axis=0).max()) / 4)


def _save(file: Path, image: object, kind: str, options: dict[str, object]) -> None:
    content = io.BytesIO()
    image.save(content, kind, **options)  # pyright: ignore[reportAttributeAccessIssue]
    try:
        write_whole(file, content.getvalue())
    except OSError as error:
        raise InputError(f"cannot write the picture: {error.strerror}", file=file) from error


def _floor(timeline: Timeline) -> list[Triangles]:
    """Make tiles of two shades, a metre wide (larger ones in a hall), under the room and around
    it.
    """
    room = timeline.scene.room
    side = max(1, math.ceil(max(room.x[1] - room.x[0], room.y[1] - room.y[0]) / TILES))
    xs, ys = (
        range(math.floor(low / side) - AROUND, math.ceil(high / side) + AROUND)
        for low, high in (room.x, room.y)
    )
    tiles: list[Triangles] = []
    for shade, colour in enumerate(FLOOR_COLOURS):
        corners = [(x, y) for x in xs for y in ys if (x + y) % 2 == shade]
        around = ((0, 0), (1, 0), (1, 1), (0, 1))
        vertices = [
            (side * (x + dx), side * (y + dy), 0.0) for x, y in corners for dx, dy in around
        ]
        faces = [
            (4 * i, 4 * i + a, 4 * i + b) for i in range(len(corners)) for a, b in ((1, 2), (2, 3))
        ]
        tiles.append(triangles(Mesh(np.array(vertices), np.array(faces), colour)))
    return tiles


def _three(vector: Array) -> tuple[float, float, float]:
    return (float(vector[0]), float(vector[1]), float(vector[2]))
