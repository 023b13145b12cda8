"""Predicates by kind, fluent, derived or static; and the relations of a task before anything
happens.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from tamp.symbolic.pddl.structs import Atom, Fact, Task
from tamp.symbolic.search.instantiation.datalog import Relations, Row, RuleBody
from tamp.symbolic.search.instantiation.normal_form import (
    Definition,
    Literals,
    Normalizer,
    Types,
    type_relation,
)
from tamp.symbolic.search.operators import ANY_OBJECT

Assumed = Mapping[str, Sequence[tuple[str, tuple[int, ...]]]]
"""Predicates that are taken to hold, each with the static facts that have to be known for that:
predicates, and which of its terms these are about."""

NOTHING: Assumed = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class ClassifiedAtoms:
    """The atoms of a conjunction by what becomes of them.

    `positive` and `negative` hold fluent atoms, `derived` and `refuted` atoms of derived and
    auxiliary predicates, `static` and `absent` atoms of static predicates.
    """

    positive: tuple[Atom, ...]
    negative: tuple[Atom, ...]
    derived: tuple[Atom, ...]
    refuted: tuple[Atom, ...]
    static: tuple[Atom, ...]
    absent: tuple[Atom, ...]


class PredicateKinds:
    """The predicates of a task by kind, and its relations.

    Attributes:
        fluent: Predicates that an action adds or deletes.
        recursive: Derived predicates that depend on themselves.
        relations: Rows of every predicate; the initial state's rows of the fluent ones.
        certain: Static facts of the initial state: no stream is needed for them.
        assumed: Static predicates whose facts are taken to hold unless refused, each with what
            has to be known of their terms.
        refused: Facts of those that do not hold.
        given: Facts of derived predicates that were given nevertheless.
    """

    def __init__(self, task: Task, normalizer: Normalizer, assumed: Assumed = NOTHING) -> None:
        self._task = task
        self._normalizer = normalizer
        self.assumed = assumed
        self.refused: frozenset[Fact] = frozenset()
        self.fluent = frozenset(
            effect.atom.predicate for action in task.domain.actions for effect in action.effects
        )
        self.relations = Relations()
        self.certain = task.initial
        self.given: set[Fact] = set()
        self._objects: dict[str, Types] = {}
        self._types: dict[str, Types] = {}
        self._add(task.initial)
        self.add((), {**task.domain.constants, **task.objects})

    def add(self, facts: Iterable[Fact], objects: Mapping[str, Types]) -> dict[str, list[Row]]:
        """Take over static facts (others are left out) and objects; returns what is new, by
        predicate.
        """
        new = self._add(fact for fact in facts if fact[0] not in self.fluent)
        fresh = {name: types for name, types in objects.items() if name not in self._objects}
        self._objects |= fresh
        for relation, types in self._types.items():
            rows = self.relations.add(relation, self._fitting(types, fresh))
            if rows:
                new[relation] = rows
        return new

    def _add(self, facts: Iterable[Fact]) -> dict[str, list[Row]]:
        rows: dict[str, set[Row]] = {}
        for fact in facts:
            rows.setdefault(fact[0], set()).add(fact[1:])
        new: dict[str, list[Row]] = {}
        for predicate in sorted(rows):
            added = self.relations.add(predicate, sorted(rows[predicate]))
            if added:
                new[predicate] = added
            if predicate in self._normalizer.definitions:
                self.given |= {(predicate, *row) for row in rows[predicate]}
        return new

    def may_hold(self, fact: Fact) -> bool:
        """Check that a static fact is known, or of a predicate that is assumed to hold and not
        refused.
        """
        rows = self.relations.rows
        if fact[1:] in rows(fact[0]):
            return True
        if fact[0] not in self.assumed or fact in self.refused:
            return False
        return all(
            tuple([fact[1 + place] for place in places]) in rows(predicate)
            for predicate, places in self.assumed[fact[0]]
        )

    def recursive(self) -> frozenset[str]:
        """Return the derived predicates that depend on themselves."""
        definitions = self._normalizer.definitions
        below = {
            name: {
                atom.predicate
                for rule in rules
                for atom in rule.literals.positive + rule.literals.negative
                if atom.predicate in definitions
            }
            for name, rules in definitions.items()
        }
        found: set[str] = set()

        for name in below:
            seen: set[str] = set()
            stack = list(below[name])
            while stack:
                at = stack.pop()
                if at not in seen:
                    seen.add(at)
                    stack.extend(below[at])
            if name in seen:
                found.add(name)

        return frozenset(found)

    def classify(self, literals: Literals) -> ClassifiedAtoms:
        """Split a conjunction by the kinds of its predicates; types that it asks about have a
        relation from then on.
        """
        definitions = self._normalizer.definitions
        for atom in (*literals.positive, *literals.negative):
            if atom.predicate.startswith("type "):
                self.type_atom(atom.terms[0], tuple(atom.predicate.split(" ")[1:]))

        def of(atoms: Iterable[Atom], kind: int) -> tuple[Atom, ...]:
            return tuple(
                a
                for a in atoms
                if (0 if a.predicate in self.fluent else 1 if a.predicate in definitions else 2)
                == kind
            )

        positive, negative = literals.positive, literals.negative
        return ClassifiedAtoms(
            of(positive, 0), of(negative, 0),
            of(positive, 1), of(negative, 1),
            of(positive, 2), of(negative, 2),
        )  # fmt: skip

    def body(self, literals: Literals, *, absent: bool = True, derived: bool = True) -> RuleBody:
        """Build what a join can check: positive atoms, types, equalities and, if wanted, the absent
        static atoms.

        Variables of the root type that occur in an atom need no relation of their own.
        """
        kinds = self.classify(literals)
        atoms = (*kinds.positive, *(kinds.derived if derived else ()), *kinds.static)
        covered = {term for atom in atoms for term in atom.terms}
        types = tuple(
            self.type_atom(name, types)
            for name, types in literals.variables
            if not (name in covered and "object" in types)
        )
        return RuleBody((*atoms, *types), kinds.absent if absent else (), literals.equalities)

    def unnamed(self, literals: Literals) -> tuple[Atom, ...]:
        """Return for each variable that no positive atom names but for its type: that there is the
        object that it stands for.
        """
        named = (atom for atom in literals.positive if not atom.predicate.startswith("type "))
        covered = {term for atom in named for term in atom.terms}
        return tuple(
            Atom(ANY_OBJECT, (name,)) for name, _ in literals.variables if name not in covered
        )

    def type_atom(self, variable: str, types: Types) -> Atom:
        """Return the atom that says that the variable has one of the types; its relation is made
        when first asked for.
        """
        name = type_relation(types)
        if name not in self._types:
            self.relations.add(name, self._fitting(types, self._objects))
            self._types[name] = types
        return Atom(name, (variable,))

    def any_atom(self, variable: str, types: Types) -> Atom:
        """Return the same of one object only, which the task itself has: for a variable that
        makes no difference.
        """
        fitting = self._fitting(types, {**self._task.domain.constants, **self._task.objects})
        if not fitting:
            return self.type_atom(variable, types)
        name = f"{type_relation(types)} any"
        self.relations.add(name, fitting[:1])
        return Atom(name, (variable,))

    def _fitting(self, types: Types, objects: Mapping[str, Types]) -> list[Row]:
        fits = {own: self._task.domain.fits(own, types) for own in set(objects.values())}
        return [(name,) for name in sorted(objects) if fits[objects[name]]]

    def definitions(self, predicate: str) -> list[Definition]:
        """Return the rules of a derived or auxiliary predicate."""
        return self._normalizer.definitions[predicate]
