"""A data set's features in the order of its training sets: a smaller one is the beginning of a larger one."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.paper.feature_table import order, table_of
from grounding.paper.features import BB, BoxFeatures


def test_labels_take_turns_as_long_as_there_are_both() -> None:
    holds = np.array([False, True, False, False, True, False, True, False])
    found = order(holds)
    assert sorted(found.tolist()) == list(range(8))
    assert holds[found].tolist() == [True, False] * 3 + [False] * 2


def test_the_order_is_shuffled_and_the_same_each_time() -> None:
    holds = np.arange(40) % 2 == 0
    found = order(holds)
    assert np.array_equal(found, order(holds))
    assert found.tolist() != sorted(found.tolist())


def test_a_row_is_a_scene_as_it_is_seen(data: Dataset) -> None:
    some, features = data.take(range(24)), BoxFeatures()
    table = table_of(some, features)
    assert table.features == BB and table.arguments.shape == (24, 2 * BB)
    numbers = set()
    for row, index in enumerate(order(some.holds)):
        seen = features.observe(some[int(index)].situation)
        count = len(seen.others)
        numbers.add(count)
        assert table.arguments[row] == pytest.approx(seen.arguments.ravel(), abs=1e-6)
        assert table.others[row, :count] == pytest.approx(seen.others, abs=1e-6)
        assert not table.others[row, count:].any()
        assert table.share[row] == pytest.approx([1 / max(count, 1)] * count + [0] * (3 - count))
        assert table.holds[row] == some.holds[index]
    assert numbers == {0, 1, 2, 3}


def test_fewer_scenes_are_the_first_ones(data: Dataset) -> None:
    some = data.take(range(24))
    whole, few = (table_of(some, BoxFeatures(), count=count) for count in (None, 7))
    assert np.array_equal(few.arguments, whole.arguments[:7])
    assert np.array_equal(few.holds, whole.holds[:7])


def test_where_nothing_is_around_there_is_one_empty_place(data: Dataset) -> None:
    alone = [row for row in range(len(data)) if not data[row].situation.others][:4]
    table = table_of(data.take(alone), BoxFeatures())
    assert table.others.shape == (4, 1, BB)
    assert not table.others.any() and not table.share.any()
