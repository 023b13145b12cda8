"""The catalogue: every measure with its name, and as the kernel has it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from grounding.relations.catalogue import catalogue, frame_names, measure


@pytest.mark.parametrize("arguments", [1, 2, 3, 4])
def test_the_catalogue_and_the_kernel_agree(arguments: int) -> None:
    rng = np.random.default_rng(arguments)
    s = situations(shown("between", 5, True, rng))
    rows = np.resize(np.arange(3), arguments)
    s = replace(
        s,
        shape=s.shape[:, rows],
        R=s.R[:, rows],
        p=s.p[:, rows] + rng.uniform(0, 1, (5, arguments, 3)),
    )
    keys = [one.key for one in catalogue(arguments)]
    assert len({*keys}) == len(keys)
    values = measure(s)
    assert values.shape == (5, len(keys)) and np.isfinite(values).all()
    out = np.full((5, len(keys) + 1), 7.0)
    from grounding.relations.measure_kernels import measure_rows

    measure_rows(s.corners, s.counts, s.half, s.inner, s.shape, s.R, s.p, s.support, out)
    assert (out[:, -1] == 7.0).all() and (out[:, :-1] == values).all()


def test_frames_are_named_by_what_turns_them() -> None:
    assert [name for name, *_ in frame_names(1)] == ["world", "furniture"]
    assert [name for name, *_ in frame_names(2)] == ["world", "furniture", "yaw of 1"]
    three = [name for name, *_ in frame_names(3)]
    assert three == ["world", "furniture", "yaw of 1", "yaw of 2", "line"]


@pytest.mark.parametrize("arguments", [1, 2, 3])
def test_only_what_has_the_arguments_is_measured(arguments: int) -> None:
    listed = {one.key: one for one in catalogue(arguments)}
    assert ("distance: 1" in listed) is (arguments > 1)
    assert ("distance: 2" in listed) is ("line: share" in listed) is (arguments > 2)
    for one in listed.values():
        words = one.words.format(*"abc"[:arguments])  # raises where it names another argument
        assert "{" not in words and words


def test_what_is_absolute_has_more_to_prove_and_angles_have_their_periods() -> None:
    cost = {one.key: one.cost for one in catalogue(2)}
    assert cost["height: foot, world"] == cost["world: x"] == 5.0
    assert cost["height: foot, surface"] == cost["distance: 1"] == 0.0
    assert cost["middle: x of 1 in world"] == 2.0 > cost["middle: x of 1 in furniture"] == 0.3
    period = {one.key: round(np.degrees(one.period)) for one in catalogue(2)}
    assert [period[f"turn {turn}: furniture"] for turn in (360, 180, 90)] == [360, 180, 90]
    assert period["direction: 1 in furniture"] == 360 and period["tilt: 0"] == 0
    assert {one.unit for one in catalogue(2) if one.period} == {"deg"}
