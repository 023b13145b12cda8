"""The catalogue: every measure with its name, and as the kernel has it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from grounding.relations.catalogue import catalogue, measure


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
