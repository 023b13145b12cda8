"""Guards that are made only when they are asked for.

A task has as many guards as operators times poses of other bodies (24,000 for 8 bodies, 164,000 for
20), but a search meets few of them: those of the poses that bodies take, or those that a price
makes matter.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import overload

from tamp.symbolic.pddl.structs import Atom, Fact
from tamp.symbolic.search.instantiation.datalog import Row, RuleBody, filler, join
from tamp.symbolic.search.instantiation.normal_form import Definition
from tamp.symbolic.search.instantiation.predicate_kinds import PredicateKinds
from tamp.symbolic.search.operators import Facts, Guard


class DerivedGuards:
    """The guards that `not d(...)` amounts to, by a rule of d with one fluent and one absent
    assumed atom in its body.

    For `blocked(o, p) <- at-pose(o2, p2), o != o2, not clear(o, p, o2, p2)`: each at-pose(o2, p2)
    is a guard of `not blocked(o, p)`, waived by clear(o, p, o2, p2) unless that fact is refused.
    """

    def __init__(self, predicates: PredicateKinds, definition: Definition) -> None:
        self._predicates = predicates
        self._head = definition.head
        self._names = definition.literals.names
        kinds = predicates.classify(definition.literals)
        (self._fluent,) = kinds.positive
        (self._absent,) = kinds.absent
        columns = {name: i for i, name in enumerate(self._names)}
        self._fill_head = filler(self._head.terms, columns)
        self._fill_fluent = filler((self._fluent.predicate, *self._fluent.terms), columns)
        self._fill_absent = filler((self._absent.predicate, *self._absent.terms), columns)
        self._rows = Atom(f"rows of {definition.head.predicate}", self._head.terms)
        self._body = predicates.body(definition.literals, absent=False)
        self._made: dict[Row, tuple[Guard, ...]] = {}
        self._on: dict[Fact, list[tuple[Row, Guard]]] = {}

    @staticmethod
    def fits(predicates: PredicateKinds, definition: Definition) -> bool:
        """Check that a rule has the form that this class is about."""
        kinds = predicates.classify(definition.literals)
        terms = definition.head.terms
        return (
            len(kinds.positive) == 1
            and len(kinds.absent) == 1
            and kinds.absent[0].predicate in predicates.assumed
            and not (kinds.negative or kinds.derived or kinds.refuted)
            and all(term.startswith("?") for term in terms)
            and len(set(terms)) == len(terms)
        )

    @property
    def fluent(self) -> str:
        """Return the predicate of the facts that trigger its guards."""
        return self._fluent.predicate

    def add(self, rows: Iterable[Row]) -> None:
        """Register arguments of the derived predicate whose guards will be asked for."""
        self._predicates.relations.add(self._rows.predicate, rows)
        self._on.clear()

    def of(self, row: Row) -> tuple[Guard, ...]:
        """Return all guards of one negated fact."""
        made = self._made.get(row)
        if made is None:
            made = self._made[row] = tuple(
                guard for _, guard in self._find(self._head.terms, [row])
            )
        return made

    def triggered(self, row: Row, state: Facts) -> list[Guard]:
        """Return the guards of one negated fact that a state triggers, in the facts' order."""
        names = tuple(dict.fromkeys(term for term in self._fluent.terms if term.startswith("?")))
        if row in self._made or set(names) & set(self._head.terms):
            return [guard for guard in self.of(row) if guard.facts <= state]
        facts = sorted(fact for fact in state if fact[0] == self._fluent.predicate)
        rows = [(*row, *values) for values in self._values(self._fluent, names, facts)]
        return [guard for _, guard in self._find((*self._head.terms, *names), rows)]

    def on(self, fact: Fact) -> list[tuple[Row, Guard]]:
        """Return the guards, with their rows, that a fluent fact triggers."""
        found = self._on.get(fact)
        if found is None:
            found = self._on[fact] = list(self._match(self._fluent, [fact]))
        return found

    def waived_by(self, facts: Iterable[Fact]) -> Iterator[tuple[Row, Guard]]:
        """Find the guards, with their rows, that one of the static facts waives, or would waive
        were it not refused.
        """
        return self._match(
            self._absent, [fact for fact in facts if fact[0] == self._absent.predicate]
        )

    def unwaivable(self, facts: Iterable[Fact]) -> Iterator[tuple[Row, Guard]]:
        """Find the guards, with their rows, that nothing waives: what would is refused, or is never
        asked for want of facts that it needs (see `Assumed`).

        Args:
            facts: The fluent facts that may come about.
        """
        yield from self.waived_by(sorted(self._predicates.refused))
        needs = [
            (predicate, tuple(self._absent.terms[place] for place in places))
            for predicate, places in self._predicates.assumed[self._absent.predicate]
        ]
        by_row = [need for need in needs if set(need[1]) <= set(self._head.terms)]
        by_fact = [need for need in needs if set(need[1]) <= set(self._fluent.terms)]
        is_by_both = len({*by_row, *by_fact}) < len({*needs})

        for row in sorted(self._predicates.relations.rows(self._rows.predicate)):
            if is_by_both or self._lacks(by_row, self._head, row):
                yield from ((row, guard) for guard in self.of(row) if guard.waived_by is None)
        if by_fact and not is_by_both:
            for fact in sorted(fact for fact in facts if fact[0] == self.fluent):
                if self._lacks(by_fact, self._fluent, fact[1:]):
                    yield from self.on(fact)

    def _lacks(self, needs: list[tuple[str, Row]], atom: Atom, terms: Row) -> bool:
        """Check whether one of the needed facts, over the terms of an atom, is not known."""
        binding = dict(zip(atom.terms, terms, strict=True))
        rows = self._predicates.relations.rows
        return any(
            tuple(binding[term] for term in needed) not in rows(predicate)
            for predicate, needed in needs
        )

    def _match(self, atom: Atom, facts: list[Fact]) -> Iterator[tuple[Row, Guard]]:
        """Find the guards of registered rows for which the atom is one of the facts."""
        names = tuple(dict.fromkeys(term for term in atom.terms if term.startswith("?")))
        return self._find(names, self._values(atom, names, facts), self._rows)

    @staticmethod
    def _values(atom: Atom, names: tuple[str, ...], facts: list[Fact]) -> list[Row]:
        """Return the values of the atom's variables in those facts that match it."""
        first = {term: 1 + atom.terms.index(term) for term in atom.terms}
        return [
            tuple(fact[first[name]] for name in names)
            for fact in facts
            if all(
                f == (fact[first[t]] if t.startswith("?") else t)
                for f, t in zip(fact[1:], atom.terms, strict=True)
            )
        ]

    def _find(
        self, variables: tuple[str, ...], rows: list[Row], *more: Atom
    ) -> Iterator[tuple[Row, Guard]]:
        predicates = self._predicates
        body = RuleBody((*self._body.positive, *more), (), self._body.equalities)
        for row in join(predicates.relations, body, variables, rows, self._names):
            waiver = self._fill_absent(row)
            if waiver not in predicates.certain:
                waived_by = waiver if predicates.may_hold(waiver) else None
                yield self._fill_head(row), Guard(frozenset((self._fill_fluent(row),)), waived_by)


class LazyGuards(Sequence[Guard]):
    """An operator's guards, evaluated lazily: some at hand, the others made on access.

    Attributes:
        made: Those at hand.
        blocked: Where the others come from, and which they are.
    """

    def __init__(
        self, made: tuple[Guard, ...], blocked: tuple[tuple[DerivedGuards, Row], ...]
    ) -> None:
        self.made = made
        self.blocked = blocked

    def triggered(self, state: Facts) -> tuple[Guard, ...]:
        """Return the guards whose facts a state contains; only these are made."""
        made = [guard for guard in self.made if guard.facts <= state]
        return (
            *made,
            *(guard for source, row in self.blocked for guard in source.triggered(row, state)),
        )

    def _all(self) -> tuple[Guard, ...]:
        return (*self.made, *(guard for source, row in self.blocked for guard in source.of(row)))

    @overload
    def __getitem__(self, index: int) -> Guard: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Guard]: ...
    def __getitem__(self, index: int | slice) -> Guard | Sequence[Guard]:
        return self._all()[index]

    def __iter__(self) -> Iterator[Guard]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def __bool__(self) -> bool:
        return bool(self.made or self.blocked)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, LazyGuards) and self._all() == other._all()

    def __hash__(self) -> int:
        return hash(self._all())
