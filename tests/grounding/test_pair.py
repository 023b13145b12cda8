"""A file and its card: one pair, the old one or the new one, or an error that names which of the two is wrong."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from grounding import pair
from grounding.dataset import read_dataset, write_dataset
from grounding.weights import Weights, read_weights, write_weights
from tamp.errors import InputError

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


def test_the_error_names_what_the_caller_asked_for_and_nothing_is_left(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "w.safetensors"
    write = pair.write_whole

    def full(file: Path, content: bytes) -> None:
        if file == path:
            raise OSError(28, "No space left on device", "/tmp/.w.safetensors.moment")
        write(file, content)

    monkeypatch.setattr(pair, "write_whole", full)
    with pytest.raises(OSError, match="No space left") as caught:
        pair.write_pair(path, b"numbers", {"format": "x"})
    assert caught.value.filename == str(path)
    assert [*tmp_path.iterdir()] == []


def test_cards_that_wait_for_nobody_are_taken_away(tmp_path: Path) -> None:
    """Those of this file alone, and nothing that only looks like one."""
    left, others = f".w.json.{'0a' * 8}", [f".v.json.{'0a' * 8}", ".w.json.notes"]
    for name in (left, *others):
        (tmp_path / name).write_text("{}")
    pair.write_pair(tmp_path / "w.npz", b"numbers", {"format": "x"})
    assert sorted(file.name for file in tmp_path.iterdir()) == sorted([*others, "w.json", "w.npz"])


@pytest.mark.parametrize("missing", ["w.npz", "w.json"])
def test_one_of_the_two_that_is_missing_is_named(missing: str, tmp_path: Path) -> None:
    pair.write_pair(tmp_path / "w.npz", b"numbers", {"format": "x"})
    (tmp_path / missing).unlink()
    with pytest.raises(InputError, match="no such thing") as caught:
        pair.read_pair(tmp_path / "w.npz", "x", what="thing", most=100, remedy="Make it")
    assert caught.value.file == str(tmp_path / missing)
