"""From an optimistic plan to the stream calls that it needs, its placeholders told apart by use."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence

from tamp.symbolic.algorithms.binding.call_order import ordered
from tamp.symbolic.algorithms.binding.skeleton import CallNode, LiftedFact, Skeleton, Step, Term
from tamp.symbolic.algorithms.optimistic.optimistic_facts import (
    PLACEHOLDER_MARK,
    OptimisticInstance,
)
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import ANY_OBJECT
from tamp.symbolic.search.plan_trace import FinalState


def build_skeleton(
    steps: Sequence[Step],
    end: FinalState,
    certifier: Callable[[Fact], OptimisticInstance | None],
    certified_fact_of: Callable[[str], Fact | None],
    given: Iterable[Fact] = (),
    chosen: Mapping[tuple[int, Fact], OptimisticInstance] | None = None,
) -> Skeleton:
    """Collect the stream calls of an optimistic plan.

    A placeholder that two parts of the plan use without handing it over in a fluent fact becomes
    two variables: the grasp of a second pick need not be the grasp of the first.

    Args:
        steps: The plan.
        end: The final state, and what the goal rests on in it.
        certifier: Who certifies an optimistic fact; None for known ones.
        certified_fact_of: What the call that gives a placeholder, or a value, certifies of it;
            None for the task's own objects.
        given: Facts that no action changes: they are shown to the streams that ask for them.
        chosen: For a step's number and a fact that it rests on who certifies that there, where
            several may.
    """
    builder = SkeletonBuilder(certifier, certified_fact_of, given, chosen or {})
    for number, step in enumerate(steps):
        builder.add_action(number, step)
    builder.add_goal(len(steps), end)
    return builder.skeleton(tuple(steps))


class SkeletonBuilder:
    """Walks through the plan and keeps for each fluent fact which variables stand in it."""

    def __init__(
        self,
        certifier: Callable[[Fact], OptimisticInstance | None],
        certified_fact_of: Callable[[str], Fact | None],
        given: Iterable[Fact],
        chosen: Mapping[tuple[int, Fact], OptimisticInstance],
    ) -> None:
        self._chosen = chosen
        self._certifier, self._certified_fact_of, self._given = (
            certifier,
            certified_fact_of,
            frozenset(given),
        )
        self._parent: list[int] = []
        self._producer: dict[int, CallNode] = {}
        self._nodes: list[CallNode] = []
        self._kept: dict[int, CallNode] = {}
        self._state: dict[Fact, tuple[Term, ...]] = {}
        self._actions: list[tuple[str, tuple[Term, ...]]] = []
        self._certified: list[LiftedFact] = []
        self._shown: dict[int, dict[Fact, tuple[Term, ...]]] = {}

    # Variables, merged as they turn out to be the same (congruence closure over the calls that
    # produce them).

    def _find(self, variable: int) -> int:
        while self._parent[variable] != variable:
            self._parent[variable] = self._parent[self._parent[variable]]
            variable = self._parent[variable]
        return variable

    def _union(self, a: Term, b: Term) -> None:
        if isinstance(a, str) or isinstance(b, str):
            return
        a, b = sorted((self._find(a), self._find(b)))
        if a == b:
            return
        self._parent[b] = a

        first, second = self._producer.get(a), self._producer.pop(b, None)
        if second is None:
            return
        if first is None:
            self._producer[a] = second
            return
        if first is second:
            return

        keep, drop = sorted((first, second), key=lambda node: node.step)
        self._nodes.remove(drop)
        self._kept[id(drop)] = keep
        for variable, node in list(self._producer.items()):
            if node is drop:
                self._producer[variable] = keep
        for x, y in zip((*keep.inputs, *keep.outputs), (*drop.inputs, *drop.outputs), strict=True):
            self._union(x, y)

    def _last(self, node: CallNode) -> CallNode:
        """Return the node that a node was merged into."""
        while id(node) in self._kept:
            node = self._kept[id(node)]
        return node

    def _resolve(self, term: Term) -> Term:
        return term if isinstance(term, str) else self._find(term)

    def _lift(self, names: Sequence[str], local: Mapping[str, Term]) -> tuple[Term, ...]:
        return tuple(
            local.get(name, name) if name.startswith(PLACEHOLDER_MARK) else name for name in names
        )

    # The walk.

    def add_action(self, number: int, step: Step) -> None:
        """Take one action: bind its arguments through what it reads, require what it rests on."""
        for fact in step.state:
            self._state.setdefault(fact, fact[1:])
        self._shown[number] = {fact: self._state[fact] for fact in step.state}
        local = self._read(step.read | step.deleted, step.state, step.derived)
        for fact in sorted(step.static):
            self._require_static(fact, local, number)

        for argument in step.arguments:
            # no condition says what it is: any value of the stream that gives it will do
            if argument.startswith(PLACEHOLDER_MARK):
                self._require_any(argument, local, number)

        for usage in step.usages:
            around = dict(local)
            for fact in sorted(usage.present):
                self._bind_fluent(fact, around)
            self._require_static(usage.fact, around, number)
            self._certify((usage.fact,), around)

        self._actions.append((step.name, self._lift(step.arguments, local)))
        self._certify(step.static, local)
        for fact in step.added:
            self._state[fact] = self._lift(fact[1:], local)

    def add_goal(self, number: int, end: FinalState) -> None:
        """Require what the goal rests on in the final state."""
        self._shown[number] = {fact: self._state.get(fact, fact[1:]) for fact in end.state}
        local = self._read(end.read, end.state, end.derived)
        for fact in sorted(end.static):
            self._require_static(fact, local, number)
        self._certify(end.static, local)

    def skeleton(self, steps: tuple[Step, ...]) -> Skeleton:
        """Build the skeleton, every term resolved."""
        for node in self._nodes:
            node.inputs = tuple(self._resolve(term) for term in node.inputs)
            node.outputs = tuple(self._find(variable) for variable in node.outputs)
            shown = node.stream.declaration.fluents
            if shown:
                state = self._shown[node.step]
                node.fluents = tuple(
                    ((fact[0], tuple(self._resolve(term) for term in state[fact])), fact)
                    for fact in sorted(state)
                    if fact[0] in shown
                )
                node.given = frozenset(fact for fact in self._given if fact[0] in shown)
            node.needs = [self._last(needed) for needed in node.needs]

        actions = tuple(
            (name, tuple(self._resolve(term) for term in terms)) for name, terms in self._actions
        )
        certified = dict.fromkeys(
            (p, tuple(self._resolve(t) for t in terms)) for p, terms in self._certified
        )
        return Skeleton(steps, actions, ordered(self._nodes), tuple(certified))

    def _read(
        self, read: Iterable[Fact], state: Iterable[Fact], derived: Iterable[Fact]
    ) -> dict[str, Term]:
        """Return the terms of the placeholders that are read in a state.

        Besides those in the facts read, derivations may rest on a test for something that the state
        has: nothing stands there, *or* it is clear of it.
        """
        local: dict[str, Term] = {}
        for fact in sorted(read):
            self._bind_fluent(fact, local)

        open_ = {
            name
            for fact in derived
            for name in fact[1:]
            if name.startswith(PLACEHOLDER_MARK) and name not in local
        }
        if open_:
            for fact in sorted(state):
                if not open_.isdisjoint(fact[1:]):
                    self._bind_fluent(fact, local)
        return local

    def _bind_fluent(self, fact: Fact, local: dict[str, Term]) -> None:
        for name, term in zip(fact[1:], self._state.get(fact, fact[1:]), strict=True):
            if name.startswith(PLACEHOLDER_MARK):
                if name in local:
                    self._union(local[name], term)
                else:
                    local[name] = term

    def _certify(self, facts: Iterable[Fact], local: Mapping[str, Term]) -> None:
        for fact in sorted(facts):
            if fact[0] != ANY_OBJECT:
                self._certified.append((fact[0], self._lift(fact[1:], local)))

    def _require_any(self, name: str, local: dict[str, Term], number: int) -> None:
        """Require a value that nothing is said of."""
        promised = None if name in local else self._certified_fact_of(name)
        if promised is not None:
            self._require_static(promised, local, number)
            self._certify((promised,), local)

    def _require_static(self, fact: Fact, local: dict[str, Term], number: int) -> CallNode | None:
        """Have a fact certified; by which call, if it takes one."""
        if fact[0] == ANY_OBJECT:
            self._require_any(fact[1], local, number)
            return None
        guess = self._chosen.get((number, fact)) or self._certifier(fact)
        if guess is None:
            return None

        node = None
        for name in guess.outputs:
            if name in local:
                candidate = self._producer.get(self._find(_variable(local[name])))
                if candidate is not None:
                    node = candidate

        if node is None:
            needs = [self._require_static(needed, local, number) for needed in guess.domain]
            inputs = self._lift(guess.inputs, local)
            outputs = tuple(
                _variable(local.setdefault(name, self._new())) for name in guess.outputs
            )
            node = CallNode(
                guess.stream, (guess.inputs, guess.outputs), inputs, outputs, number, fact
            )
            node.needs = [one for one in needs if one is not None]
            self._nodes.append(node)  # the same test may be asked for again; `ordered` keeps one
            for variable in outputs:
                self._producer[self._find(variable)] = node
            for certified in guess.certified:
                self._certified.append((certified[0], self._lift(certified[1:], local)))

        symbols = (*guess.inputs, *guess.outputs)
        for name, term in zip(symbols, (*node.inputs, *node.outputs), strict=True):
            if name.startswith(PLACEHOLDER_MARK):
                if name in local:
                    self._union(local[name], term)
                else:
                    local[name] = term
        return node

    def _new(self) -> int:
        self._parent.append(len(self._parent))
        return len(self._parent) - 1


def _variable(term: Term) -> int:
    if isinstance(term, str):
        raise TypeError(f"{term} is not a variable")
    return term
