"""Mutexes: pairs of facts that no reachable state contains, and goals that exclude each other.

The h2 reachability of Haslum and Geffner (AIPS 2000), each fact's partners in one integer, as
Alcazar and Torralba do (ICAPS 2015). It forgets triples, guards and what conditional effects
delete, so it only ever proves too little.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import combinations

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.compatible_ways import hold_together
from tamp.symbolic.search.goal_ways import GoalPart, Literal, goal_parts
from tamp.symbolic.search.lasting import lasting
from tamp.symbolic.search.operators import InstantiatedTask, Operator
from tamp.system.deadline import Deadline

MOST_PAIRS = 4_000_000
"""Pairs of facts of the largest task that is looked at: 2,000 facts take some seconds."""


class MutexUndecided(Exception):
    """The task is too large, or the time is up: nothing is known."""


def excluded(instantiated: InstantiatedTask, deadline: Deadline) -> tuple[Literal, ...] | None:
    """Find the fewest parts of the goal that are proven not to hold together; None if none is.

    Args:
        instantiated: The task; its guards are not looked at.
        deadline: When to give up.
    """
    try:
        parts = goal_parts(instantiated)
        return Mutexes(
            replace(instantiated, operators=lasting(instantiated).operators), parts, deadline
        ).conflict()
    except MutexUndecided:
        return None


class Mutexes:
    """Pairs of facts that a reachable state may contain; an absence the goal wants is a fact.

    Args:
        instantiated: The task.
        parts: Of its goal.
        deadline: When to give up.

    Raises:
        MutexUndecided: There are too many facts, or the time was up.
    """

    def __init__(
        self, instantiated: InstantiatedTask, parts: list[GoalPart], deadline: Deadline
    ) -> None:
        self._parts, self._deadline = parts, deadline
        named = [
            part for top in parts for part in (top, *(p for some in top.choices for p in some))
        ]
        wanted = {literal for part in named for way in part.ways for literal in way}
        absent = {literal for literal in wanted if not literal[1]}
        heads = {axiom.head for axiom in instantiated.axioms}
        facts = {(fact, True) for fact in (instantiated.initial | instantiated.reachable) - heads}
        facts |= wanted
        self._number = {
            literal: i
            for i, literal in enumerate([*sorted(facts), *((head, True) for head in heads)])
        }

        if len(self._number) ** 2 > MOST_PAIRS:
            raise MutexUndecided

        self._with = [0] * len(self._number)
        self._lasting = (1 << len(facts)) - 1
        self._absent = absent
        initial = [(fact, True) for fact in instantiated.initial] + [
            literal for literal in absent if literal[0] not in instantiated.initial
        ]

        start = self._mask(initial)
        for literal in initial:
            self._with[self._number[literal]] = start
        self._alive = start
        self._fixpoint(instantiated)

    def conflict(self) -> tuple[Literal, ...] | None:
        """Find the fewest parts of the goal that cannot hold together, as far as pairs show it."""
        possible = [self._possible(part) for part in self._parts]
        for part, ways in zip(self._parts, possible, strict=True):
            if not ways or (part.choices and not any(map(self._holds, part.choices))):
                return (part.literal,)

        named = {part.literal for part in self._parts}
        for fact, wanted in sorted(named):
            if wanted and (fact, False) in named:
                return ((fact, True), (fact, False))

        for i, j in combinations(range(len(possible)), 2):
            self._look()
            if not any(self._together(a, b) for a in possible[i] for b in possible[j]):
                return (self._parts[i].literal, self._parts[j].literal)
        if self._hold_together(possible):
            return None

        kept = list(range(len(possible)))
        for index in list(kept):
            others = [k for k in kept if k != index]
            if not self._hold_together([possible[k] for k in others]):
                kept = others
        return tuple(self._parts[k].literal for k in kept)

    def exclusive(self, facts: Sequence[Fact], wanted: int) -> list[int]:
        """Return for each wanted fact a mask of those that never hold together with it.

        Args:
            facts: Bit i of a mask is fact i; of one that the task does not know nothing is known.
            wanted: A mask.
        """
        numbers = [self._number.get((fact, True), -1) for fact in facts]
        found: list[int] = []
        for own in (number for i, number in enumerate(numbers) if wanted >> i & 1):
            together = self._with[own] if own >= 0 else -1
            apart = [other >= 0 and not together >> other & 1 for other in numbers]
            found.append(sum(1 << i for i, never in enumerate(apart) if never))
        return found

    def _possible(self, part: GoalPart) -> list[tuple[int, ...]]:
        return [way for way in map(self._numbers, part.ways) if self._consistent(way)]

    def _hold_together(self, possible: list[list[tuple[int, ...]]]) -> bool:
        return hold_together(possible, self._partners, self._look)

    def _holds(self, parts: tuple[GoalPart, ...]) -> bool:
        """Check that these may hold together, as far as pairs show it."""
        return self._hold_together([self._possible(part) for part in parts])

    def _fixpoint(self, instantiated: InstantiatedTask) -> None:
        """Apply operators and rules to pairs until no new one comes."""
        moves = list(
            dict.fromkeys(
                move for operator in instantiated.operators for move in self._moves(operator)
            )
        )

        rules = [
            (self._number[a.head, True], self._body(a.positive, a.negative))
            for a in instantiated.axioms
        ]

        seen: list[tuple[int, ...] | None] = [None] * len(moves)
        changed = True
        while changed:
            changed = self._derive(rules)
            for index, (before, added, removed) in enumerate(moves):
                if not index % 256:
                    self._look()
                state = tuple([self._with[k] for k in before])
                if (before and state == seen[index]) or not self._consistent(before):
                    continue
                seen[index] = state

                kept = self._partners(before) & self._lasting & ~removed
                after = kept | self._bits(added)
                for k in added:
                    changed |= self._meet(k, after)

    def _derive(self, rules: list[tuple[int, tuple[int, ...]]]) -> bool:
        """Give derived facts the partners of what they follow from; say if there were new ones."""
        any_new, changed = False, True
        while changed:
            changed = False
            for head, body in rules:
                if self._consistent(body):
                    changed |= self._meet(head, self._partners(body) | 1 << head)
            any_new |= changed
            self._look()
        return any_new

    def _meet(self, k: int, others: int) -> bool:
        """Note that a fact occurs with these; say if any of them is new."""
        new = others & ~self._with[k]
        if not new:
            return False
        self._with[k] |= new
        self._alive |= 1 << k
        bit = 1 << k
        while new:
            low = new & -new
            new ^= low
            self._with[low.bit_length() - 1] |= bit
        return True

    def _moves(self, operator: Operator) -> Iterator[tuple[tuple[int, ...], tuple[int, ...], int]]:
        """Yield what an operator needs, adds, surely removes; again for each conditional effect."""
        needs = self._body(operator.positive, operator.negative)
        gone = set(operator.deleted)
        for effect in operator.conditional:
            if not effect.negative:  # what is removed whenever it is there is gone afterwards
                gone |= {
                    fact for fact in effect.deleted if effect.positive <= operator.positive | {fact}
                }

        gone -= operator.added
        perhaps = {fact for effect in operator.conditional for fact in effect.added}

        removed = self._bits(self._numbers((fact, True) for fact in gone - perhaps))
        removed |= self._bits(self._numbers((fact, False) for fact in operator.added))
        added = {(fact, True) for fact in operator.added} | {(fact, False) for fact in gone}
        steady = self._numbers(added)
        if steady or removed:
            yield needs, steady, removed

        extra: list[int] = []
        for effect in operator.conditional:
            adds = {(fact, True) for fact in effect.added}
            adds |= {(fact, False) for fact in effect.deleted - operator.added}
            numbers = tuple(k for k in self._numbers(adds) if k not in steady)
            if numbers:
                condition = self._body(effect.positive, effect.negative)
                both = tuple(sorted({*needs, *condition}))
                extra += numbers
                yield both, tuple(sorted({*steady, *numbers})), removed
        if len(extra) > 1:  # several conditions may hold at once
            yield needs, tuple(sorted({*steady, *extra})), removed

    def _body(self, positive: Iterable[Fact], negative: Iterable[Fact]) -> tuple[int, ...]:
        literals = [(fact, True) for fact in positive] + [(fact, False) for fact in negative]
        return tuple(
            sorted(
                self._number.get(literal, -1) for literal in literals if self._is_watched(literal)
            )
        )

    def _is_watched(self, literal: Literal) -> bool:
        """Check that a literal is looked at: absences only where the goal wants them."""
        return literal[1] or literal in self._absent

    def _numbers(self, literals: Iterable[Literal]) -> tuple[int, ...]:
        return tuple(
            sorted(self._number[literal] for literal in literals if literal in self._number)
        )

    def _mask(self, literals: Iterable[Literal]) -> int:
        return self._bits(self._numbers(literals))

    def _bits(self, numbers: Iterable[int]) -> int:
        mask = 0
        for k in numbers:
            mask |= 1 << k
        return mask

    def _partners(self, numbers: tuple[int, ...]) -> int:
        """Return what goes with each of these."""
        mask = self._alive
        for k in numbers:
            mask &= self._with[k]
        return mask

    def _consistent(self, numbers: tuple[int, ...]) -> bool:
        """Check that these go together, pair by pair; a fact without a number never holds."""
        wanted = 0
        for k in numbers:
            if k < 0:
                return False
            wanted |= 1 << k
        return all(wanted & ~self._with[k] == 0 for k in numbers)

    def _together(self, a: tuple[int, ...], b: tuple[int, ...]) -> bool:
        wanted = self._bits(b)
        return all(wanted & ~self._with[k] == 0 for k in a)

    def _look(self) -> None:
        if self._deadline.passed:
            raise MutexUndecided
