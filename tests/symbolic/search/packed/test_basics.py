"""The packed search's heap gives the lowest key first, of equals the first that came; masks say what holds."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tamp.symbolic.search.packed.basics import contains, has, heap_pop, heap_push, holds

keys = st.lists(st.sampled_from([0.0, 1.0, 1.5, 2.0, 7.0]), max_size=40)


@settings(max_examples=100, deadline=None)
@given(keys, st.lists(st.booleans(), max_size=40))
def test_a_heap_gives_the_lowest_key_and_among_equals_the_first(
    pushed: list[float], pops: list[bool]
) -> None:
    reals, ints = np.zeros(50), np.zeros(150, dtype=np.int64)
    size, waiting, taken, expected = 0, list[tuple[float, int]](), list[int](), list[int]()
    steps = [*pops, *[True] * len(pushed)]
    for tie, key in enumerate(pushed):
        heap_push(ints, reals, 5, 10, 80, size, key, tie, 100 + tie)
        size += 1
        waiting.append((key, tie))
        if steps[tie] and size:
            taken.append(int(ints[80]))
            heap_pop(ints, reals, 5, 10, 80, size)
            size -= 1
            expected.append(100 + waiting.pop(waiting.index(min(waiting)))[1])
    while size:
        taken.append(int(ints[80]))
        heap_pop(ints, reals, 5, 10, 80, size)
        size -= 1
    assert taken == [*expected, *(100 + tie for _, tie in sorted(waiting))]


def test_a_condition_wants_its_bits_and_none_of_the_others() -> None:
    state, starts, words, need, absent = 0, 4, 8, 12, 16
    ints = np.zeros(20, dtype=np.int64)
    ints[0:2] = [0b0110, 0b1]
    ints[4:7] = [0, 2, 3]  # condition 0 reads two words, condition 1 one
    ints[8:11] = [0, 1, 0]
    ints[12:15] = [0b0010, 0b1, 0b0110]
    ints[16:19] = [0b1000, 0, 0b0001]
    assert holds(ints, starts, words, need, absent, 0, state)
    assert holds(ints, starts, words, need, absent, 1, state)
    ints[0] = 0b1110  # what must be absent is there
    assert not holds(ints, starts, words, need, absent, 0, state)
    ints[0] = 0b0110
    ints[1] = 0  # what the second word must have is gone
    assert not holds(ints, starts, words, need, absent, 0, state)
    assert holds(ints, starts, words, need, absent, 1, state)


def test_facts_lie_in_words_of_64() -> None:
    ints = np.zeros(10, dtype=np.int64)
    ints[2:4] = [1 << 5, 1 << 1]
    assert [fact for fact in range(128) if has(ints, 2, fact)] == [5, 65]
    ints[4:7], ints[7:10] = [0, 2, 3], [5, 65, 6]
    assert contains(ints, 4, 7, 0, 2) and not contains(ints, 4, 7, 1, 2)
