"""Data sets and their cards: scenes there and back; or refused with the file, the array and the row."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grounding.cli import BAD_INPUT, run
from grounding.dataset import Dataset, read_dataset, write_dataset
from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part, Sphere
from tests.geometric.making import cuboid, hull
from tests.grounding.shown import Arrays, changed


def put(name: str, index: Any, value: Any) -> Callable[[Arrays], None]:
    def change(arrays: Arrays) -> None:
        arrays[name] = arrays[name].copy()
        arrays[name][index] = value

    return change


def cast(name: str, kind: Any) -> Callable[[Arrays], None]:
    return lambda arrays: arrays.update({name: arrays[name].astype(kind)})


def cut(name: str) -> Callable[[Arrays], None]:
    return lambda arrays: arrays.update({name: arrays[name][:1]})


WRONG: list[tuple[Callable[[Arrays], object], str]] = [
    *(
        (lambda a, n=n: a.pop(n), f"array '{n}' is missing")
        for n in ("holds", "pose", "part_size", "vertices")
    ),
    *(
        (cut(n), f"array '{n}' has 1 rows, 'holds' has 4")
        for n in ("pose", "body", "kind", "hollow", "size", "feasible")
    ),
    (cut("part_pose"), "array 'part_pose' has 1 rows"),
    *((cast(n, "U5"), f"array '{n}' holds text") for n in ("holds", "pose", "hollow", "feasible")),
    (cast("pose", complex), "array 'pose' holds complex numbers"),
    (cast("body", float), "array 'body' holds 'float64', not integers"),
    (cast("scale", int), "array 'scale' holds 'int64', not numbers"),
    (put("holds", 0, 1), ""),
    (
        lambda a: a.update(holds=np.array([0, 1, 7, 1])),
        "array 'holds', row 2: it is neither 0 nor 1",
    ),
    (put("kind", 3, 9), "array 'kind', row 3: it is none of the card's 2 kinds"),
    (put("kind", 3, -1), "array 'kind', row 3: it is none"),
    (put("body", (1, 2), 99), "array 'body', row 1, entry 2: it is none of the card's"),
    (put("body", (1, 0), -1), "array 'body', row 1, entry 0: it is missing"),
    (put("scale", (2, 1), 0.0), "array 'scale', row 2, entry 1: it is no scale"),
    (put("scale", (2, 1), np.nan), "array 'scale', row 2, entry 1: it is not finite"),
    (put("pose", (1, 1, 0, 3), np.nan), "array 'pose', row 1, entry 1, 0, 3: it is not finite"),
    (put("pose", (1, 1, 0, 3), np.inf), "array 'pose', row 1, entry 1, 0, 3: it is not finite"),
    (put("pose", (1, 1, 0, 3), 1e9), "array 'pose', row 1, entry 1: it is too far away"),
    (put("pose", (1, 1), np.zeros((4, 4))), "array 'pose', row 1, entry 1: it is no pose"),
    (
        put("pose", (1, 1), np.diag([1.0, 1.0, -1.0, 1.0])),
        "array 'pose', row 1, entry 1: it is no pose",
    ),
    (put("region", (0, 3, 0), 1.0), "array 'region', row 0: it is no pose"),
    (put("size", (0, 1), -1.0), "array 'size', row 0, entry 1: it is no size"),
    (put("size", (0, 2), np.nan), "array 'size', row 0, entry 2: it is not a number"),
    (put("box", (0, 0, 1), np.inf), "array 'box', row 0, entry 0, 1: it is not finite"),
    (put("box", (0, 0, 1), 9.0), "array 'box', row 0, entry 1: it is beyond the other corner"),
    (lambda a: a.update(pose=a["pose"][..., :3]), "array 'pose' has shape"),
    (lambda a: a.update(holds=np.float64(1.0)), "it has no scene"),
    (lambda a: a.update({n: v[:0] for n, v in a.items() if len(v) == 4}), "it has no scene"),
    (put("part_template", 0, 77), "array 'part_template', row 0: it is none of the card's"),
    (put("part_shape", 0, 7), "array 'part_shape', row 0: it is none of box"),
    (put("part_size", (0, 0), 0.0), "array 'part_size', row 0, entry 0: it is no length"),
    (put("part_pose", (0, 3), 9.0), "array 'part_pose', row 0: it is no unit quaternion"),
    (put("part_vertices", 0, 5), "array 'part_vertices', row 0: it is no count of a hull"),
    (put("part_shape", 0, 3), "array 'part_vertices', row 0: it says fewer corners"),
    (lambda a: a.update(more=np.zeros(3)), "array 'more' has 3 rows, 'holds' has 4"),
    (lambda a: a.update(more=np.full(4, np.nan)), "array 'more', row 0: it is not finite"),
    *((put(n, ..., np.nan), "it is not finite") for n in ("pose", "region", "box", "part_pose")),
]


@pytest.mark.parametrize(("change", "message"), WRONG, ids=range(len(WRONG)))
def test_an_array_that_is_wrong_is_named_with_its_row(
    change: Callable[[Arrays], object],
    message: str,
    stored: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    changed(stored, change)
    if not message:
        read_dataset(stored)
        return
    with pytest.raises(InputError) as caught:
        read_dataset(stored)
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"{stored}: the data set is damaged: ")
    out = stored.with_name("w.safetensors")
    assert run(["train", "upright", "--data", str(stored), "--out", str(out)]) == BAD_INPUT
    assert not out.exists()
    assert "error: " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("entry", "value", "message"),
    [
        ("kinds", None, "'kinds' of the card is None, not a list of names"),
        ("kinds", "ab", "'kinds' of the card is 'ab'"),
        ("kinds", [], "'kinds' of the card is []"),
        ("templates", [1, 2], "'templates' of the card is [1, 2]"),
        ("templates", ["table", "table", "can"], "'templates' of the card has a name twice"),
        ("templates", ["table"], "array 'body'"),
        (
            "templates",
            ["table", "can", "jar", "jar#2", "x", "y"],
            "template 5 of the card has no part",
        ),
        ("relation", 3, "'relation' of the card is 3, not a name"),
        ("relation", "a\x1b[31m", "'relation' of the card is"),
        ("count", "4", "'count' of the card is '4'"),
        ("count", 5, "the card says 5 scenes, array 'holds' has 4"),
        ("by type", [], "'by type' of the card"),
        ("split", 5, "'split' of the card"),
        ("seed", True, "'seed' of the card"),
        ("format", "other", "not a card of 'tamp demonstrations 1'"),
    ],
)
def test_a_card_that_is_wrong(entry: str, value: Any, message: str, stored: Path) -> None:
    card = stored.with_suffix(".json")
    card.write_text(json.dumps({**json.loads(card.read_text()), entry: value}))
    with pytest.raises(InputError) as caught:
        read_dataset(stored)
    assert message in str(caught.value)
    assert "\x1b" not in str(caught.value)


LIFTED = Pose((0.0, 0.1, 0.2), (0.0, 0.0, 0.6, 0.8))

TEMPLATES = {
    "table": (Part(Box((1.0, 0.6, 0.4))),),
    "lamp": (Part(Cylinder(0.02, 0.3)), Part(Sphere(0.05), LIFTED)),
    "stone": (Part(hull(cuboid((0.1, 0.2, 0.3)))), Part(hull(cuboid((0.3, 0.1, 0.1))), LIFTED)),
}


def by_hand() -> Dataset:
    """Three scenes on a table: a lamp, a stone beside a lamp of twice the size, a stone far from a lamp."""
    pose = np.tile(np.eye(4), (3, 3, 1, 1))
    pose[:, 1, 2, 3] = 0.5
    pose[1, 2, 0, 3], pose[2, 2, 0, 3] = 0.4, 5.0
    scale = np.ones((3, 3))
    scale[1, 2] = 2.0
    arrays = {
        "holds": np.array([True, False, True]),
        "kind": np.array([0, 1, 0], np.int8),
        "body": np.array([[0, 1, -1], [0, 2, 1], [0, 2, 1]], np.int16),
        "scale": scale,
        "pose": pose,
        "hollow": np.zeros(3, bool),
        "region": np.tile(Pose((0.0, 0.0, 0.2)).matrix, (3, 1, 1)),
        "size": np.tile([1.0, 0.6, np.inf], (3, 1)),
        "box": np.tile([[-0.5, -0.3, -0.2], [0.5, 0.3, 0.2]], (3, 1, 1)),
        "feasible": np.ones(3, bool),
    }
    card = {"relation": "on", "count": 3, "by type": {"yes": 2, "no": 1}}
    return Dataset(arrays, TEMPLATES, ["yes", "no"], card)


def test_an_example_is_a_row_with_what_is_near() -> None:
    data = by_hand()
    alone, beside, far = data
    assert (alone.holds, alone.kind, alone.names, alone.scales) == (
        True, "yes", ("table", "lamp"), (1.0, 1.0)
    )  # fmt: skip
    assert (beside.holds, beside.kind, beside.names) == (False, "no", ("table", "stone", "lamp"))
    (lamp,) = beside.situation.others
    assert lamp.form.scale == 2.0 and lamp.matrix[0, 3] == 0.4
    assert lamp.form.unit is alone.situation.body.form  # made once
    assert far.situation.others == () and len(far.names) == 3  # it is farther than a metre
    assert alone.situation.T_world_region[2, 3] == pytest.approx(0.2)
    assert data.form(1, 2) is not lamp.form and data.form(1, 2).scale == 2.0


def test_some_of_the_rows() -> None:
    some = by_hand().take([2, 0])
    assert len(some) == 2 and some.holds.tolist() == [True, True]
    assert [example.names[1] for example in some] == ["stone", "lamp"]


def test_all_shapes_come_back_as_they_were_written(tmp_path: Path) -> None:
    write_dataset(tmp_path / "d.npz", by_hand())
    again = read_dataset(tmp_path / "d.npz")
    assert [*again.templates] == [*TEMPLATES] and again.kinds == ("yes", "no")
    for name, parts in TEMPLATES.items():
        for part, found in zip(parts, again.templates[name], strict=True):
            assert found.pose == part.pose and type(found.shape) is type(part.shape)
            if isinstance(part.shape, Hull) and isinstance(found.shape, Hull):
                assert np.array_equal(found.shape.vertices, part.shape.vertices)
                assert np.array_equal(found.shape.faces, part.shape.faces)
            else:
                assert found.shape == part.shape
    write_dataset(tmp_path / "again.npz", again)
    assert (tmp_path / "again.npz").read_bytes() == (tmp_path / "d.npz").read_bytes()
    with zipfile.ZipFile(tmp_path / "d.npz") as archive:  # whenever it was written
        assert {one.date_time for one in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
