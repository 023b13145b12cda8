"""Binding a skeleton: draw, test, and jump back to a choice that the failure depends on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence, Set

from tamp.symbolic.algorithms.binding.levels import Level, Levels
from tamp.symbolic.algorithms.binding.skeleton import CallNode, LiftedFact, Skeleton, Term
from tamp.symbolic.algorithms.bound_stream import Instance, Streams
from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.algorithms.optimistic.optimistic_facts import PLACEHOLDER_MARK
from tamp.symbolic.pddl.structs import Fact
from tamp.system.deadline import Deadline, OutOfTime

MAX_REFUSED_BINDINGS = 20
"""Complete sets of values that may turn out not to hold before a skeleton is left for this time."""

RECENT_RESULTS = 3
"""How many of an instance's latest results are tried again before drawing new ones."""


class Binder:
    """Backtracking with conflict-directed backjumping (Prosser 1993) over a skeleton's calls.

    A level whose candidates run out after `tries` new draws hands its conflict set to the deepest
    level in it. Every failure is noted in `experience` under the symbolic fact that it concerns.
    """

    def __init__(self, streams: Streams, experience: Experience, deadline: Deadline) -> None:
        self._streams = streams
        self._experience = experience
        self._deadline = deadline
        self.draws = 0
        self._exhausted_met: list[tuple[CallNode, Instance]] = []

    def bind(
        self,
        skeleton: Skeleton,
        tries: int,
        budget: int,
        fresh: Set[int] = frozenset(),
        *,
        holds: Callable[[dict[int, str]], bool] | None = None,
        more: Callable[[], int | None] | None = None,
    ) -> dict[int, str] | None:
        """Find values for all variables, or None when none were found within the budget.

        Args:
            skeleton: What to bind; it remembers the values that worked, to be tried first next
                time.
            tries: New draws a visit of a node.
            budget: Draws in all.
            fresh: The nodes that are to take new values before those that worked.
            holds: Has the last word on values for all variables; what it refuses is not returned.
            more: Asked where a node has failed whatever the others' values are, for more new draws
                a visit: it is gone on with there, and the others keep their values. None ends it.
        """
        nodes = skeleton.nodes
        makers = skeleton.makers
        values: dict[int, str] = {}
        levels = Levels(skeleton.users, fresh)

        spent_before = self.draws
        self._exhausted_met.clear()
        refusals = 0

        def enter(index: int) -> Level:
            level = self._enter(skeleton, index, makers, values, tries, index in fresh)
            levels.enter(index, level)
            return level

        def level_at(index: int) -> Level:
            level = levels.valid_level(index)
            if level is None:
                level = enter(index)
                next(level.candidates)  # the value that it has
            return level

        while True:
            index = levels.next()
            if index is not None:
                level = enter(index)
            elif holds is None or holds(values):
                return values
            else:
                refusals += 1
                if refusals > MAX_REFUSED_BINDINGS or not nodes:
                    return None
                index = len(nodes) - 1
                level = level_at(index)
                level.conflict.update(range(index))  # any of them may be to blame

            while (outputs := next(level.candidates, None)) is None:
                conflict = level.conflict | level.culprits
                conflict.discard(index)
                spent = self.draws - spent_before
                raised = None if more is None or conflict or not spent else more()
                if raised is not None:
                    tries, spent_before = raised, self.draws
                    level = enter(index)
                    continue
                if not conflict or spent > budget:
                    self._note_end(nodes, None if conflict else index, spent)
                    return None

                target = max(conflict)
                levels.jump(index, target)
                index, level = target, level_at(target)
                level.culprits |= conflict
                if self._deadline.passed:
                    raise OutOfTime

            levels.take(index, outputs)
            values.update(zip(nodes[index].outputs, outputs, strict=True))

    def _note_end(self, nodes: Sequence[CallNode], failed: int | None, spent: int) -> None:
        """Note what is learned from values that were not found: nothing is left to draw, or a node
        failed whatever the others' values are.
        """
        if not spent:
            # what is known to fail failed once more
            for node, instance in self._exhausted_met:
                self._note(node, instance, False)
        if failed is not None:
            self._evaluate_remaining_tests(nodes, failed)

    def _evaluate_remaining_tests(self, nodes: Sequence[CallNode], failed: int) -> None:
        """Ask the later tests of real values too, once one failed for good: search learns from all.

        Not those that rest on what a test of this skeleton has yet to certify.
        """
        tests = [node for node in nodes if node.stream.is_test]
        pending = {atom.predicate for node in tests for atom in node.stream.declaration.certified}
        for node in nodes[failed + 1 :]:
            declaration = node.stream.declaration
            words = [term for term in node.inputs if isinstance(term, str)]
            asks = (
                node.stream.is_test and not declaration.fluents and len(words) == len(node.inputs)
            )
            if not asks or any(atom.predicate in pending for atom in declaration.domain):
                continue
            instance = self._streams.instance(node.stream.name, tuple(words))
            if not instance.exhausted:
                if self._deadline.passed:
                    raise OutOfTime
                self.draws += 1
                self._note(node, instance, self._streams.draw(instance) is not None)

    def _enter(
        self,
        skeleton: Skeleton,
        index: int,
        makers: dict[int, int],
        values: dict[int, str],
        tries: int,
        fresh: bool,
    ) -> Level:
        node = skeleton.nodes[index]
        inputs = tuple(value_of(term, values) for term in node.inputs)
        fluents = node.given.union(
            (fact[0], *(value_of(term, values) for term in fact[1]))
            for fact, _ in node.fluents
            if all(isinstance(term, str) or term in values for term in fact[1])
        )
        instance = self._streams.instance(node.stream.name, inputs, fluents)
        conflict = {makers[term] for term in node.inputs if isinstance(term, int)}
        return Level(
            self._candidates(skeleton, index, instance, makers, conflict, tries, fresh), conflict
        )

    def _candidates(
        self,
        skeleton: Skeleton,
        index: int,
        instance: Instance,
        makers: dict[int, int],
        conflict: set[int],
        tries: int,
        fresh: bool,
    ) -> Iterator[tuple[str, ...]]:
        """Yield the last value and a few recent ones, then new draws, then the earliest results.

        New draws come before most earlier results, since what failed once often fails again; the
        earliest ones come back so that, with growing `tries`, every pair of values meets.
        """
        node = skeleton.nodes[index]
        key: tuple[object, ...] = (
            instance.inputs,
            frozenset[Fact]() if node.stream.is_advisory else instance.fluents,
        )
        offered: set[tuple[str, ...]] = set()

        def offer(outputs: tuple[str, ...]) -> bool:
            if outputs in offered:
                return False
            offered.add(outputs)
            skeleton.memory[index] = (key, outputs)
            return True

        remembered = skeleton.memory.get(index)
        if not fresh and remembered is not None and remembered[0] == key and offer(remembered[1]):
            yield remembered[1]

        earlier = list(instance.results)
        for outputs in () if fresh else reversed(earlier[-RECENT_RESULTS:]):
            if offer(outputs):
                yield outputs

        if instance.exhausted and not instance.results:
            self._exhausted_met.append((node, instance))
        draws = 1 if node.stream.is_test else max(1, tries // 4) if node.stream.is_fluent else tries
        for _ in range(draws if fresh else max(draws - len(earlier), (draws + 1) // 2)):
            if self._deadline.passed:
                raise OutOfTime
            if instance.exhausted:
                break
            self.draws += 1
            outputs = self._streams.draw(instance)
            self._note(node, instance, outputs is not None)
            if outputs is not None and offer(outputs):
                yield outputs

        for outputs in earlier[:draws]:
            if offer(outputs):
                yield outputs
        if not instance.results:
            self._blame(node, instance, makers, conflict)

    def _note(self, node: CallNode, instance: Instance, success: bool) -> None:
        if success or instance.last is None:
            self._experience.record(node.fact, None)
            return
        if node.stream.is_fluent and instance.last.blockers:
            present = _present(node, instance.last.blockers)
            if present:
                self._experience.record_nogood(node.fact, present, instance.last)
                return
        elif node.stream.is_fluent and instance.exhausted and not instance.results:
            present = frozenset(fact for _, fact in node.fluents)
            words = (*node.guess[0], *(word for fact in present for word in fact[1:]))
            if not any(word.startswith(PLACEHOLDER_MARK) for word in words):
                call = (node.stream.name, node.guess[0])
                self._experience.record_failing_state(
                    call, node.stream.declaration.fluents, present
                )
            if present:  # nobody says what of the state is to blame
                self._experience.record_nogood(node.fact, present, instance.last)
        self._experience.record(node.fact, instance.last)

    def _blame(
        self, node: CallNode, instance: Instance, makers: dict[int, int], conflict: set[int]
    ) -> None:
        """Add to the conflict the levels that placed what a failed fluent stream met."""
        if not node.stream.is_fluent:
            return
        blockers = instance.last.blockers if instance.last is not None else ()
        for (_, terms), fact in node.fluents:
            if not blockers or any(word in blockers for word in fact[1:]):
                conflict |= {makers[term] for term in terms if isinstance(term, int)}


def _present(node: CallNode, blockers: tuple[str, ...]) -> frozenset[Fact]:
    """Return the symbolic state facts about the blockers."""
    return frozenset(fact for _, fact in node.fluents if any(word in blockers for word in fact[1:]))


def value_of(term: Term, values: Mapping[int, str]) -> str:
    """Return a term's value."""
    return term if isinstance(term, str) else values[term]


def substitute(fact: LiftedFact, values: Mapping[int, str]) -> Fact:
    """Return a lifted fact with its variables' values."""
    return (fact[0], *(value_of(term, values) for term in fact[1]))
