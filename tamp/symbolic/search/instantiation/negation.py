"""Negated derived facts: the clauses that must hold for one not to hold, worked out as literals,
guards or choices.

`not d(args)` says that the body of each instantiated rule of d(args) is broken: a clause. A clause
of one literal is that literal; one that says that some of several fluents must be absent is a
guard; anything else becomes an auxiliary derived fact (a *choice*) with one axiom a literal.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.instantiation.datalog import Row, filler, join
from tamp.symbolic.search.instantiation.lazy_guards import DerivedGuards
from tamp.symbolic.search.instantiation.normal_form import Definition
from tamp.symbolic.search.instantiation.predicate_kinds import PredicateKinds
from tamp.symbolic.search.operators import Axiom, Guard, Meaning

Literal = tuple[bool, Fact]


@dataclass(slots=True)
class Needs:
    """A conjunction without variables under construction."""

    positive: list[Fact] = field(default_factory=list[Fact])
    negative: list[Fact] = field(default_factory=list[Fact])
    guards: list[Guard] = field(default_factory=list[Guard])
    blocked: list[tuple[DerivedGuards, Row]] = field(
        default_factory=list[tuple[DerivedGuards, Row]]
    )
    impossible: bool = False

    def add(self, other: Needs) -> None:
        """Take over the other's parts."""
        self.positive += other.positive
        self.negative += other.negative
        self.guards += other.guards
        self.blocked += other.blocked
        self.impossible = self.impossible or other.impossible


class Negation:
    """Works out negated derived facts, once each.

    Attributes:
        axioms: Those of the choices made.
        meanings: Choices by name.
    """

    def __init__(self, predicates: PredicateKinds, recursive: frozenset[str]) -> None:
        self._predicates = predicates
        self._recursive = recursive
        self._needs: dict[Fact, Needs] = {}
        self._choices: dict[tuple[tuple[Literal, ...], tuple[Fact, ...]], Fact] = {}
        self._derived_guards: dict[tuple[str, int], DerivedGuards] = {}
        self._singles: dict[Fact, frozenset[Fact]] = {}
        self.axioms: list[Axiom] = []
        self.meanings: dict[str, Meaning] = {}

    def refute(self, fact: Fact, *, guards: bool) -> Needs:
        """Return what `not fact` needs.

        Args:
            fact: Of a derived or auxiliary predicate.
            guards: Whether guards may be used (in operators' preconditions); otherwise they become
                choices.
        """
        if fact not in self._needs:
            self.prepare(fact[0], [fact[1:]])
        needs = self._needs[fact]
        if guards or not (needs.guards or needs.blocked):
            return needs
        plain = Needs(list(needs.positive), list(needs.negative), impossible=needs.impossible)
        for guard in (
            *needs.guards,
            *(guard for source, row in needs.blocked for guard in source.of(row)),
        ):
            waivers = () if guard.waived_by is None else (guard.waived_by,)
            plain.positive.append(self._choice([(False, f) for f in sorted(guard.facts)], waivers))
        return plain

    def prepare(self, predicate: str, rows: Iterable[Row]) -> None:
        """Work out the negations of many facts of one predicate in one join."""
        new = [row for row in dict.fromkeys(rows) if (predicate, *row) not in self._needs]
        for row in new:
            self._needs[predicate, *row] = Needs()
        if predicate in self._recursive and not predicate.startswith("forall "):
            reached = self._predicates.relations.rows(predicate)
            for row in new:
                if row in reached:
                    self._needs[predicate, *row].negative.append((predicate, *row))
            return

        for fact in sorted(self._predicates.given & {(predicate, *row) for row in new}):
            self._needs[fact].impossible = True
        for number, definition in enumerate(self._predicates.definitions(predicate)):
            if not DerivedGuards.fits(self._predicates, definition):
                self._refute_rule(definition, new)
                continue
            source = self._derived_guards.get((predicate, number))
            if source is None:
                source = self._derived_guards[predicate, number] = DerivedGuards(
                    self._predicates, definition
                )
            source.add(new)
            for row in new:
                self._needs[predicate, *row].blocked.append((source, row))

    def _refute_rule(self, definition: Definition, rows: list[Row]) -> None:
        literals, head = definition.literals, definition.head
        kinds = self._predicates.classify(literals)
        for i, term in enumerate(head.terms):  # constants and repeated variables in the head
            j = head.terms.index(term)
            rows = [
                row
                for row in rows
                if (row[i] == row[j] if term.startswith("?") else row[i] == term)
            ]
        columns = tuple(dict.fromkeys(term for term in head.terms if term.startswith("?")))
        start = list(
            map(
                filler(columns, {term: i for i, term in reversed(list(enumerate(head.terms)))}),
                rows,
            )
        )
        body = self._predicates.body(literals, absent=False)
        positions = {name: i for i, name in enumerate(literals.names)}
        bindings = join(self._predicates.relations, body, columns, start, literals.names)
        fill_head = filler((head.predicate, *head.terms), positions)
        fills = [filler((atom.predicate, *atom.terms), positions) for atom in kinds.positive]
        absent = [filler((atom.predicate, *atom.terms), positions) for atom in kinds.absent]
        others = [
            (sign, filler((atom.predicate, *atom.terms), positions))
            for sign, atoms in ((False, kinds.derived), (True, (*kinds.negative, *kinds.refuted)))
            for atom in atoms
        ]
        may_hold, certain = self._predicates.may_hold, self._predicates.certain
        for row in bindings:
            waivers: tuple[Fact, ...] = ()
            if absent:
                waivers = tuple(fact for fact in (fill(row) for fill in absent) if may_hold(fact))
                if not certain.isdisjoint(waivers):
                    continue
            needs = self._needs[fill_head(row)]
            facts = [fill(row) for fill in fills]
            if not others and facts:
                if len(facts) > 1 or waivers:
                    needs.guards.append(Guard(self._set(facts), waivers[0] if waivers else None))
                else:
                    needs.negative.append(facts[0])
                continue
            clause: list[Literal] = [(False, fact) for fact in facts]
            clause += [(sign, fill(row)) for sign, fill in others]
            self._require(needs, clause, waivers)

    def _require(self, needs: Needs, clause: list[Literal], waivers: tuple[Fact, ...]) -> None:
        relations = self._predicates.relations
        possible: list[Literal] = []
        for sign, fact in clause:
            reached = fact[1:] in relations.rows(fact[0])
            if not sign and not reached:
                return  # the literal is always true
            if not sign or reached:
                possible.append((sign, fact))
        if not possible and not waivers:
            needs.impossible = True
        elif len(possible) == 1 and not waivers:
            sign, fact = possible[0]
            if sign:
                needs.positive.append(fact)
            elif fact[0] in self._predicates.fluent:
                needs.negative.append(fact)
            else:
                needs.add(self.refute(fact, guards=True))
        else:
            needs.positive.append(self._choice(possible, waivers))

    def _choice(self, literals: list[Literal], waivers: tuple[Fact, ...]) -> Fact:
        """Return a fact that holds when one of the literals does, or one of the static facts."""
        key = (tuple(sorted(set(literals))), waivers)
        if key in self._choices:
            return self._choices[key]
        name = f"choice {len(self._choices) + 1}"
        head = self._choices[key] = (name,)
        words = [("" if sign else "not ") + " ".join(fact) for sign, fact in key[0]]
        self.meanings[name] = Meaning(
            " or ".join([*words, *(" ".join(fact) for fact in waivers)]),
            tuple(term for fact in (*(fact for _, fact in key[0]), *waivers) for term in fact[1:]),
        )
        for sign, fact in key[0]:
            if sign:
                self.axioms.append(Axiom(head, frozenset((fact,)), frozenset()))
            elif fact[0] in self._predicates.fluent:
                self.axioms.append(Axiom(head, frozenset(), frozenset((fact,))))
            else:
                needs = self.refute(fact, guards=False)
                if not needs.impossible:
                    self.axioms.append(
                        Axiom(head, frozenset(needs.positive), frozenset(needs.negative))
                    )
        for waiver in waivers:  # last: what holds without a test needs none
            self.axioms.append(Axiom(head, frozenset(), frozenset(), frozenset((waiver,))))
        self._predicates.relations.add(name, [()])
        return head

    def _set(self, facts: list[Fact]) -> frozenset[Fact]:
        if len(facts) > 1:
            return frozenset(facts)
        single = self._singles.get(facts[0])
        if single is None:
            single = self._singles[facts[0]] = frozenset(facts)
        return single
