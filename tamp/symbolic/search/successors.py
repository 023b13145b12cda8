"""The successor generator, the task over integers: applicable operators of a state, their costs,
what comes after.

Facts are numbered once; a state is an `int` whose set bits are the facts that hold.
benchmarks/search.py measures it against frozenset[int] for 100 to 2,000 facts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.axiom_strata import axiom_strata
from tamp.symbolic.search.instantiation.datalog import Row
from tamp.symbolic.search.instantiation.lazy_guards import DerivedGuards, LazyGuards
from tamp.symbolic.search.operators import Facts, InstantiatedTask

State = int
Price = Callable[[Fact], float] | Mapping[Fact, float]
"""What static facts cost; a mapping gives those that cost something, and is faster where guards are
many.
"""


def bits(mask: int) -> Iterator[int]:
    """Generate the numbers of the bits that are set, lowest first."""
    while mask:
        low = mask & -mask
        yield low.bit_length() - 1
        mask ^= low


class Successors:
    """An instantiated task with numbered facts and priced operators.

    Facts that no condition mentions are left out of the states, operators whose price is infinite
    are never applied.

    Attributes:
        facts: By number, sorted.
        operators: Indices into `instantiated.operators` are kept: entry i is about operator i.
        cost: The operators' costs with the prices of their static facts.
        axiom_cost: The prices of the axioms' static facts.
        initial: The initial state, without derived facts.
    """

    def __init__(self, instantiated: InstantiatedTask, price: Price) -> None:
        self.instantiated = instantiated
        self._listed: Mapping[Fact, float] | None = None if callable(price) else price
        self._ask: Callable[[Fact], float] = (
            price if callable(price) else lambda fact: price.get(fact, 0.0)
        )
        self._prices: dict[Fact, float] = {}
        self.operators = instantiated.operators
        self._guarded: dict[Facts, list[tuple[int, Fact | None]]] = {}
        self._blocked: dict[DerivedGuards, dict[Row, list[int]]] = {}
        self._collect_guards()
        self.facts = sorted(self._mentioned())
        self.number = {fact: i for i, fact in enumerate(self.facts)}
        self.cost = [o.cost + sum(map(self.price, o.static)) for o in self.operators]
        self.alive = [i for i, cost in enumerate(self.cost) if cost < math.inf]
        self._masks: dict[Facts, State] = {}  # operators share sets of facts
        mask = self.mask
        self.before = [mask(o.positive) for o in self.operators]
        self.absent = [mask(o.negative) for o in self.operators]
        self.added = [mask(o.added) for o in self.operators]
        self.kept = [~mask(o.deleted) for o in self.operators]
        self.conditional = [
            tuple(
                (mask(c.positive), mask(c.negative), mask(c.added), mask(c.deleted))
                for c in o.conditional
            )
            for o in self.operators
        ]
        self.initial = mask(instantiated.initial)
        self.goal = mask(instantiated.goal.positive)
        self.goal_absent = mask(instantiated.goal.negative)
        self.derived_mask = mask(axiom.head for axiom in instantiated.axioms)
        self.strata = axiom_strata(instantiated.axioms, mask)
        self.axiom_cost = [sum(map(self.price, axiom.static)) for axiom in instantiated.axioms]
        self.watched, self.always = self._watch()
        self.watch_mask = sum(1 << i for i in self.watched)
        self._guards_on = {mask(facts): owners for facts, owners in self._guarded.items()}
        self._many = [facts for facts in self._guards_on if facts.bit_count() > 1]
        fluents = {source.fluent for source in self._blocked}
        self.guard_mask = mask(fact for fact in self.facts if fact[0] in fluents)
        for facts in self._guards_on:
            self.guard_mask |= facts
        self._has_guards = [bool(o.guards) for o in self.operators]
        self._penalties: dict[int, dict[int, float]] = {}
        self._extras: dict[State, dict[int, float]] = {}

    def price(self, fact: Fact) -> float:
        """Return the price of a static fact, asked for once."""
        cached = self._prices.get(fact)
        if cached is None:
            cached = self._prices[fact] = self._ask(fact)
        return cached

    def mask(self, facts: Iterable[Fact]) -> State:
        """Return the bits of those facts that some condition mentions."""
        if isinstance(facts, frozenset):
            cached = self._masks.get(facts)
            if cached is not None:
                return cached
        mask, number = 0, self.number
        for fact in facts:
            i = number.get(fact)
            if i is not None:
                mask |= 1 << i
        if isinstance(facts, frozenset):
            self._masks[facts] = mask
        return mask

    def closure(self, state: State) -> State:
        """Return the state with its derived facts."""
        for stratum in self.strata:
            before = -1
            while before != state:
                before = state
                for negative, head in stratum.free:
                    if not negative & state:
                        state |= head
                mask, watched = state & stratum.mask, stratum.watched
                while mask:
                    low = mask & -mask
                    mask ^= low
                    for positive, negative, head in watched[low]:
                        if positive & state == positive and not negative & state:
                            state |= head
                if not stratum.recursive:
                    break
        return state

    def holds_goal(self, closed: State) -> bool:
        """Check that the goal holds in a state with its derived facts."""
        return closed & self.goal == self.goal and not closed & self.goal_absent

    def applicable(self, closed: State) -> list[int]:
        """Return the operators whose preconditions hold; guards are not looked at."""
        before, absent = self.before, self.absent
        found = [i for i in self.always if not absent[i] & closed]
        mask, watched = closed & self.watch_mask, self.watched
        while mask:
            low = mask & -mask
            mask ^= low
            for i in watched[low.bit_length() - 1]:
                need = before[i]
                if need & closed == need and not absent[i] & closed:
                    found.append(i)
        return found

    def penalties(self, facts: State) -> dict[int, float]:
        """Return for a guard's facts the operators that it costs something when it is triggered,
        and how much.
        """
        cached = self._penalties.get(facts)
        if cached is None:
            cached = self._penalties[facts] = dict[int, float]()
            for index, waived_by in self._owners(facts):
                price = math.inf if waived_by is None else self.price(waived_by)
                if price > 0.0:
                    cached[index] = cached.get(index, 0.0) + price
        return cached

    def _owners(self, facts: State) -> Iterator[tuple[int, Fact | None]]:
        """Find the operators that have the guard with these facts, and what waives it."""
        yield from self._guards_on.get(facts, ())
        if self._blocked and facts.bit_count() == 1:
            fact = self.facts[facts.bit_length() - 1]
            for source, owners in self._blocked.items():
                if source.fluent == fact[0]:
                    for row, guard in source.on(fact):
                        for index in owners.get(row, ()):
                            yield index, guard.waived_by

    def triggered(self, state: State) -> Iterator[int]:
        """Find the guards' facts that a state contains."""
        mask = state & self.guard_mask
        for facts in self._many:
            if facts & mask == facts:
                yield facts
        while mask:
            low = mask & -mask
            mask ^= low
            yield low

    def extras(self, state: State) -> dict[int, float]:
        """Return the operators with triggered guards that have a price, and these prices' sums."""
        key = state & self.guard_mask
        cached = self._extras.get(key)
        if cached is None:
            cached = dict[int, float]()
            for facts in self.triggered(key):
                for index, price in self.penalties(facts).items():
                    cached[index] = cached.get(index, 0.0) + price
            self._extras[key] = cached
        return cached

    def step_cost(self, index: int, state: State) -> float:
        """Return the operator's cost in the state, with the prices of its triggered guards;
        infinite where it is forbidden.
        """
        return (
            self.cost[index] + self.extras(state).get(index, 0.0)
            if self._has_guards[index]
            else self.cost[index]
        )

    def apply(self, index: int, state: State, closed: State) -> State:
        """Apply the operator (adding wins over deleting); return the state after it."""
        after = (state & self.kept[index]) | self.added[index]
        if self.conditional[index]:
            added = self.added[index]
            for positive, negative, adds, deletes in self.conditional[index]:
                if closed & positive == positive and not closed & negative:
                    after &= ~deletes
                    added |= adds
            after |= added
        return after

    @property
    def entries(self) -> int:
        """Return how many numbers describe the operators: what a state takes goes with it."""
        return len(self.facts) + sum(1 + len(o.positive) for o in self.operators)

    @property
    def lists_guards(self) -> bool:
        """Return whether all guards that cost something are at hand: none is made as it is met."""
        return not self._blocked

    def guard_sets(self) -> list[State]:
        """List the guards' facts in the order of `triggered`, where all guards are at hand."""
        single = sorted(facts for facts in self._guards_on if facts.bit_count() == 1)
        return [*self._many, *single]

    def _collect_guards(self) -> None:
        """Sort the guards by their facts. Those not made yet are made where a listed price matters,
        or later.
        """
        blocked: dict[DerivedGuards, dict[Row, list[int]]] = {}
        for index, operator in enumerate(self.operators):
            guards = operator.guards
            if isinstance(guards, LazyGuards):
                for source, row in guards.blocked:
                    blocked.setdefault(source, {}).setdefault(row, []).append(index)
                guards = guards.made
            for guard in guards:
                self._guarded.setdefault(guard.facts, []).append((index, guard.waived_by))
        if self._listed is None:
            self._blocked = blocked
            return
        priced = sorted(fact for fact, price in self._listed.items() if price > 0.0)
        facts = self.instantiated.reachable | self.instantiated.initial
        for source, owners in blocked.items():
            for row, guard in (*source.waived_by(priced), *source.unwaivable(facts)):
                for index in owners.get(row, ()):
                    self._guarded.setdefault(guard.facts, []).append((index, guard.waived_by))

    def _mentioned(self) -> set[Fact]:
        instantiated = self.instantiated
        mentioned = set(instantiated.goal.positive | instantiated.goal.negative).union(
            *self._guarded
        )
        fluents = {source.fluent for source in self._blocked}
        mentioned |= {
            fact for fact in instantiated.reachable | instantiated.initial if fact[0] in fluents
        }
        for operator in instantiated.operators:
            mentioned |= operator.positive
            mentioned |= operator.negative
            for effect in operator.conditional:
                mentioned |= effect.positive | effect.negative
        for axiom in instantiated.axioms:
            mentioned.add(axiom.head)
            mentioned |= axiom.positive | axiom.negative
        return mentioned

    def _watch(self) -> tuple[dict[int, list[int]], list[int]]:
        """Watch each operator under the one of its preconditions that the fewest operators
        share.
        """
        uses: dict[Fact, int] = {}
        for i in self.alive:
            for fact in self.operators[i].positive:
                uses[fact] = uses.get(fact, 0) + 1
        order = {fact: (count, fact) for fact, count in uses.items()}
        watched: dict[int, list[int]] = {}
        always: list[int] = []
        for i in self.alive:
            if self.operators[i].positive:
                rarest = min(self.operators[i].positive, key=order.__getitem__)
                watched.setdefault(self.number[rarest], []).append(i)
            else:
                always.append(i)
        return watched, always
