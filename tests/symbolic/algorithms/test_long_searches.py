"""Search and binding share the effort: a long search's plan gets tries for it, a search in vain is skipped."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms import adaptive
from tamp.symbolic.algorithms.adaptive import bind_for_its_worth
from tamp.symbolic.algorithms.experience.stream_statistics import MOST_SKIPPED, Patience
from tests.symbolic.algorithms.binding.shelf import planned


def test_a_short_search_has_its_plan_bound_once() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert bind_for_its_worth(run, skeleton, 10) is None
    assert skeleton.rounds == 0 and run.binder.draws == 8, "four poses, each tested"


def test_a_long_search_has_it_bound_until_nothing_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two tries of the four poses in the first round; the one that is clear comes in the next."""
    monkeypatch.setattr(adaptive, "FIRST_TRIES", 2)
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == 4)
    values = bind_for_its_worth(run, skeleton, 1000)
    assert values is not None and [
        run.streams.objects.values[name] for name in values.values()
    ] == [4]
    assert skeleton.rounds == 1

    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert bind_for_its_worth(run, skeleton, 1000) is None, (
        "no round is without end where nothing is drawn"
    )


def test_what_ends_in_vain_is_skipped_more_and_more() -> None:
    patience, asked = Patience(), 0
    pauses: list[int] = []
    for _ in range(6):
        assert not patience.skips()
        patience.note(in_vain=True)
        asked = 0
        while patience.skips():
            asked += 1
        pauses.append(asked)
    assert pauses == [1, 3, 7, 15, MOST_SKIPPED, MOST_SKIPPED]
    patience.note(in_vain=False)
    assert not patience.skips()
