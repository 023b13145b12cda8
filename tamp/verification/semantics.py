"""PDDL's semantics: lifted formulas are asked of a set of facts. Shares nothing with the search."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from tamp.symbolic.pddl.structs import (
    Action,
    And,
    Atom,
    Derived,
    Domain,
    Exists,
    Fact,
    Formula,
    Not,
    Or,
    Parameter,
)
from tamp.verification.formulas import (
    Binding,
    flat,
    free,
    predicates,
    substitute,
    substituted,
    unify,
)

Types = Mapping[str, tuple[str, ...]]


@dataclass(eq=False)
class State:
    """Facts by predicate; derived ones are not stored but asked for, and remembered once asked."""

    facts: dict[str, set[tuple[str, ...]]]
    decided: dict[Fact, bool] = field(default_factory=dict)
    closed: dict[str, set[tuple[str, ...]]] = field(default_factory=dict)

    @classmethod
    def of(cls, facts: Iterable[Fact]) -> State:
        """Make a state of these facts."""
        by_predicate: dict[str, set[tuple[str, ...]]] = {}
        for predicate, *terms in facts:
            by_predicate.setdefault(predicate, set()).add(tuple(terms))
        return cls(by_predicate)

    def all(self, predicate: str) -> list[tuple[str, ...]]:
        """List the stored facts of a predicate, sorted."""
        return sorted(self.facts.get(predicate, ()))

    def __contains__(self, fact: Fact) -> bool:
        return fact[1:] in self.facts.get(fact[0], ())


class Semantics:
    """A domain over objects.

    Args:
        domain: Parsed.
        objects: Name -> types; an object has all of them.
    """

    def __init__(self, domain: Domain, objects: Types) -> None:
        self.domain = domain
        self.objects = objects
        self.actions = {action.name: action for action in domain.actions}
        self._rules: dict[str, list[Derived]] = {}
        for rule in domain.derived:
            self._rules.setdefault(rule.head.predicate, []).append(rule)
        self._recursive = {name for name in self._rules if name in self._reached(name)}

    def without(self, predicates: Collection[str]) -> Semantics:
        """Return the same domain, in which facts alone, no rules, decide about some predicates."""
        rules = tuple(rule for rule in self.domain.derived if rule.head.predicate not in predicates)
        return Semantics(replace(self.domain, derived=rules), self.objects)

    def fits(self, name: str, types: Sequence[str]) -> bool:
        """Tell whether an object has one of the types."""
        own = self.objects.get(name, ())
        return "object" in types or any(
            self.domain.is_a(one, other) for one in own for other in types
        )

    def holds(
        self, formula: Formula, state: State, binding: Mapping[str, str] | None = None
    ) -> bool:
        """Tell whether a formula is true; its free variables are bound."""
        return any(True for _ in self._solutions([formula], state, dict(binding or {}), {}))

    def unmet(self, action: Action, arguments: Sequence[str], state: State) -> list[Formula]:
        """List the parts of an action's precondition that do not hold, arguments substituted."""
        binding = dict(zip((p.name for p in action.parameters), arguments, strict=True))
        parts = flat(action.precondition)
        return [substitute(part, binding) for part in parts if not self.holds(part, state, binding)]

    def apply(self, action: Action, arguments: Sequence[str], state: State) -> State:
        """Apply an action: conditions are asked of the state before; adding wins over deleting."""
        binding = dict(zip((p.name for p in action.parameters), arguments, strict=True))
        added: set[Fact] = set()
        deleted: set[Fact] = set()
        for effect in action.effects:
            types = {parameter.name: parameter.types for parameter in effect.parameters}
            start = {name: value for name, value in binding.items() if name not in types}
            for found in self._solutions([effect.condition], state, start, types):
                for full in self._every(types, found):
                    (added if effect.adds else deleted).add(substituted(effect.atom, full))
        after = dict(state.facts)
        gone, come = State.of(deleted).facts, State.of(added).facts
        for name in gone.keys() | come.keys():
            after[name] = (after.get(name, set()) - gone.get(name, set())) | come.get(name, set())
        return State({name: rows for name, rows in after.items() if rows})

    # Solutions of a conjunction, by the atom that binds most

    def _solutions(
        self, parts: list[Formula], state: State, binding: Binding, types: Types
    ) -> Iterator[Binding]:
        """Yield extensions of `binding` that make all parts true; `types` are of open variables."""
        open_parts: list[Formula] = []
        waiting = parts[::-1]
        while waiting:  # and no call for each: a goal may have thousands of parts
            part = waiting.pop()
            if isinstance(part, And):
                waiting += part.parts[::-1]
            elif not free(part) <= binding.keys():
                open_parts.append(part)
            elif not self._true(part, state, binding):
                return

        if not open_parts:
            yield binding
            return

        at = min(range(len(open_parts)), key=lambda i: self._burden(open_parts[i]))
        part, others = open_parts[at], [*open_parts[:at], *open_parts[at + 1 :]]
        if isinstance(part, Atom) and self._burden(part) < 3:
            for found in self._matches(part, state, binding):
                if all(
                    self.fits(found[name], types.get(name, ("object",)))
                    for name in found.keys() - binding.keys()
                ):
                    yield from self._solutions(others, state, found, types)
        else:
            name = min(free(part) - binding.keys())
            for value in self._of_type(types.get(name, ("object",))):
                yield from self._solutions(open_parts, state, {**binding, name: value}, types)

    def _burden(self, part: Formula) -> int:
        """Rank a part with free variables: 1 is a lookup, 2 asks rules, 3 enumerates a variable."""
        if isinstance(part, Atom) and part.predicate != "=" and not self._is_type(part.predicate):
            return 2 if part.predicate in self._rules else 1
        return 3

    def _true(self, part: Formula, state: State, binding: Binding) -> bool:
        if isinstance(part, Atom):
            return self._true_fact(substituted(part, binding), state)
        if isinstance(part, Not):
            return not self.holds(part.body, state, binding)
        if isinstance(part, Or):
            return any(self.holds(one, state, binding) for one in part.parts)
        if isinstance(part, And):
            return all(self.holds(one, state, binding) for one in part.parts)
        if isinstance(part, Exists):
            return self._exists(part.parameters, part.body, state, binding)
        return not self._exists(part.parameters, Not(part.body), state, binding)

    def _exists(
        self, parameters: Sequence[Parameter], body: Formula, state: State, binding: Binding
    ) -> bool:
        types = {parameter.name: parameter.types for parameter in parameters}
        outer = {name: value for name, value in binding.items() if name not in types}
        for found in self._solutions([body], state, outer, types):
            # A variable that the body does not mention still needs an object.
            if any(True for _ in self._every(types, found)):
                return True
        return False

    def _true_fact(self, fact: Fact, state: State) -> bool:
        predicate, *terms = fact
        if predicate == "=":
            return terms[0] == terms[1]
        if predicate not in self._rules:
            return fact in state or (self._is_type(predicate) and self.fits(terms[0], (predicate,)))
        if predicate in self._recursive:
            return tuple(terms) in self._closure(predicate, state)
        if fact not in state.decided:
            state.decided[fact] = fact in state or any(
                True for rule in self._rules[predicate] for _ in self._answers(rule, terms, state)
            )
        return state.decided[fact]

    def _is_type(self, predicate: str) -> bool:
        return predicate not in self.domain.predicates and predicate in self.domain.types

    def _matches(self, atom: Atom, state: State, binding: Binding) -> Iterator[Binding]:
        """Yield bindings under which an atom with free variables is true."""
        if atom.predicate not in self._rules:
            rows: Collection[tuple[str, ...]] = state.all(atom.predicate)
        elif atom.predicate in self._recursive:
            rows = sorted(self._closure(atom.predicate, state))
        else:
            pattern = [binding.get(term, term) for term in atom.terms]
            found = {
                row
                for rule in self._rules[atom.predicate]
                for row in self._answers(rule, pattern, state)
            }
            rows = sorted(found | set(state.all(atom.predicate)))
        for row in rows:
            extended = unify(atom.terms, row, binding)
            if extended is not None:
                yield extended

    def _answers(
        self, rule: Derived, terms: Sequence[str], state: State
    ) -> Iterator[tuple[str, ...]]:
        """Yield the rule's heads that are true and fit `terms`, in which variables are open."""
        types = {parameter.name: parameter.types for parameter in rule.parameters}
        binding: Binding = {}
        for inner, outer in zip(rule.head.terms, terms, strict=True):
            if outer.startswith("?"):
                continue
            if not inner.startswith("?"):
                if inner != outer:
                    return
            elif binding.setdefault(inner, outer) != outer or not self.fits(
                outer, types.get(inner, ("object",))
            ):
                return
        for found in self._solutions([rule.body], state, binding, types):
            for full in self._every(
                {name: kind for name, kind in types.items() if name in rule.head.terms}, found
            ):
                yield tuple(full.get(term, term) for term in rule.head.terms)

    def _closure(self, predicate: str, state: State) -> set[tuple[str, ...]]:
        """Compute a recursive predicate's fixpoint: facts that rest on each other grow together."""
        if predicate not in state.closed:
            below = self._reached(predicate)
            group = [
                name for name in self._rules if name in below and predicate in self._reached(name)
            ]
            for name in group:
                state.closed[name] = set(state.all(name))
            grows = True
            while grows:
                grows = False
                for name in group:
                    for rule in self._rules[name]:
                        new = set(self._answers(rule, rule.head.terms, state)) - state.closed[name]
                        state.closed[name] |= new
                        grows = grows or bool(new)
                        # What rests on the group was answered from less than all.
                        state.decided.clear()
        return state.closed[predicate]

    def _every(self, types: Types, binding: Binding) -> Iterator[Binding]:
        open_ = [name for name in types if name not in binding]
        if not open_:
            yield binding
            return
        for value in self._of_type(types[open_[0]]):
            yield from self._every(types, {**binding, open_[0]: value})

    def _of_type(self, types: Sequence[str]) -> list[str]:
        return [name for name in self.objects if self.fits(name, types)]

    def _reached(self, predicate: str) -> set[str]:
        """Return the derived predicates that a derived predicate's rules lead to."""
        reached: set[str] = set()
        front = [predicate]
        while front:
            for rule in self._rules.get(front.pop(), ()):
                new = {name for name in predicates(rule.body) if name in self._rules} - reached
                reached |= new
                front += new
        return reached
