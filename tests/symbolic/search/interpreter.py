"""An independent, slow interpreter of lifted PDDL: enumerates everything, shares no code with tamp.symbolic.search."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Iterable, Iterator, Mapping

from tamp.symbolic.pddl.structs import (
    Action,
    And,
    Atom,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    Parameter,
    Task,
)

State = frozenset[Fact]


class Interpreter:
    """Executes a task's actions by the book.

    Args:
        task: The task.
        facts: Static facts besides the initial ones.
        objects: Objects besides the task's.
        on_demand: Work out a derived fact when it is asked for (no recursive rules), instead of all of them first.
    """

    def __init__(
        self,
        task: Task,
        facts: Iterable[Fact] = (),
        objects: Mapping[str, tuple[str, ...]] | None = None,
        *,
        on_demand: bool = False,
    ) -> None:
        self.task = task
        self.objects = {**task.domain.constants, **task.objects, **(objects or {})}
        self.initial = task.initial | frozenset(facts)
        self.on_demand = on_demand

    def fitting(self, parameter: Parameter) -> list[str]:
        """The objects of a parameter's types."""
        is_a = self.task.domain.is_a
        return [
            o
            for o, types in self.objects.items()
            if any(is_a(t, w) for t in types for w in parameter.types)
        ]

    def bindings(self, parameters: Iterable[Parameter]) -> Iterator[dict[str, str]]:
        """All objects for some parameters."""
        parameters = list(parameters)
        for objects in itertools.product(*map(self.fitting, parameters)):
            yield dict(zip((p.name for p in parameters), objects, strict=True))

    def holds(self, formula: Formula, state: State, names: Mapping[str, str]) -> bool:
        """`state` with its derived facts."""
        if isinstance(formula, Atom):
            terms = tuple(names.get(t, t) for t in formula.terms)
            if formula.predicate == "=":
                return terms[0] == terms[1]
            return (formula.predicate, *terms) in state or (
                self.on_demand and self.derived(formula.predicate, terms, state)
            )
        if isinstance(formula, Not):
            return not self.holds(formula.body, state, names)
        if isinstance(formula, And):
            return all(self.holds(part, state, names) for part in formula.parts)
        if isinstance(formula, Or):
            return any(self.holds(part, state, names) for part in formula.parts)
        results = (
            self.holds(formula.body, state, {**names, **b})
            for b in self.bindings(formula.parameters)
        )
        return any(results) if isinstance(formula, Exists) else all(results)

    def derived(self, predicate: str, terms: tuple[str, ...], state: State) -> bool:
        """Whether some rule gives the fact."""
        for rule in self.task.domain.derived:
            if rule.head.predicate == predicate:
                names = dict(zip(rule.head.terms, terms, strict=True))
                if self.holds(rule.body, state, names):
                    return True
        return False

    def closed(self, state: State) -> State:
        """The state with its derived facts; the tests' rules are listed stratum by stratum."""
        if self.on_demand:
            return state
        holds = set(state)
        rules = list(self.task.domain.derived)
        strata = list(dict.fromkeys(rule.head.predicate for rule in rules))
        for predicate in strata:
            changed = True
            while changed:
                changed = False
                for rule in rules:
                    if rule.head.predicate != predicate:
                        continue
                    for names in self.bindings(rule.parameters):
                        head = (predicate, *(names.get(t, t) for t in rule.head.terms))
                        if head not in holds and self.holds(rule.body, frozenset(holds), names):
                            holds.add(head)
                            changed = True
        return frozenset(holds)

    def apply(
        self, action: Action, names: Mapping[str, str], state: State, closed: State
    ) -> State | None:
        if not self.holds(action.precondition, closed, names):
            return None
        added: set[Fact] = set()
        deleted: set[Fact] = set()
        for effect in action.effects:
            for more in self.bindings(effect.parameters):
                every = {**names, **more}
                if self.holds(effect.condition, closed, every):
                    fact = (effect.atom.predicate, *(every.get(t, t) for t in effect.atom.terms))
                    (added if effect.adds else deleted).add(fact)
        return (state - deleted) | added

    def cost(self, action: Action, names: Mapping[str, str]) -> float:
        if isinstance(action.cost, Atom):
            return self.task.costs[
                (action.cost.predicate, *(names.get(t, t) for t in action.cost.terms))
            ]
        return action.cost

    def run(self, steps: Iterable[tuple[str, tuple[str, ...]]]) -> float:
        """Execute a plan; its cost. Fails on any violation."""
        state, total = self.initial, 0.0
        actions = {action.name: action for action in self.task.domain.actions}
        for name, arguments in steps:
            action = actions[name]
            names = dict(zip((p.name for p in action.parameters), arguments, strict=True))
            fits = [arguments[i] in self.fitting(p) for i, p in enumerate(action.parameters)]
            assert all(fits), f"{name} {arguments}: wrong types"
            after = self.apply(action, names, state, self.closed(state))
            assert after is not None, f"{name} {arguments} is not applicable"
            state, total = after, total + self.cost(action, names)
        assert self.holds(self.task.goal, self.closed(state), {}), "the goal does not hold"
        return total

    def best(self, limit: int = 2000) -> float | None:
        """The cost of an optimal plan by uniform-cost search, None when there is none.

        Raises:
            OverflowError: More than `limit` states.
        """
        costs = {self.initial: 0.0}
        order = itertools.count()
        queue = [(0.0, next(order), self.initial)]
        done: set[State] = set()
        while queue:
            cost, _, state = heapq.heappop(queue)
            if state in done:
                continue
            done.add(state)
            if len(done) > limit:
                raise OverflowError
            closed = self.closed(state)
            if self.holds(self.task.goal, closed, {}):
                return cost
            for action in self.task.domain.actions:
                for names in self.bindings(action.parameters):
                    after = self.apply(action, names, state, closed)
                    if after is not None:
                        reached = cost + self.cost(action, names)
                        if reached < costs.get(after, float("inf")):
                            costs[after] = reached
                            heapq.heappush(queue, (reached, next(order), after))
        return None
