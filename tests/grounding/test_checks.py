"""Arrays of a data set: sound ones pass, of wrong ones the array and the row are named."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from grounding.checks import SCENES_PER_BLOCK, check_arrays, check_card
from tamp.errors import InputError

CARD = {"relation": "on", "kinds": ["standing", "afloat"], "templates": ["table", "gem"]}
"""The table is a box on a cylinder, the gem a tetrahedron."""


def turned(angle: float) -> NDArray[Any]:
    T = np.eye(4)
    T[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return T


def sound(scenes: int = 2) -> dict[str, NDArray[Any]]:
    """The gem on the table, in as many scenes, with room for a third body."""
    poses = np.array([[turned(n), turned(-n), np.eye(4)] for n in range(scenes)])
    return {
        "holds": np.arange(scenes) % 2 == 0,
        "kind": np.arange(scenes) % 2,
        "body": np.tile([0, 1, -1], (scenes, 1)),
        "scale": np.ones((scenes, 3)),
        "pose": poses,
        "hollow": np.zeros(scenes, int),
        "region": np.tile(np.eye(4), (scenes, 1, 1)),
        "size": np.tile([0.8, 0.6, np.inf], (scenes, 1)),
        "box": np.tile([[-0.4, -0.3, 0.0], [0.4, 0.3, 0.5]], (scenes, 1, 1)),
        "part_template": np.array([0, 0, 1]),
        "part_shape": np.array([0, 1, 3]),
        "part_size": np.array([[0.8, 0.6, 0.02], [0.1, 0.4, 0.0], [0.0, 0.0, 0.0]]),
        "part_pose": np.tile([0, 0, 0.2, 0, 0, 0, 1.0], (3, 1)),
        "part_vertices": np.array([0, 0, 4]),
        "part_faces": np.array([0, 0, 4]),
        "vertices": np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]),
        "faces": np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
    }


def refused(arrays: dict[str, NDArray[Any]], card: dict[str, Any] = CARD) -> str:
    with pytest.raises(InputError) as caught:
        check_arrays(arrays, card)
    return caught.value.message


def test_what_is_sound_passes() -> None:
    check_card(CARD)
    check_card({**CARD, "count": 2, "seed": 0, "split": "train", "by type": {"standing": 1}})
    check_arrays(sound(), CARD)
    check_arrays({**sound(), "feasible": np.array([True, False])}, {**CARD, "count": 2})
    check_arrays({**sound(), "holds": np.array([1, 0], np.uint8)}, CARD)


def test_each_array_is_needed() -> None:
    for name in sound():
        arrays = sound()
        del arrays[name]
        assert refused(arrays) == f"array '{name}' is missing"


@pytest.mark.parametrize(
    ("name", "index", "value", "message"),
    [
        ("kind", 1, 2, "row 1: it is none of the card's 2 kinds"),
        ("kind", 0, -1, "row 0: it is none of the card's 2 kinds"),
        ("body", (1, 2), 2, "row 1, entry 2: it is none of the card's 2 templates, nor -1"),
        ("body", (1, 2), -2, "row 1, entry 2: it is none of the card's 2 templates, nor -1"),
        ("body", (0, 1), -1, "row 0, entry 1: it is missing: a scene has two arguments"),
        ("scale", (1, 0), 0.0, "row 1, entry 0: it is no scale"),
        ("scale", (1, 1), 1001.0, "row 1, entry 1: it is no scale"),
        ("pose", (1, 2, 0, 3), 1e4 + 1, "row 1, entry 2: it is too far away"),
        ("pose", (1, 2, 2, 2), -1.0, "row 1, entry 2: it is no pose: a rotation and a place"),
        ("pose", (1, 2, 0, 0), 1.001, "row 1, entry 2: it is no pose: a rotation and a place"),
        ("pose", (1, 2, 3, 3), 2.0, "row 1, entry 2: it is no pose: a rotation and a place"),
        ("region", (1, 3, 0), 1.0, "row 1: it is no pose: a rotation and a place"),
        ("size", (0, 0), 0.0, "row 0, entry 0: it is no size"),
        ("size", (0, 1), np.inf, "row 0, entry 1: it is no size"),
        ("size", (1, 2), 0.0, "row 1: it is no height"),
        ("size", (1, 2), np.nan, "row 1, entry 2: it is not a number"),
        ("box", (1, 1, 2), -0.1, "row 1, entry 2: it is beyond the other corner"),
        ("box", (1, 1, 2), 2e4, "row 1, entry 1, 2: it is too far away"),
        ("box", (1, 1, 2), np.inf, "row 1, entry 1, 2: it is not finite"),
        ("part_template", 2, 2, "row 2: it is none of the card's 2 templates"),
        ("part_shape", 2, 4, "row 2: it is none of box, cylinder, sphere, hull"),
        ("part_size", (0, 2), 0.0, "row 0, entry 2: it is no length"),
        ("part_size", (1, 1), -0.4, "row 1, entry 1: it is no length"),
        ("part_pose", (2, 0), 2e4, "row 2, entry 0: it is too far away"),
        ("part_pose", (2, 3), 0.1, "row 2: it is no unit quaternion"),
        ("part_vertices", 0, 4, "row 0: it is no count of a hull"),
        ("part_faces", 2, 5, "row 2: it is more than the 4 rows of 'faces'"),
        ("vertices", (3, 1), np.nan, "row 3, entry 1: it is not finite"),
        ("vertices", (3, 1), -2e4, "row 3, entry 1: it is too far away"),
        ("faces", (3, 1), 4, "row 3, entry 1: it is none of its hull's corners"),
        ("faces", (3, 1), -1, "row 3, entry 1: it is none of its hull's corners"),
    ],
)
def test_the_first_entry_that_is_wrong_is_named(
    name: str, index: Any, value: float, message: str
) -> None:
    arrays = sound()
    arrays[name][index] = value
    assert refused(arrays).startswith(f"array '{name}', {message}")


def test_what_is_not_used_is_not_asked_for() -> None:
    arrays = sound()
    arrays["scale"][:, 2] = 0.0  # no third body is there
    arrays["part_size"][1, 2] = -1.0  # a cylinder has two lengths
    check_arrays(arrays, CARD)


@pytest.mark.parametrize(
    ("name", "array", "message"),
    [
        ("kind", np.zeros(2), "holds 'float64', not integers"),
        ("holds", np.zeros(2), "holds 'float64', not truth values (0 or 1)"),
        ("scale", np.ones((2, 3), int), "holds 'int64', not numbers"),
        ("scale", np.ones((2, 4)), "has shape 2x4, not rows of shape 3"),
        ("kind", np.zeros((2, 1), int), "has shape 2x1, not rows"),
        ("kind", np.zeros(3, int), "has 3 rows, 'holds' has 2"),
        ("part_shape", np.zeros(2, int), "has 2 rows, 'part_template' has 3"),
        ("hollow", np.array([0, 2]), ", row 1: it is neither 0 nor 1"),
        ("body", np.zeros((2, 1), int), "has shape"),
        ("more", np.zeros(5), "has 5 rows, 'holds' has 2"),
        ("more", np.float64(1.0), "has 1 rows, 'holds' has 2"),
        ("more", np.array([0, np.inf]), ", row 1: it is not finite"),
    ],
)
def test_types_and_shapes(name: str, array: NDArray[Any], message: str) -> None:
    said = refused({**sound(), name: array})
    if name == "body":
        assert said == "array 'scale' has shape 2x3, not rows of shape 1"
    else:
        assert said == f"array '{name}' {message}".replace(" ,", ",")


def test_counts_have_to_agree() -> None:
    assert refused(sound(), {**CARD, "count": 3}) == ("the card says 3 scenes, array 'holds' has 2")
    assert refused(sound(0)) == "it has no scene"
    alone = {**CARD, "templates": [*CARD["templates"], "cup"]}
    assert refused(sound(), alone) == "array 'part_template': template 2 of the card has no part"
    more = sound()
    more["vertices"] = np.concatenate([more["vertices"], np.zeros((1, 3))])
    assert refused(more) == "array 'part_vertices' counts 4, 'vertices' has 5 rows"


@pytest.mark.parametrize(("name", "what"), [("vertices", "corners"), ("faces", "triangles")])
def test_a_hull_is_a_solid(name: str, what: str) -> None:
    arrays = sound()
    arrays["part_vertices"][2] = 3 if name == "vertices" else 4
    arrays["part_faces"][2] = 3 if name == "faces" else 4
    arrays[name] = arrays[name][:3]
    assert refused(arrays) == f"array 'part_{name}', row 2: it says fewer {what} than a solid has"


def test_a_body_alone_is_no_scene() -> None:
    arrays = sound()
    for name in ("body", "scale", "pose"):
        arrays[name] = arrays[name][:, :1]
    assert refused(arrays) == "array 'body' has no room for two arguments"


def test_poses_beyond_the_first_block_are_checked_too() -> None:
    arrays = sound(SCENES_PER_BLOCK + 2)
    arrays["pose"][SCENES_PER_BLOCK + 1, 0, 0, 0] = 2.0
    assert refused(arrays).startswith(
        f"array 'pose', row {SCENES_PER_BLOCK + 1}, entry 0: it is no pose"
    )


@pytest.mark.parametrize(
    ("entry", "value", "message"),
    [
        ("relation", None, "'relation' of the card is None, not a name"),
        ("relation", "", "'relation' of the card is '', not a name"),
        ("relation", "a\nb", "'relation' of the card is 'a\\nb', not a name"),
        ("relation", "r" * 201, f"'relation' of the card is 'r{'r' * 35}..., not a name"),
        ("kinds", [], "'kinds' of the card is [], not a list of names"),
        ("kinds", ["a", 1], "'kinds' of the card is ['a', 1], not a list of names"),
        ("templates", ["a", "a"], "'templates' of the card has a name twice"),
        ("count", -1, "'count' of the card is -1, not a number"),
        ("seed", True, "'seed' of the card is True, not a number"),
        ("split", 1, "'split' of the card is 1, not a name"),
        ("by type", [1], "'by type' of the card is [1], not counts by name"),
    ],
)
def test_a_card_of_other_kinds(entry: str, value: object, message: str) -> None:
    with pytest.raises(InputError) as caught:
        check_card({**CARD, entry: value})
    assert caught.value.message == message
