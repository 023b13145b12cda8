"""Data sets, weights and their cards: read whole and sound, or refused with the file, the array and the row."""

from __future__ import annotations

import io
import json
import os
import resource
import signal
import struct
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from grounding import pair
from grounding.cli import BAD_INPUT, DONE, run
from grounding.collect import collect, read_demonstrations
from grounding.dataset import Dataset, read_dataset, write_dataset
from grounding.npz import read_npz
from grounding.registry import load_model
from grounding.train import train
from grounding.variety import contradictions, monotony
from grounding.weights import Weights, read_weights, write_weights
from tamp.errors import InputError

SCENE = """robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, {height}], at: [1.6, 0.0, 0.0]}}
  can: {{cylinder: {{radius: 0.033, height: 0.102}}, on: table, at: [{x}, 0.02]}}
  jar: {{box: [0.05, 0.06, {tall}], on: table, at: [-0.3, 0.1], yaw: {yaw} deg}}
goal: {goal}
"""
GOAL = "(and (upright jar table) (not (upright can table)))"


def scene(
    path: Path,
    goal: str = GOAL,
    height: float = 0.7,
    tall: float = 0.15,
    yaw: float = 0,
    x: float = 0.3,
) -> Path:
    path.write_text(SCENE.format(goal=goal, height=height, tall=tall, yaw=yaw, x=x))
    return path


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    """A data set of four scenes, in a file."""
    files = [
        scene(tmp_path / f"{n}.yaml", height=0.6 + 0.05 * n, tall=0.1 + 0.02 * n, yaw=30 * n)
        for n in range(2)
    ]
    write_dataset(tmp_path / "d.npz", collect("upright", read_demonstrations("upright", files)))
    return tmp_path / "d.npz"


Arrays = dict[str, NDArray[Any]]


def changed(path: Path, change: Callable[[Arrays], object]) -> None:
    """Write the arrays anew as a user's own script would, with the card beside them as it was."""
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    change(arrays)
    np.savez(path, allow_pickle=False, **arrays)
    card = path.with_suffix(".json")
    entries = json.loads(card.read_text())
    entries.pop("sha256", None)
    card.write_text(json.dumps(entries))


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


CARDS = {
    "empty": (b"", "damaged"),
    "no object": (b"[1]", "not a card"),
    "deep": (b"[" * 200_000, "nested too deeply"),
    "digits": (
        b'{"format": "tamp demonstrations 1", "count": ' + b"9" * 6000 + b"}",
        "an integer of 6000 digits",
    ),
    "nan": (b'{"format": "tamp demonstrations 1", "count": NaN}', "NaN"),
    "overflow": (b'{"format": "tamp demonstrations 1", "feasible": 1e999}', "not finite"),
    "latin": ('{"relation": "säge"}'.encode("latin-1"), "not UTF-8 text"),
    "large": (b" " * 5_000_000, "is 5.0 MB large"),
    "twice": (b'{"format": "x", "format": "tamp demonstrations 1"}', "given twice"),
}


@pytest.mark.parametrize("case", CARDS)
@pytest.mark.parametrize("kind", ["data set", "weights"])
def test_a_card_that_is_none(case: str, kind: str, stored: Path) -> None:
    content, message = CARDS[case]
    if kind == "weights":
        stored = stored.with_name("w.safetensors")
        write_weights(stored, Weights({"x": np.zeros(3)}, {"model": "transfer"}))
        content = content.replace(b"tamp demonstrations 1", b"tamp grounding 1")
    stored.with_suffix(".json").write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_dataset(stored) if kind == "data set" else read_weights(stored)
    assert message in str(caught.value)
    assert str(caught.value).startswith(str(stored.with_suffix(".json")))


def npz(*members: tuple[str, bytes], method: int = zipfile.ZIP_DEFLATED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, content in members:
            archive.writestr(name, content)
    return buffer.getvalue()


def header(shape: tuple[int, ...], kind: str = "<f8") -> bytes:
    buffer = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        buffer, {"descr": kind, "fortran_order": False, "shape": shape}
    )
    return buffer.getvalue()


def archives() -> dict[str, tuple[bytes, str]]:
    sound = npz(("holds.npy", header((2,), "|b1") + b"\0\1"))
    stored = npz(("holds.npy", header((2,), "|b1") + b"\0\1"), method=zipfile.ZIP_STORED)
    lies = bytearray(sound)
    place = lies.rfind(b"PK\x05\x06")
    lies[place + 10 : place + 12] = struct.pack("<H", 60_000)
    return {
        "claims": (
            npz(("holds.npy", header((10**12,)))),
            "array 'holds' claims 8,000,000,000,128 bytes, 128 are there",
        ),
        "overflow": (npz(("holds.npy", header((2**40, 2**40)))), "array 'holds' claims"),
        "negative": (npz(("holds.npy", header((-1, -8)) + b"0" * 64)), "array 'holds' claims"),
        "bomb": (
            npz(*((f"{n}.npy", b"\0" * 50_000_000) for n in range(9))),
            "its arrays take 450 MB",
        ),
        "objects": (
            npz(("holds.npy", header((1,), "|O") + b"x" * 8)),
            "array 'holds' holds objects",
        ),
        "text": (npz(("holds.npy", header((1,), "<U2") + b"x" * 8)), "array 'holds' holds text"),
        "no array": (npz(("holds.npy", b"hello")), "array 'holds' is damaged"),
        "code": (
            npz(("holds.npy", b"\x93NUMPY\x01\x00\x20\x00__import__('os').system('false')")),
            "array 'holds' is",
        ),
        "packed": (npz(("holds.npy", b"x"), method=zipfile.ZIP_BZIP2), "packed in a way"),
        "members": (npz(*((f"{n}.npy", b"") for n in range(200))), "more than 100 members"),
        "lies": (bytes(lies), "more than 100 members"),
        "cut": (sound[:-30], "it is damaged"),
        "empty": (b"", "it is damaged"),
        "zeros": (b"\0" * 1000, "it is damaged"),
        "flipped": (stored.replace(b"\0\1", b"\1\1"), "damaged"),
    }


@pytest.mark.parametrize("case", archives())
def test_an_archive_that_is_none_costs_nothing(case: str) -> None:
    content, message = archives()[case]
    before, began = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss, time.process_time()
    with pytest.raises(InputError) as caught:
        read_npz(content)
    assert message in str(caught.value)
    assert time.process_time() - began < 10.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 500_000


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is cut off"),
        (struct.pack("<Q", 2**63) + b"{}", "its header claims"),
        (struct.pack("<Q", 2) + b"[]", "its header is no object"),
        (struct.pack("<Q", 4) + b"\xff\xfe{}", "no text"),
        (struct.pack("<Q", 200_000) + b"[" * 200_000, "nested too deeply"),
        (
            struct.pack("<Q", 60)
            + b'{"a":{"dtype":"F64","shape":[99999999999],"data_offsets":[0,9'.ljust(60),
            "damaged",
        ),
        (
            struct.pack("<Q", 59)
            + b'{"a":{"dtype":"BF16","shape":[1],"data_offsets":[0,2]}}    '
            + b"00",
            "of type 'BF16'",
        ),
        (
            struct.pack("<Q", 65)
            + b'{"a":{"dtype":"F64","shape":[99999999],"data_offsets":[0,800]}}  ',
            "damaged",
        ),
    ],
)
def test_weights_that_claim_what_is_not_there(content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "w.safetensors"
    write_weights(path, Weights({"x": np.zeros(3)}, {"model": "transfer"}))
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_weights(path)
    assert "the weights are damaged" in str(caught.value)
    assert message in str(caught.value)


@pytest.mark.parametrize("name", ["level", "anchor", "offset", "contained", "ceiling", "sides"])
@pytest.mark.parametrize("value", ["text", [], 9.5, -4, True, None])
def test_a_chart_that_is_none(name: str, value: Any, stored: Path) -> None:
    weights = train(read_dataset(stored), "transfer")
    entries = dict(weights.card)
    entries["chart"] = {**entries["chart"], name: value}
    path = stored.with_name("w.safetensors")
    write_weights(path, Weights(weights.arrays, entries))
    fits = {"contained": value is True, "ceiling": value in (9.5, -4, None) and value is not True}
    if fits.get(name, name in ("offset", "sides") and value in (9.5, -4) and value is not True):
        load_model(path)
        return
    with pytest.raises(InputError, match="no weights of 'transfer'"):
        load_model(path)


# The pair


def test_a_card_of_another_file_is_found_out(stored: Path, tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    path = tmp_path / "other" / "d.npz"
    data = read_dataset(stored)
    write_dataset(path, data.take([0, 1]))
    path.with_suffix(".json").write_bytes(stored.with_suffix(".json").read_bytes())
    with pytest.raises(InputError, match=r"d.npz.*(card says 4 scenes|do not belong together)"):
        read_dataset(path)
    write_dataset(path, data.take([1, 0, 2, 3]))
    path.with_suffix(".json").write_bytes(stored.with_suffix(".json").read_bytes())
    with pytest.raises(
        InputError, match=r"d.json: d.npz and its card do not belong together.*take 'sha256' out"
    ):
        read_dataset(path)
    weights = [tmp_path / f"{name}.safetensors" for name in "ab"]
    for number, file in enumerate(weights):
        write_weights(file, Weights({"x": np.full(3, float(number))}, {"model": "transfer"}))
    weights[0].with_suffix(".json").write_bytes(weights[1].with_suffix(".json").read_bytes())
    with pytest.raises(InputError, match=r"a.safetensors and its card do not belong together"):
        read_weights(weights[0])


def test_a_card_without_a_hash_is_that_of_an_earlier_version(stored: Path) -> None:
    card = stored.with_suffix(".json")
    entries = json.loads(card.read_text())
    assert len(entries.pop("sha256")) == 64
    card.write_text(json.dumps(entries))
    assert len(read_dataset(stored)) == 4


class Killed(BaseException):
    """A process that does no more."""


@pytest.mark.parametrize("steps", range(6))
def test_who_is_killed_leaves_the_old_pair_or_the_new(
    steps: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "w.safetensors"
    old, new = (
        Weights({"x": np.full(3, value)}, {"model": name})
        for value, name in ((1.0, "old"), (2.0, "new"))
    )
    write_weights(path, old)
    left = steps
    replace, write = Path.replace, pair.write_whole

    def counted(act: Callable[..., Any]) -> Callable[..., Any]:
        def one(*arguments: Any, **options: Any) -> Any:
            nonlocal left
            if not left:
                raise Killed
            left -= 1
            return act(*arguments, **options)

        return one

    with monkeypatch.context() as patched:
        patched.setattr(pair, "write_whole", counted(write))
        patched.setattr(Path, "replace", counted(replace))
        patched.setattr(Path, "unlink", counted(lambda *_, **__: None))
        try:
            write_weights(path, new)
        except Killed:
            assert steps < 5
    found = read_weights(path)
    assert (found.card["model"], found.arrays["x"][0]) in {("old", 1.0), ("new", 2.0)}
    write_weights(path, new)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["w.json", "w.safetensors"]


WRITER = """
import sys; from pathlib import Path; import numpy as np; from itertools import count
from grounding.weights import Weights, write_weights
print("ready", flush=True)
for number in count():
    write_weights(Path(sys.argv[1]), Weights({"x": np.full(2000, float(number))}, {"model": "m", "number": number}))
"""


def test_a_writer_that_is_killed_at_any_time(tmp_path: Path) -> None:
    path, rng = tmp_path / "w.safetensors", np.random.default_rng(0)
    seen: set[int] = set()
    for _ in range(6):
        writer = subprocess.Popen([sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE)
        assert writer.stdout is not None
        writer.stdout.readline()
        time.sleep(0.1 + float(rng.uniform(0.0, 0.05)))
        os.kill(writer.pid, signal.SIGKILL)
        writer.wait()
        writer.stdout.close()
        found = read_weights(path)
        assert found.card["number"] == found.arrays["x"][0]
        seen.add(found.card["number"])
    assert seen != {0}


# What demonstrations say


@pytest.mark.parametrize("apart", [False, True])
def test_contradicting_demonstrations_are_refused_with_both_places(
    apart: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    goals = ["(and (flat jar table) (not (flat jar table)))"]
    goals = ["(flat jar table)", "(not (flat jar table))"] if apart else goals
    files = [scene(tmp_path / f"{number}.yaml", goal) for number, goal in enumerate(goals)]
    assert run(["collect", "flat", *map(str, files), "--out", str(tmp_path / "x.npz")]) == BAD_INPUT
    said = capsys.readouterr().err
    assert "'flat' is said to hold and not to hold in the same situation" in said
    assert said.count(".yaml:7:") == 2
    assert not (tmp_path / "x.npz").exists()
    scene(files[-1], "(not (flat jar table))", x=0.31)  # elsewhere it may be otherwise
    assert run(["collect", "flat", str(files[-1]), "--out", str(tmp_path / "x.npz")]) == DONE


def test_contradicting_rows_are_warned_of(stored: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def twice(arrays: Arrays) -> None:
        rows = {n: v for n, v in arrays.items() if len(v) == 4}
        arrays |= {n: np.concatenate([v, v]) for n, v in rows.items()}
        arrays["holds"] = np.concatenate([rows["holds"], ~rows["holds"]])

    changed(stored, twice)
    card = stored.with_suffix(".json")
    card.write_text(card.read_text().replace('"count": 4', '"count": 8'))
    assert [*contradictions(read_dataset(stored))] == [(0, 4), (1, 5), (2, 6), (3, 7)]
    out = stored.with_name("w.safetensors")
    assert run(["train", "upright", "--data", str(stored), "--out", str(out)]) == DONE
    said = capsys.readouterr().err
    assert (
        f"{stored}: array 'holds', rows 0 and 4 are the same situation, labelled both ways" in said
    )


def demonstrations(folder: Path, count: int = 6, goal: str = GOAL, **same: float) -> Dataset:
    """Scenes that vary in everything but what is said."""
    files: list[Path] = []
    for n in range(count):
        varied = {"height": 0.5 + 0.04 * n, "tall": 0.1 + 0.02 * n, "yaw": 25.0 * n, **same}
        files.append(scene(folder / f"{n}.yaml", goal, **varied))
    return collect("upright", read_demonstrations("upright", files))


@pytest.mark.parametrize(
    ("same", "words"),
    [
        ({"height": 0.7}, "the height of the place (m) is the same (0.7)"),
        ({"yaw": 30.0}, "the yaw of the body on it (rad) is the same (0.524)"),
        ({"tall": 0.15}, "the size of the body (m) is the same (0.05, 0.06, 0.15)"),
    ],
)
def test_what_is_the_same_in_all_is_warned_of(
    same: dict[str, float], words: str, tmp_path: Path
) -> None:
    warned = monotony(demonstrations(tmp_path, **same))
    assert any(words in text for text in warned), warned
    assert len(warned) == 2  # the table's sides are the same, too
    assert not any(words in text for text in monotony(demonstrations(tmp_path)))


@pytest.mark.parametrize(
    ("goal", "words"),
    [
        ("(upright jar table)", "'upright' holds in every scene (6)"),
        ("(not (upright jar table))", "'upright' holds in none of the 6 scenes"),
    ],
)
def test_one_label_alone_is_warned_of(goal: str, words: str, tmp_path: Path) -> None:
    assert words in monotony(demonstrations(tmp_path, goal=goal))[0]


def test_what_was_shown_at_one_height_is_done_at_another(tmp_path: Path) -> None:
    """Where the plane of the place and the ground keep their distance, it is the plane that counts."""
    data = demonstrations(tmp_path, height=0.7)
    model = load_model(written(tmp_path, train(data, "transfer")))
    (tmp_path / "lower").mkdir()
    lower = demonstrations(tmp_path / "lower", height=0.45)[0].situation
    poses = model.propose(lower, 5, np.random.default_rng(0))
    assert len(poses) == 5
    feet = [(lower.body.form.vertices @ pose[:3, :3].T + pose[:3, 3])[:, 2].min() for pose in poses]
    assert np.abs(np.array(feet) - 0.45).max() < 0.01


def written(folder: Path, weights: Weights) -> Path:
    write_weights(folder / "m.safetensors", weights)
    return folder / "m.safetensors"


def test_a_demonstration_that_hangs_is_warned_of_with_its_place(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = scene(tmp_path / "s.yaml", "(upright jar table)")
    path.write_text(path.read_text().replace("on: table, at: [-0.3, 0.1]", "at: [1.3, 0.1, 0.9]"))
    assert run(["collect", "upright", str(path), "--out", str(tmp_path / "x.npz")]) == DONE
    said = capsys.readouterr().err
    assert (
        f"warning: {path}:7:7: jar hangs 125 mm above the place (1 scene): no plan will put it down so"
        in said
    )
