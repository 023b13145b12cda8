"""Values for a skeleton: what is tried, in which order, and how much of it."""

from __future__ import annotations

import pytest

from tamp.system.deadline import Deadline, OutOfTime
from tests.symbolic.algorithms.binding.shelf import planned


@pytest.mark.parametrize("good", [1, 2, 4])
def test_the_value_that_passes_is_taken(good: int) -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == good)
    values = run.binder.bind(skeleton, 4, 100)
    assert values is not None
    assert [run.task.objects.values[name] for name in values.values()] == [good]
    assert run.binder.draws == 2 * good  # each pose is drawn and tested once


def test_without_enough_tries_there_is_none_and_later_there_is() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == 4)
    assert run.binder.bind(skeleton, 2, 100) is None
    assert run.binder.bind(skeleton, 4, 100) is not None


def test_what_worked_is_tried_first() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == 2)
    first = run.binder.bind(skeleton, 4, 100)
    spent = run.binder.draws
    assert run.binder.bind(skeleton, 4, 100) == first
    assert run.binder.draws == spent


def test_a_failure_goes_back_to_what_it_depends_on() -> None:
    """One cup's pose does not pass: the other cup's poses have nothing to do with it, and are not all tried."""
    asked: list[tuple[str, int]] = []

    def clear(cup: str, pose: int) -> bool:
        asked.append((cup, pose))
        return cup == "tea"

    run, skeleton = planned("(and (put tea) (put mug))", clear)
    assert run.binder.bind(skeleton, 4, 1000) is None
    assert sum(cup == "tea" for cup, _ in asked) <= 1
    assert sorted(pose for cup, pose in asked if cup == "mug") == [1, 2, 3, 4]


def test_with_more_tries_it_goes_on_where_it_failed() -> None:
    """The mug's third pose takes three tries; the tea keeps the pose that it has."""
    asked: list[tuple[str, int]] = []

    def clear(cup: str, pose: int) -> bool:
        asked.append((cup, pose))
        return cup == "tea" or pose == 3

    run, skeleton = planned("(and (put tea) (put mug))", clear)
    more = iter([2, 3])
    values = run.binder.bind(skeleton, 1, 1000, more=lambda: next(more, None))
    assert values is not None and asked.count(("tea", 1)) == 1
    assert [pose for cup, pose in asked if cup == "mug"] == [1, 2, 3]
    assert next(more, None) is None


def test_more_tries_are_asked_for_only_where_something_was_drawn() -> None:
    """A fifth pose is asked for and there is none: the round after that draws nothing, and ends."""
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    more = iter(range(5, 100))
    assert run.binder.bind(skeleton, 4, 1000, more=lambda: next(more)) is None
    assert next(more) == 7 and run.binder.draws == 9


def test_the_last_word_is_asked_of_all_values() -> None:
    run, skeleton = planned("(put tea)")
    heard: list[object] = []

    def holds(values: dict[int, str]) -> bool:
        heard.extend(run.task.objects.values[name] for name in values.values())
        return heard[-1] == 3

    values = run.binder.bind(skeleton, 4, 100, holds=holds)
    assert values is not None and heard == [1, 2, 3]


def test_failures_are_noted_under_what_they_concern() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: False)
    assert run.binder.bind(skeleton, 4, 100) is None
    drawn, tested = (run.knowledge.experience.facts[node.fact] for node in skeleton.nodes)
    assert (drawn.successes, drawn.failures) == (4, 0)
    assert (tested.successes, tested.failures) == (0, 4) and tested.price > 0.0


def test_the_end_of_the_time_is_the_end() -> None:
    run, skeleton = planned("(put tea)")
    run.binder._deadline = Deadline(0.0)  # pyright: ignore[reportPrivateUsage]
    with pytest.raises(OutOfTime):
        run.binder.bind(skeleton, 4, 100)
