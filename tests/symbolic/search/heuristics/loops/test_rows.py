"""Compressed rows: turned round, appended to, and made of lists; plain and compiled."""

from __future__ import annotations

import pytest

from tamp.symbolic.search.heuristics.loops import selection as tiers
from tamp.symbolic.search.heuristics.loops.compiled import COMPILED
from tamp.symbolic.search.heuristics.loops.interface import Kernels
from tamp.symbolic.search.heuristics.loops.rows import CsrRows, csr_rows


@pytest.mark.parametrize("loops", [tiers.PLAIN, COMPILED], ids=["plain", "compiled"])
def test_rows_are_turned_and_appended_to(loops: Kernels) -> None:
    rows = loops.rows([[2, 0], [], [2]])
    assert loops.transposed(rows, 4).lists() == [[0], [], [0, 2], []]
    more = loops.appended(rows, loops.integers([1, 3, 1]), loops.integers([5, 6, 7]), 5)
    assert more.lists() == [[2, 0], [5, 7], [2], [6], []]
    assert isinstance(more, CsrRows)
    assert csr_rows(more.lists()).lists() == more.lists()
    assert list(
        loops.incremented(
            loops.reals([1.0, 2.0]), loops.integers([1, 1]), loops.reals([0.5, 1.0]), 1
        )
    ) == [
        1,
        3.5,
        0,
    ]


def test_a_row_begins_where_the_one_before_ends() -> None:
    assert csr_rows([[2, 0], [], [5]]) == CsrRows([0, 2, 2, 3], [2, 0, 5])
    assert csr_rows([]) == CsrRows([0], []) and csr_rows([]).lists() == []
