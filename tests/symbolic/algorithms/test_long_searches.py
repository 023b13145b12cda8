"""Search and binding share the effort: a long search's plan gets tries for it, a search in vain is skipped."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms import adaptive
from tamp.symbolic.algorithms.adaptive import bind_within_effort
from tamp.symbolic.algorithms.experience.stream_statistics import MOST_SKIPPED, Patience
from tests.symbolic.algorithms.binding.shelf import planned

GOALS = ("(and (put mug) (put tea))", "(put mug)")


def test_a_short_search_has_its_plan_bound_once() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert bind_within_effort(run, skeleton, 10) is None
    assert skeleton.rounds == 0 and run.binder.draws == 8, "four poses, each tested"


def test_a_long_search_has_it_bound_until_nothing_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two tries of the four poses in the first round; the one that is clear comes in the next."""
    monkeypatch.setattr(adaptive, "FIRST_TRIES", 2)
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == 4)
    values = bind_within_effort(run, skeleton, 1000)
    assert values is not None and [
        run.streams.objects.values[name] for name in values.values()
    ] == [4]
    assert skeleton.rounds == 1

    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert bind_within_effort(run, skeleton, 1000) is None, (
        "no round is without end where nothing is drawn"
    )


def test_the_next_plan_begins_with_the_values_of_the_last_one() -> None:
    """Two cups whose third pose is clear: the plan in the other order draws none of them anew."""
    run, skeleton = planned("(and (put tea) (put mug))", lambda cup, pose: pose == 3)
    first = run.binder.bind(skeleton, 4, 100)
    assert first is not None
    spent = run.binder.draws

    other, alone = (planned(goal, lambda cup, pose: pose == 3)[1] for goal in GOALS)
    for later in (other, alone):
        later.recall(skeleton)
        values = run.binder.bind(later, 4, 100)
        assert values is not None and set(values.values()) <= set(first.values())
        assert run.binder.draws == spent
    assert len(other.memory) > len(alone.memory) > 0


def test_a_value_is_recalled_for_the_inputs_that_it_was_drawn_for() -> None:
    """The mug's call is another one than the tea's, whatever that has drawn."""
    run, skeleton = planned("(put tea)")
    assert run.binder.bind(skeleton, 4, 100) is not None
    mug = planned("(put mug)")[1]
    mug.recall(skeleton)
    assert skeleton.memory and not mug.memory


def test_a_long_search_has_each_call_of_its_plan_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Its four calls ask for more than its one state does: a second round finds the second pose."""
    monkeypatch.setattr(adaptive, "FIRST_TRIES", 1)
    monkeypatch.setattr(adaptive, "LONG_SEARCH", 1)
    monkeypatch.setattr(adaptive, "DRAWS_FOR_A_STATE", 1)
    run, skeleton = planned("(and (put tea) (put mug))", lambda cup, pose: pose == 2)
    assert len(skeleton.nodes) == 4
    assert bind_within_effort(run, skeleton, 1) is not None
    assert skeleton.rounds == 1


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
