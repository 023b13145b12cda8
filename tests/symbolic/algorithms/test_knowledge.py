"""What a run takes over from calls that ended, and what it may exclude for a while."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tamp.stream import Rejection
from tamp.symbolic.algorithms.knowledge import (
    MAX_ENUMERATED_VALUES,
    Knowledge,
    add_wild_facts,
    certified_fact_of,
    may_give_more,
    record_exhausted_calls,
    restore_objects,
)
from tests.symbolic.algorithms.binding.shelf import planned

OBJECTS = ("tea", "mug")


def clear_at(*good: int) -> Callable[[str, int], bool]:
    return lambda cup, pose: pose in good


def test_few_values_of_a_call_that_ended_stand_in_its_place() -> None:
    run, skeleton = planned("(put tea)", clear_at())
    assert run.binder.bind(skeleton, 8, 100) is None
    knowledge = Knowledge()
    assert record_exhausted_calls(knowledge, skeleton, run.streams, OBJECTS)
    assert knowledge.enumerated_calls == {("sample-pose", ("tea",))}
    values = sorted(run.task.objects.values[fact[2]] for fact in knowledge.certified_facts)
    assert values == [1, 2, 3, 4] and {fact[0] for fact in knowledge.certified_facts} == {"pose"}
    assert {call[0] for call in knowledge.exhausted_calls} == {"test-clear"}
    assert len(knowledge.exhausted_calls) == 4 == len(knowledge.false_facts)
    assert knowledge.ended_calls == {*knowledge.enumerated_calls, *knowledge.exhausted_calls}
    assert not knowledge.incomplete
    assert not record_exhausted_calls(knowledge, skeleton, run.streams, OBJECTS), "nothing is new"


def test_a_call_that_may_give_more_is_not_recorded() -> None:
    run, skeleton = planned("(put tea)", clear_at())
    assert run.binder.bind(skeleton, 2, 100) is None
    knowledge = Knowledge()
    assert not record_exhausted_calls(knowledge, skeleton, run.streams, OBJECTS)
    assert not knowledge.ended_calls and may_give_more(knowledge, skeleton)


def test_tests_of_values_that_are_not_enumerated_are_no_news() -> None:
    """A false test of a value is worth a fact only where the value itself is a fact."""
    run, skeleton = planned("(put tea)", clear_at())
    assert run.binder.bind(skeleton, 2, 100) is None
    assert len(run.streams.false_tests()) == 2
    knowledge = Knowledge()
    record_exhausted_calls(knowledge, skeleton, run.streams, OBJECTS)
    assert not knowledge.false_facts


@pytest.mark.parametrize("given_up", [False, True])
def test_a_call_without_a_value_is_exhausted_and_proves_nothing_if_it_was_given_up(
    given_up: bool,
) -> None:
    run, skeleton = planned("(put tea)")
    instance = run.streams.instance("sample-pose", ("tea",))
    instance.exhausted, instance.last = True, Rejection("no room", given_up=given_up)
    knowledge = Knowledge()
    assert record_exhausted_calls(knowledge, skeleton, run.streams, OBJECTS)
    assert knowledge.exhausted_calls == {("sample-pose", ("tea",)): instance.last}
    assert knowledge.false_facts == {skeleton.nodes[0].fact}
    assert knowledge.incomplete == given_up
    assert not may_give_more(knowledge, skeleton)


def test_a_call_that_ended_silently_says_that_it_has_no_value() -> None:
    run, skeleton = planned("(put tea)")
    run.streams.instance("sample-pose", ("tea",)).exhausted = True
    knowledge = Knowledge()
    record_exhausted_calls(knowledge, skeleton, run.streams, OBJECTS)
    (rejection,) = knowledge.exhausted_calls.values()
    assert rejection.reason == "has no value"


@pytest.mark.parametrize("count", [1, MAX_ENUMERATED_VALUES, MAX_ENUMERATED_VALUES + 1])
def test_many_values_do_not_replace_their_placeholder(count: int) -> None:
    run, skeleton = planned("(put tea)")
    instance = run.streams.instance("sample-pose", ("tea",))
    instance.exhausted = True
    instance.results = [(f"p{number}",) for number in range(count)]
    knowledge = Knowledge()
    assert record_exhausted_calls(knowledge, skeleton, run.streams, OBJECTS) == (
        count <= MAX_ENUMERATED_VALUES
    )
    assert len(knowledge.certified_facts) == (count if count <= MAX_ENUMERATED_VALUES else 0)
    assert not knowledge.exhausted_calls


def test_facts_found_besides_are_added_once() -> None:
    run, _ = planned("(put tea)")
    knowledge = Knowledge()
    assert not add_wild_facts(knowledge, run.streams)
    run.streams.wild["near", "p1", "p2"] = None
    assert add_wild_facts(knowledge, run.streams)
    assert list(knowledge.certified_facts) == [("near", "p1", "p2")]
    assert not add_wild_facts(knowledge, run.streams)


def test_objects_are_restored_one_by_one_or_all() -> None:
    knowledge = Knowledge(excluded_objects=frozenset("abc"))
    assert restore_objects(knowledge, frozenset("bx"))
    assert knowledge.excluded_objects == frozenset("ac")
    assert not restore_objects(knowledge, frozenset("b"))
    assert not restore_objects(knowledge, frozenset())
    assert restore_objects(knowledge)
    assert knowledge.excluded_objects == frozenset()
    assert not restore_objects(knowledge)


def test_sampled_facts_certify_values_before_enumerated_ones() -> None:
    knowledge = Knowledge()
    knowledge.certified_facts["pose", "tea", "p1"] = None
    assert certified_fact_of(knowledge, "p1") == ("pose", "tea", "p1")
    knowledge.sampled_facts["supported", "tea", "p1"] = None
    assert certified_fact_of(knowledge, "p1") == ("supported", "tea", "p1")
    assert certified_fact_of(knowledge, "p2") is None
    assert certified_fact_of(knowledge, "pose") is None, "a predicate is no value"
    knowledge.certified_facts["pose", "tea", "#p9"] = None
    assert certified_fact_of(knowledge, "#p9") is None, "of placeholders the optimistic facts know"


def test_the_shape_of_knowledge_is_fixed() -> None:
    with pytest.raises(AttributeError):
        Knowledge().remembered = 1  # pyright: ignore[reportAttributeAccessIssue]


def test_two_runs_share_nothing() -> None:
    first, second = Knowledge(), Knowledge()
    first.false_facts.add(("clear",))
    first.experience.record(("clear",), None)
    assert not second.false_facts and not second.experience.facts
