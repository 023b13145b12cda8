"""The outcome of a motion query: a path, were it of one point, or the reason why there is none."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.motion.result import Failure, MotionResult


@pytest.mark.parametrize("rows", [1, 2])
def test_a_path_is_a_success_whatever_stands_in_it(rows: int) -> None:
    assert MotionResult(np.zeros((rows, 3)), None, 0)


@pytest.mark.parametrize("failure", Failure)
def test_no_path_is_none_and_each_reason_has_words_of_its_own(failure: Failure) -> None:
    assert not MotionResult(None, failure, 7)
    assert Failure(failure.value) is failure and len({one.value for one in Failure}) == 5
