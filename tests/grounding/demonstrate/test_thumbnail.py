"""Small pictures: the arguments in the middle, left and right as they are from the front."""

from __future__ import annotations

import io
import math

import numpy as np
import pytest
from PIL import Image

from grounding.demonstrate.thumbnail import (
    LEAST_RADIUS_M,
    PICTURE_SIZE_PX,
    VIEW_ANGLE_DEG,
    thumbnail,
)
from grounding.relations.demonstration_text import BodyEntry
from grounding.relations.scenes import loaded
from tamp.geometric.scene.pose import Pose

RED, BLUE = [0.9, 0.05, 0.05], [0.05, 0.05, 0.9]


def seen(
    yaw: float, red: tuple[float, float], blue: tuple[float, float], side: float = 0.08
) -> np.ndarray:
    """A picture of two cubes at x, y of a table whose front is turned by a yaw."""
    front = Pose.from_xyz_yaw(1.0, 2.0, 0.0, yaw)
    bodies = {
        "table": BodyEntry({"furniture": "table", "size": [1.2, 0.8, 0.7]}, front),
        **{
            name: BodyEntry(
                {"box": [side] * 3, "colour": colour},
                front @ Pose.from_xyz_yaw(*at, 0.701 + side / 2, 0),
            )
            for name, colour, at in (("red", RED, red), ("blue", BLUE, blue))
        },
    }
    content = thumbnail(loaded(bodies, ("red", "blue")), ("red", "blue"))
    image = Image.open(io.BytesIO(content))
    assert image.format == "PNG" and image.size == PICTURE_SIZE_PX
    return np.asarray(image.convert("RGB")).astype(int)


def pixels(picture: np.ndarray, colour: list[float]) -> np.ndarray:
    """Rows and columns in which a colour is by far the strongest, shape (n, 2)."""
    channel = int(np.argmax(colour))
    others = np.delete(picture, channel, axis=2).max(axis=2)
    found = np.argwhere(picture[:, :, channel] > 2 * others + 20)
    assert len(found) > 10
    return found


@pytest.mark.parametrize("yaw", [0.0, 1.3, math.pi])
def test_left_is_left_and_behind_is_above(yaw: float) -> None:
    picture = seen(yaw, red=(-0.2, -0.1), blue=(0.2, 0.1))
    (row, column), (other_row, other) = (pixels(picture, c).mean(axis=0) for c in (RED, BLUE))
    assert column < PICTURE_SIZE_PX[0] / 2 - 10 and other > PICTURE_SIZE_PX[0] / 2 + 10
    assert row > other_row + 3


def test_the_arguments_are_in_the_middle_wherever_they_are() -> None:
    for at in ((-0.4, 0.2), (0.4, -0.2)):
        picture = seen(0.4, red=(at[0] - 0.06, at[1]), blue=(at[0] + 0.06, at[1]))
        both = np.concatenate([pixels(picture, RED), pixels(picture, BLUE)])
        middle = (both.min(axis=0) + both.max(axis=0)) / 2
        assert np.abs(middle - [PICTURE_SIZE_PX[1] / 2, PICTURE_SIZE_PX[0] / 2]).max() < 8


def test_what_is_small_does_not_fill_the_picture() -> None:
    """From where a ball of `LEAST_RADIUS_M` fills the height, a cube of 3 cm is a tenth of it wide."""
    red = pixels(seen(0.0, red=(0.0, 0.0), blue=(0.05, 0.0), side=0.03), RED)
    distance = LEAST_RADIUS_M / math.sin(math.radians(VIEW_ANGLE_DEG) / 2)
    wide = 0.03 / distance / (2 * math.tan(math.radians(VIEW_ANGLE_DEG) / 2)) * PICTURE_SIZE_PX[1]
    assert np.ptp(red[:, 1]) == pytest.approx(wide, abs=3)
