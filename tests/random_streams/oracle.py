"""By the book: all results of all streams, every state, every plan step. Shares no code with the planner."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from tests.random_streams.problems import Act, Atom, Formula, Params, Problem

Env = Mapping[str, str]
State = frozenset[Atom]

MOST_OBJECTS, MOST_FACTS = 26, 160
"""Objects and certified facts of a problem that is small."""


class Overflow(Exception):
    """More of it than a brute force can look at."""


class Model:
    """What holds: facts by predicate; and what there is, by type."""

    def __init__(self, facts: Iterable[Atom], universe: Mapping[str, Iterable[str]]) -> None:
        self.facts: dict[str, set[Atom]] = defaultdict(set)
        for fact in facts:
            self.facts[fact[0]].add(fact)
        self.universe = {kind: set(names) for kind, names in universe.items()}

    @property
    def all(self) -> set[Atom]:
        """All facts."""
        return {fact for facts in self.facts.values() for fact in facts}

    def has(self, fact: Atom) -> bool:
        """Whether a fact holds."""
        return fact in self.facts[fact[0]]


class World:
    """A problem with all that its streams can give, or with some of it.

    Args:
        problem: The problem.
        certified: The facts that streams gave, instead of all that they can give.
        extra: The objects besides the problem's, by type, that go with `certified`.
        shown: Of what streams that look at the state give, where there is all, the facts that the plan rests on.
    """

    def __init__(
        self,
        problem: Problem,
        certified: Iterable[Atom] | None = None,
        extra: Mapping[str, str] | None = None,
        shown: tuple[World, frozenset[Atom]] | None = None,
    ) -> None:
        self.problem, self._shown = problem, shown
        self.universe: dict[str, set[str]] = defaultdict(set)
        for name, kind in {**problem.objects, **(extra or {})}.items():
            self.universe[kind].add(name)
        self.initial: State = frozenset(fact for fact in problem.init if fact[0] in problem.fluents)
        given = problem.init - self.initial
        self._rows: dict[tuple[Any, ...], list[Atom]] = {}
        self.static = given | set(certified) if certified is not None else self._everything(given)
        self._models: dict[State, Model] = {}

    def _everything(self, facts: set[Atom]) -> set[Atom]:
        known = set(facts)
        while True:
            before = len(known)
            known |= self._given(Model(known, self.universe), None)
            if len(known) > MOST_FACTS or sum(map(len, self.universe.values())) > MOST_OBJECTS:
                raise Overflow
            if len(known) == before:
                return known

    def _given(self, model: Model, state: State | None) -> set[Atom]:
        """What streams give where `model` holds: those that look at the state, if there is one, or the others."""
        found: set[Atom] = set()
        for source in self.problem.sources:
            if bool(source.fluents) is (state is None):
                continue
            seen = frozenset(fact for fact in state or () if fact[0] in source.fluents)
            for env in list(self.solutions(source.inputs, ("and", *source.domain), {}, model)):
                inputs = tuple(env[name] for name, _ in source.inputs)
                key = (source.name, inputs, seen)
                if key not in self._rows:
                    self._rows[key] = self.problem.table(source, inputs, seen)
                for row in self._rows[key]:
                    for (_, kind), value in zip(source.outputs, row, strict=True):
                        if state is None:
                            self.universe[kind].add(value)
                        else:
                            model.universe.setdefault(kind, set()).add(value)
                    full = {
                        **env,
                        **dict(zip((name for name, _ in source.outputs), row, strict=True)),
                    }
                    found |= {_ground(atom, full) for atom in source.certified}
        return found

    def model(self, state: State) -> Model:
        """All that holds in a state."""
        if state not in self._models:
            model = Model((*self.static, *state), self.universe)
            if self._shown is not None:
                found = self._shown[0].model(state).all & self._shown[1]
            else:
                found = self._given(model, state)
            for fact in found:
                model.facts[fact[0]].add(fact)
            self._close(model)
            self._models[state] = model
        return self._models[state]

    def _close(self, model: Model) -> None:
        heads = list(dict.fromkeys(rule.head[0] for rule in self.problem.rules))
        for head in heads:
            rules = [rule for rule in self.problem.rules if rule.head[0] == head]
            size = -1
            while len(model.facts[head]) != size:
                size = len(model.facts[head])
                for rule in rules:
                    body = rule.body
                    params = rule.params
                    if body[0] == "exists":
                        params, body = (*params, *body[1]), body[2]
                    for env in list(self.solutions(params, body, {}, model)):
                        model.facts[head].add(_ground(rule.head, env))

    def holds(self, formula: Formula, env: Env, model: Model) -> bool:
        """Whether a condition holds."""
        head = formula[0]
        if head == "and":
            return all(self.holds(part, env, model) for part in formula[1:])
        if head == "or":
            return any(self.holds(part, env, model) for part in formula[1:])
        if head == "not":
            return not self.holds(formula[1], env, model)
        if head == "imply":
            return not self.holds(formula[1], env, model) or self.holds(formula[2], env, model)
        if head == "exists":
            return any(True for _ in self.solutions(formula[1], formula[2], env, model))
        if head == "forall":
            return not any(
                True for _ in self.solutions(formula[1], ("not", formula[2]), env, model)
            )
        if head == "=":
            return env.get(formula[1], formula[1]) == env.get(formula[2], formula[2])
        return model.has(_ground(formula, env))

    def solutions(self, params: Params, formula: Formula, env: Env, model: Model) -> Iterator[Env]:
        """The values of the parameters for which the condition holds; its positive atoms say where to look."""
        kinds = dict(params)
        inner = {name: value for name, value in env.items() if name not in kinds}
        parts = formula[1:] if formula[0] == "and" else (formula,)
        atoms = [
            part
            for part in parts
            if part[0] in self.problem.predicates and not kinds.keys().isdisjoint(part[1:])
        ]
        for full in self._join(atoms, kinds, inner, model):
            if self.holds(formula, full, model):
                yield full

    def _join(
        self, atoms: Sequence[Atom], kinds: Mapping[str, str], env: Env, model: Model
    ) -> Iterator[Env]:
        if atoms:
            atom = min(
                atoms,
                key=lambda one: (
                    sum(t in kinds and t not in env for t in one[1:]),
                    len(model.facts[one[0]]),
                ),
            )
            rest = [one for one in atoms if one is not atom]
            for fact in sorted(model.facts[atom[0]]):
                grown = dict(env)
                for term, value in zip(atom[1:], fact[1:], strict=True):
                    if term in kinds:
                        if grown.setdefault(
                            term, value
                        ) != value or value not in model.universe.get(kinds[term], ()):
                            break
                    elif env.get(term, term) != value:
                        break
                else:
                    yield from self._join(rest, kinds, grown, model)
            return
        free = [name for name in kinds if name not in env]
        if not free:
            yield env
            return
        for value in sorted(model.universe.get(kinds[free[0]], ())):
            yield from self._join((), kinds, {**env, free[0]: value}, model)

    def successors(self, state: State) -> Iterator[tuple[Act, tuple[str, ...], State]]:
        """Every action that can be taken, its arguments, and the state that it leads to."""
        model = self.model(state)
        for act in self.problem.acts:
            for env in list(self.solutions(act.params, act.condition, {}, model)):
                yield (
                    act,
                    tuple(env[name] for name, _ in act.params),
                    self.after(act, env, state, model),
                )

    def after(self, act: Act, env: Env, state: State, model: Model) -> State:
        """The state after an action; adding wins over deleting."""
        added: set[Atom] = set()
        deleted: set[Atom] = set()
        for effect in act.effects:
            for full in list(self.solutions(effect.params, effect.condition, env, model)):
                (added if effect.adds else deleted).add(_ground(effect.atom, full))
        return (state - deleted) | added

    def solvable(self, most: int) -> bool | None:
        """Whether a plan exists; None where more than `most` states do not tell."""
        seen = {self.initial}
        queue = deque(seen)
        while queue:
            state = queue.popleft()
            if self.holds(self.problem.goal, {}, self.model(state)):
                return True
            for _, _, after in self.successors(state):
                if after not in seen:
                    if len(seen) >= most:
                        return None
                    seen.add(after)
                    queue.append(after)
        return False

    def fault(self, plan: Iterable[tuple[str, tuple[str, ...], float]]) -> str | None:
        """What is wrong with a plan of names, values and costs; None where it holds."""
        acts = {act.name: act for act in self.problem.acts}
        state = self.initial
        for number, (name, values, cost) in enumerate(plan):
            act, model = acts[name], self.model(state)
            for (_, kind), value in zip(act.params, values, strict=True):
                if value not in model.universe.get(kind, ()):
                    return f"{number} {name} {values}: {value} is no {kind}"
            env = dict(zip((param for param, _ in act.params), values, strict=True))
            if not self.holds(act.condition, env, model):
                return f"{number} {name} {values}: the precondition does not hold"
            due = (
                self.problem.price(act.cost[0], env[act.cost[1]])
                if isinstance(act.cost, tuple)
                else act.cost
            )
            if cost != due:
                return f"{number} {name} {values} costs {due}, not {cost}"
            state = self.after(act, env, state, model)
        return (
            None
            if self.holds(self.problem.goal, {}, self.model(state))
            else "the goal does not hold"
        )


def _ground(atom: Sequence[str], env: Env) -> Atom:
    return (atom[0], *(env.get(term, term) for term in atom[1:]))
