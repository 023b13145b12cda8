"""Optimistic facts: which call would certify a fact, also a test that is made up when asked for."""

from __future__ import annotations

import pytest

from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.optimistic.optimistic_facts import OptimisticFacts, OptimisticInstance
from tamp.symbolic.pddl.structs import Atom, Stream

CLEAR = BoundStream(
    Stream(
        "test-clear", ("?o", "?p", "?o2"), (Atom("pose", ("?o", "?p")),), (),
        (Atom("clear", ("?p", "?o", "?o2")), Atom("tested", ("?o2",))),
    ),
    lambda: True,
    (),
)  # fmt: skip
POSE = BoundStream(
    Stream("sample", ("?o",), (), ("?p",), (Atom("pose", ("?o", "?p")),)),
    lambda: None,
    (("pose",),),
)


def sampled() -> OptimisticInstance:
    return OptimisticInstance(POSE, ("cup",), ("#p1",), (), (("pose", "cup", "#p1"),), 1)


def lazily() -> OptimisticFacts:
    return OptimisticFacts(lazily_tested={"clear": (CLEAR, CLEAR.declaration.certified[0])})


def test_a_fact_has_the_producer_that_certifies_it() -> None:
    facts, instance = OptimisticFacts(), sampled()
    facts.producers["pose", "cup", "#p1"] = instance
    assert facts.producer(("pose", "cup", "#p1")) is instance
    assert facts.producer(("pose", "jar", "#p1")) is None
    assert instance.call == ("sample", ("cup",))


def test_a_lazy_test_is_made_up_by_its_atoms_terms_and_once() -> None:
    """The fact has the terms in another order than the stream has its inputs."""
    facts = lazily()
    made = facts.producer(("clear", "#p1", "cup", "jar"))
    assert made is not None
    assert made.inputs == ("cup", "#p1", "jar") and made.outputs == ()
    assert made.domain == (("pose", "cup", "#p1"),)
    assert made.certified == (("clear", "#p1", "cup", "jar"), ("tested", "jar"))
    assert facts.producer(("clear", "#p1", "cup", "jar")) is made
    assert facts.producer(("clear", "#p1", "cup", "pan")) is not made
    assert facts.instances == []  # there are as many as pairs


def test_a_predicate_that_is_not_lazy_is_not_made_up() -> None:
    assert lazily().producer(("tested", "jar")) is None


@pytest.mark.parametrize(
    ("inputs", "real"), [(("cup", "p1"), True), (("cup", "#p1"), False), ((), True)]
)
def test_a_call_without_placeholders_is_final(inputs: tuple[str, ...], real: bool) -> None:
    assert OptimisticInstance(POSE, inputs, (), (), (), 0).has_real_inputs is real


def test_a_placeholder_has_a_fact_of_the_call_that_gives_it() -> None:
    facts = lazily()
    facts.producer(("clear", "#p1", "cup", "jar"))  # speaks of it and does not give it
    facts.producers["pose", "cup", "#p1"] = sampled()
    assert facts.certified_fact_of("#p1") == ("pose", "cup", "#p1")
    with pytest.raises(StopIteration):
        facts.certified_fact_of("#p2")
