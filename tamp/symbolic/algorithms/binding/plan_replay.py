"""Replay of a bound plan by the book, on what the streams really certified."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from tamp.symbolic.algorithms.binding.binder import substitute, value_of
from tamp.symbolic.algorithms.binding.skeleton import CallNode, Skeleton
from tamp.symbolic.algorithms.bound_stream import Streams
from tamp.symbolic.pddl.complement import atoms_of_conditions
from tamp.symbolic.pddl.structs import Fact, Task
from tamp.symbolic.search.replay import violation


@dataclass(frozen=True)
class Fault:
    """A reason why a bound plan does not hold.

    Attributes:
        reason: In words.
        expected: Whether nobody could know it before the values were there: something found besides
            forbids it, or values that were imagined as different are the same. Otherwise the
            planner has made a mistake.
    """

    reason: str
    expected: bool


Shown = tuple[tuple[str, ...], frozenset[Fact]]
"""The predicates of the facts that a stream is shown, and those of them that no action changes."""


@dataclass
class _Certified:
    """Facts by streams that look at the state: they hold in states that have what was shown."""

    shown: dict[Shown, dict[frozenset[Fact], list[Fact]]] = field(
        default_factory=dict[Shown, dict[frozenset[Fact], list[Fact]]]
    )

    def of(self, state: frozenset[Fact]) -> Iterable[Fact]:
        """Yield those that hold in a state because its facts were shown."""
        for (predicates, given), made in self.shown.items():
            yield from made.get(given.union(fact for fact in state if fact[0] in predicates), ())

    @property
    def of_states(self) -> set[Fact]:
        """Return all those that hold in some states only."""
        return {fact for made in self.shown.values() for facts in made.values() for fact in facts}


class PlanReplay:
    """Judges bound plans of a run.

    Args:
        task: What is planned.
        streams: All that was drawn.
    """

    def __init__(self, task: Task, streams: Streams) -> None:
        self._task, self._streams = task, streams
        made = {
            atom.predicate
            for stream in streams.streams.values()
            for atom in stream.declaration.certified
        }
        asked = {
            atom.predicate for atom, sign in atoms_of_conditions(task.domain, task.goal) if not sign
        }
        self._absent = made & asked

    def fault(self, skeleton: Skeleton, values: Mapping[int, str]) -> Fault | None:
        """Find what is wrong with a bound plan, if anything is.

        Preconditions, derived predicates, effects and the goal are evaluated on the initial facts
        and those that the plan says it rests on; each of these must have been certified with these
        values, of the state at that step where its stream was shown one.
        """
        given = _Certified()
        for node in skeleton.nodes:
            if not node.stream.is_fluent:
                continue
            reason = self._take(node, values, given)
            if reason is not None:
                return Fault(reason, False)

        needed = (
            {substitute(fact, values) for fact in skeleton.certified}
            - given.of_states
            - self._task.initial
        )
        facts = needed & self._streams.certain
        for fact in sorted(needed - facts):
            if fact not in self._streams.wild:
                return Fault(f"({' '.join(fact)}) was not certified", False)
            facts.add(fact)

        actions = [
            (name, substitute((name, terms), values)[1:]) for name, terms in skeleton.actions
        ]
        reason = self._replayed(actions, facts, given)
        if reason is not None:
            return Fault(reason, self._coincide(skeleton, values))

        wild = set(self._streams.wild)
        if self._absent:  # what was found out about the plan's values, for this plan or another
            names = {*self._task.objects, *self._task.domain.constants}
            names.update(word for fact in facts for word in fact[1:])
            found = (fact for fact in self._streams.certain if fact[0] in self._absent)
            wild.update(fact for fact in found if names.issuperset(fact[1:]))
        if wild - facts:
            reason = self._replayed(actions, facts | wild, given)
        return None if reason is None else Fault(reason, True)

    def _coincide(self, skeleton: Skeleton, values: Mapping[int, str]) -> bool:
        """Check that a variable's value is another one's, or an object that task or plan names."""
        named = {*self._task.objects, *self._task.domain.constants}
        lifted = (*skeleton.actions, *skeleton.certified)
        named.update(term for _, terms in lifted for term in terms if isinstance(term, str))
        return len(set(values.values())) < len(values) or not named.isdisjoint(values.values())

    def _take(self, node: CallNode, values: Mapping[int, str], given: _Certified) -> str | None:
        """Add what a call certified of a state; say what is wrong if it never gave these values."""
        inputs = tuple(value_of(term, values) for term in node.inputs)
        outputs = tuple(values[variable] for variable in node.outputs)
        seen = node.given.union(substitute(fact, values) for fact, _ in node.fluents)
        called = self._streams.instances(node.stream.name, inputs)
        gave = [
            instance
            for instance in called
            if instance.fluents == seen and outputs in instance.results
        ]
        if not gave:
            return f"{node.stream.name}({', '.join(inputs)}) never gave ({', '.join(outputs)})"
        made = given.shown.setdefault((node.stream.declaration.fluents, node.given), {})
        made.setdefault(seen, []).extend(self._streams.certified(gave[0], outputs))
        return None

    def _replayed(
        self, actions: list[tuple[str, tuple[str, ...]]], facts: set[Fact], given: _Certified
    ) -> str | None:
        used = {word for _, arguments in actions for word in arguments}
        used.update(word for fact in facts for word in fact[1:])
        used.update(word for fact in given.of_states for word in fact[1:])
        types = self._streams.objects.types
        objects = {word: types[word] for word in sorted(used) if word in types}
        return violation(self._task, actions, facts, objects, given.of if given.shown else None)
