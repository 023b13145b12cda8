"""Knowledge of a run: calls that ended, facts that are certified or false, prices of failures."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import chain

from tamp.stream import Rejection
from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.bound_stream import Instance, Streams
from tamp.symbolic.algorithms.experience.stream_statistics import CallKey, Experience
from tamp.symbolic.algorithms.optimistic.optimistic_facts import (
    PLACEHOLDER_MARK,
    PlaceholdersOfCalls,
)
from tamp.symbolic.pddl.structs import Fact

MAX_ENUMERATED_VALUES = 8
"""A stream that ended with no more values than this is replaced by them: a search can then prove
that none will do."""


@dataclass(eq=False, slots=True)
class Knowledge:
    """All that a run has found out; what it plans next follows from this and from the task.

    Attributes:
        exhausted_calls: Calls with real inputs that ended without a value, each with its reason.
        enumerated_calls: Calls that ended with few values, which stand in the place of their
            placeholders.
        certified_facts: Static facts of enumerated values, and those that streams found besides.
        sampled_facts: Facts of values drawn ahead of any plan, each with the instance that gave it;
            None for those found besides.
        false_facts: Facts of tests that do not hold.
        excluded_objects: Objects of which no stream is instantiated, for the time being.
        experience: What binding has taught: successes and failures of symbolic facts.
        placeholders: Those of every call that was instantiated.
        depth_factor: How many times the first depth and number of instances are instantiated.
        depth_limit: Depth of instances with outputs; None while there is no need for one.
        incomplete: Whether something was given up early, so that failure proves nothing.
    """

    exhausted_calls: dict[CallKey, Rejection] = field(default_factory=dict[CallKey, Rejection])
    enumerated_calls: set[CallKey] = field(default_factory=set[CallKey])
    certified_facts: dict[Fact, None] = field(default_factory=dict[Fact, None])
    sampled_facts: dict[Fact, Instance | None] = field(default_factory=dict[Fact, Instance | None])
    false_facts: set[Fact] = field(default_factory=set[Fact])
    excluded_objects: frozenset[str] = frozenset()
    experience: Experience = field(default_factory=Experience)
    placeholders: PlaceholdersOfCalls = field(default_factory=PlaceholdersOfCalls)
    depth_factor: int = 1
    depth_limit: int | None = None
    incomplete: bool = False

    @property
    def ended_calls(self) -> frozenset[CallKey]:
        """Return the calls of which nothing new is to come."""
        return frozenset((*self.exhausted_calls, *self.enumerated_calls))


def record_exhausted_calls(
    knowledge: Knowledge, skeleton: Skeleton, streams: Streams, objects: Iterable[str]
) -> bool:
    """Record the skeleton's calls with real inputs that ended; say if any are new.

    Args:
        knowledge: Is added to.
        skeleton: What was bound last.
        streams: What was drawn.
        objects: The names of the task's own objects.
    """
    before = len(knowledge.exhausted_calls) + len(knowledge.enumerated_calls)
    for node in skeleton.nodes:
        if node.stream.is_fluent or any(isinstance(term, int) for term in node.inputs):
            continue

        inputs = tuple(str(term) for term in node.inputs)
        for instance in streams.instances(node.stream.name, inputs):
            if not instance.exhausted:
                continue
            knowledge.incomplete |= instance.last is not None and instance.last.given_up
            if not instance.results:
                knowledge.exhausted_calls.setdefault(
                    (node.stream.name, inputs), instance.last or Rejection("has no value")
                )
                knowledge.false_facts.add(node.fact)
            elif not node.stream.is_advisory and len(instance.results) <= MAX_ENUMERATED_VALUES:
                knowledge.enumerated_calls.add((node.stream.name, inputs))
                for outputs in instance.results:
                    certified = streams.certified(instance, outputs)
                    knowledge.certified_facts.update(dict.fromkeys(certified))

    if knowledge.enumerated_calls:
        _record_false_tests(knowledge, streams, objects)
    return len(knowledge.exhausted_calls) + len(knowledge.enumerated_calls) > before


def _record_false_tests(knowledge: Knowledge, streams: Streams, objects: Iterable[str]) -> None:
    """Record all tests of enumerated values that are false, so that no search proposes them."""
    names = {*objects, *(name for fact in knowledge.certified_facts for name in fact[1:])}
    for instance in streams.false_tests():
        if names.issuperset(instance.inputs):
            key = (instance.stream.name, instance.inputs)
            knowledge.exhausted_calls.setdefault(key, instance.last or Rejection("does not hold"))
            knowledge.false_facts.update(streams.certified(instance, ()))


def add_wild_facts(knowledge: Knowledge, streams: Streams) -> bool:
    """Add the facts that streams found besides; say if there were new ones."""
    before = len(knowledge.certified_facts)
    knowledge.certified_facts.update(streams.wild)
    return len(knowledge.certified_facts) > before


def restore_objects(knowledge: Knowledge, objects: frozenset[str] | None = None) -> bool:
    """Stop excluding these objects, or all of them; say if there were any."""
    restored = (
        knowledge.excluded_objects if objects is None else objects & knowledge.excluded_objects
    )
    knowledge.excluded_objects -= restored
    return bool(restored)


def may_give_more(knowledge: Knowledge, skeleton: Skeleton) -> bool:
    """Check that all calls of a skeleton may give something new; else others may serve it."""
    calls = (((node.stream.name, node.guess[0]), bool(node.outputs)) for node in skeleton.nodes)
    return not any(
        call in knowledge.exhausted_calls or (gives and call in knowledge.enumerated_calls)
        for call, gives in calls
    )


def certified_fact_of(knowledge: Knowledge, name: str) -> Fact | None:
    """Return a fact that the call which gave a real value certifies of it; None of objects."""
    if name.startswith(PLACEHOLDER_MARK):
        return None
    facts = chain(knowledge.sampled_facts, knowledge.certified_facts)
    return next((fact for fact in facts if name in fact[1:]), None)
