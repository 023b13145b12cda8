"""What a data set says both ways, and what is the same in all of it, is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding.cli import DONE, run
from grounding.dataset import read_dataset
from grounding.variety import contradictions, monotony
from tests.grounding.shown import Arrays, changed, demonstrations


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


def test_in_one_scene_nothing_varies(tmp_path: Path) -> None:
    one = demonstrations(tmp_path, count=1)
    (said,) = monotony(one)
    assert said == "'upright' holds in one scene only (row 0): nothing varies in it"


def test_only_what_is_trained_on_is_looked_at(tmp_path: Path) -> None:
    """Of the first two rows one holds."""
    assert "in one scene only (row 0)" in monotony(demonstrations(tmp_path), count=2)[0]
