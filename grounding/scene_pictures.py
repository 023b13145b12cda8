"""Pictures of a data set's scenes: a sheet with some of each type, labelled."""

from __future__ import annotations

import io
import itertools
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from grounding.arguments import Show
from grounding.cli_files import with_card
from grounding.dataset import Dataset, read_dataset
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body
from tamp.system.files import write_whole
from tamp.system.outputs import check_outputs, check_writable
from tamp.view.appearance import body_meshes
from tamp.view.rasterizer import Camera, Triangles, render, triangles

if TYPE_CHECKING:
    from PIL.Image import Image

TILE = (300, 225)
"""Columns and rows of a scene."""

ACROSS = 4
"""Scenes side by side."""

MOST = 60
"""Scenes of a sheet at most."""

ANGLE = 34.0
"""Of view from top to bottom, degrees."""

PITCH = math.radians(33.0)
"""How far the eye looks down, radians."""

SUPPORT_COLOUR = (0.80, 0.69, 0.53, 1.0)
BODY_COLOURS = {True: (0.16, 0.58, 0.24, 1.0), False: (0.82, 0.18, 0.16, 1.0)}
OTHER_COLOUR = (0.50, 0.62, 0.76, 1.0)
"""Argument 0; argument 1 where the relation holds, and where it does not; the others."""

FLOOR_COLOUR = (0.87, 0.87, 0.86)
FLOOR_M, CELL_M = 4.0, 0.5
"""Half the edge of the drawn floor, and the edge of its cells: what is partly behind the eye is not
drawn. Metres.
"""


def show_scenes(chosen: Show) -> int:
    """Carry out tamp-learn show: draw scenes of a data set; returns how many.

    Raises:
        InputError: As for `read_dataset`, `scenes_to_show` and `check_outputs`.
    """
    check_writable(chosen.out)
    check_outputs({"--out": chosen.out}, with_card(chosen.data))
    data = read_dataset(chosen.data)
    indices = scenes_to_show(data, chosen.scenes, chosen.seed)
    write_sheet(chosen.out, data, indices)
    return len(indices)


def scenes_to_show(data: Dataset, count: int, seed: int) -> list[int]:
    """Choose scenes for a sheet: of each type as many as its share, drawn by seed.

    Args:
        data: The scenes.
        count: How many, at most MOST.
        seed: Of the draw.

    Raises:
        InputError: More scenes than a sheet has room for.
    """
    if count > MOST:
        raise InputError(f"--scenes {count}: a sheet has room for {MOST}")
    shuffled = np.random.default_rng(seed).permutation(len(data))
    by_type = shuffled[np.argsort(data.arrays["kind"][shuffled], kind="stable")]
    places = (np.arange(count) + 0.5) / count * len(data)
    return [int(by_type[int(place)]) for place in places[: len(data)]]


def write_sheet(path: Path, data: Dataset, indices: list[int]) -> None:
    """Write a PNG of scenes, ACROSS in a row: argument 1 green where the relation holds, else red.

    Raises:
        InputError: The file cannot be written.
    """
    from PIL import Image, ImageDraw

    columns, rows = TILE
    down = -(-len(indices) // ACROSS)
    across = min(ACROSS, len(indices))
    sheet = Image.new("RGB", (across * columns, down * rows), "white")
    for number, index in enumerate(indices):
        tile = scene_picture(data, index)
        holds = "holds" if data.holds[index] else "does not hold"
        text = f"{data.kinds[data.arrays['kind'][index]]}: {holds}"
        ImageDraw.Draw(tile).text((6, 4), text, fill=(40, 40, 40))
        sheet.paste(tile, (number % ACROSS * columns, number // ACROSS * rows))

    content = io.BytesIO()
    sheet.quantize(128).save(content, "PNG", optimize=True)
    write_whole(path, content.getvalue())


def scene_picture(data: Dataset, index: int) -> Image:
    """Render one scene with its arguments in the middle."""
    from PIL import Image

    bodies = np.flatnonzero(data.arrays["body"][index] >= 0)
    colours = [SUPPORT_COLOUR, BODY_COLOURS[bool(data.holds[index])]]
    parts = [_floor()]
    for row, body in enumerate(bodies.tolist()):
        colour = colours[row] if row < len(colours) else OTHER_COLOUR
        shown = Body("shown", data.form(index, body).parts, Pose(), True, colour=colour)
        pose = data.arrays["pose"][index, body]
        parts += [triangles(mesh).moved(pose) for mesh in body_meshes(shown) if len(mesh.faces)]

    return Image.fromarray(render(parts, _camera(data, index), TILE))


def _camera(data: Dataset, index: int) -> Camera:
    """Look at both arguments, whole, with the next body, the other piece of furniture, behind
    them.
    """
    situation = data[index].situation
    boxes = np.stack([situation.support.box, situation.body.box])
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    corners: Array = np.array([*itertools.product(*zip(low, high, strict=True))])
    middle = (low + high) / 2
    radius = float(np.linalg.norm(corners - middle, axis=1).max())
    behind = data.arrays["pose"][index, 2, :2, 3] - middle[:2] + [1e-9, 0.0]
    eye = middle - _ahead(behind) * radius / math.sin(math.radians(ANGLE) / 2)
    (x, y, z), (a, b, c) = eye.tolist(), middle.tolist()
    return Camera((x, y, z), (a, b, c), ANGLE)


def _ahead(behind: Array) -> Array:
    """Return the way the eye looks, shape (3,): down, and towards what is behind, seen askew."""
    yaw = math.atan2(float(behind[1]), float(behind[0])) + math.radians(25.0)
    level = math.cos(PITCH)
    return np.array([math.cos(yaw) * level, math.sin(yaw) * level, -math.sin(PITCH)])


def _floor() -> Triangles:
    starts = np.arange(-FLOOR_M, FLOOR_M, CELL_M)
    cells = np.array([(x, y, -0.002) for x in starts for y in starts])
    square = CELL_M * np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    corners = (cells[:, None] + square)[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 3)
    normals = np.broadcast_to([0.0, 0.0, 1.0], corners.shape)
    return Triangles(corners, normals, np.tile(FLOOR_COLOUR, (len(corners), 1)))
