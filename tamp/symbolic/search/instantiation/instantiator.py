"""Instantiation of a lifted task: once, or again and again while facts come along."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tamp.symbolic.pddl.structs import Fact, Task
from tamp.symbolic.search.instantiation.normal_form import Types
from tamp.symbolic.search.instantiation.predicate_kinds import NOTHING, Assumed
from tamp.symbolic.search.instantiation.task_instantiation import Instantiation
from tamp.symbolic.search.operators import InstantiatedTask


def instantiate(
    task: Task,
    facts: Iterable[Fact] = (),
    objects: Mapping[str, Types] | None = None,
    *,
    assumed: Assumed = NOTHING,
    refused: frozenset[Fact] = frozenset(),
) -> InstantiatedTask:
    """Instantiate a task once; see `Instantiator`."""
    return Instantiator(task, assumed).instantiate(facts, objects or {}, refused)


class Instantiator:
    """Instantiates a task again and again while static facts and objects come along: only what is
    new is joined.

    Args:
        task: Gives actions, derived rules, the initial state, the goal, costs.
        assumed: Static predicates of tests that are taken to hold, without listing their facts,
            where they would waive a guard; each with what has to be known (`Assumed`).
    """

    def __init__(self, task: Task, assumed: Assumed = NOTHING) -> None:
        self._task, self._assumed = task, assumed
        self._facts: frozenset[Fact] = frozenset()
        self._run: Instantiation | None = None
        self._derived = frozenset(rule.head.predicate for rule in task.domain.derived)
        self._given = self._derived & {fact[0] for fact in task.initial}

    def instantiate(
        self,
        facts: Iterable[Fact] = (),
        objects: Mapping[str, Types] | None = None,
        refused: frozenset[Fact] = frozenset(),
    ) -> InstantiatedTask:
        """Instantiate the task over these facts. It begins anew where one of the last time is
        missing, or an absence has ended.

        Args:
            facts: Static facts besides those of the initial state: certified by streams, really or
                optimistically.
            objects: Further objects with their types, placeholders among them.
            refused: Facts of the assumed predicates that are known not to hold.

        Raises:
            InputError: A derived fact depends on its own negation, or an action's cost is not
                known.
        """
        known = frozenset(facts)
        new = known - self._facts
        kept = self._run is not None and self._facts <= known
        given = self._given | (self._derived & {fact[0] for fact in new})
        ended = self._run is not None and any(fact[0] in self._run.absences for fact in new)
        if self._run is None or not kept or ended or given != self._given:
            self._given = given
            self._run, new = Instantiation(self._task, self._assumed, given), known
        self._facts = known
        return self._run.instantiate(new, objects or {}, refused)
