"""Normal form of formulas: disjunctions split, existential variables freed, universal ones
turned into negated rules.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tamp.symbolic.pddl.structs import (
    And,
    Atom,
    Derived,
    Domain,
    Exists,
    Formula,
    Not,
    Or,
    Parameter,
)
from tamp.symbolic.search.instantiation.meanings import meaning_of
from tamp.symbolic.search.instantiation.unfolding import unfoldable
from tamp.symbolic.search.operators import Meaning

MAX_CONJUNCTIONS = 12
"""A formula is split into at most so many conjunctions; beyond, its disjunctions become auxiliary
predicates.
"""

Types = tuple[str, ...]
Scope = Mapping[str, Types]


@dataclass(frozen=True, slots=True)
class Literals:
    """A conjunction of literals, the variables in them and their types."""

    variables: tuple[tuple[str, Types], ...]
    positive: tuple[Atom, ...]
    negative: tuple[Atom, ...]
    equalities: tuple[tuple[str, str, bool], ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Return the variables without their types."""
        return tuple(name for name, _ in self.variables)


@dataclass(frozen=True, slots=True)
class Definition:
    """A rule of a derived or auxiliary predicate: head <- exists (the variables that are not in
    head). literals.
    """

    head: Atom
    literals: Literals


_Part = tuple[tuple[Parameter, ...], tuple[tuple[bool, Atom], ...]]


class Normalizer:
    """Turns formulas into disjunctions of literals. Collects the rules of the derived and auxiliary
    predicates.

    Attributes:
        definitions: Rules by the predicate that they define.
        auxiliary: Names of the predicates made here, and the formula that each stands for.

    Args:
        domain: Gives the types and the derived predicates.
        given: Derived predicates of which facts are given as well, so that their rules do not say
            all.
    """

    def __init__(self, domain: Domain, given: frozenset[str] = frozenset()) -> None:
        self._domain = domain
        self._renamed = 0
        self._unfolded = {rule.head.predicate: rule for rule in unfoldable(domain, given)}
        self.definitions: dict[str, list[Definition]] = {}
        self.auxiliary: dict[str, Formula] = {}
        for rule in domain.derived:
            types = {parameter.name: parameter.types for parameter in rule.parameters}
            declared = domain.predicates.get(rule.head.predicate)
            for i, term in enumerate(rule.head.terms):
                if term.startswith("?") and term not in types:
                    types[term] = declared.parameters[i].types if declared else ("object",)
            for literals in self.split(rule.body, types):
                self.definitions.setdefault(rule.head.predicate, []).append(
                    Definition(rule.head, literals)
                )

    def split(
        self, formula: Formula, scope: Scope, names: Mapping[str, str] | None = None
    ) -> list[Literals]:
        """Split the formula into a disjunction; each disjunct has the scope's variables and those
        of existential quantifiers.

        Args:
            formula: Any formula.
            scope: Types of its free variables (after renaming).
            names: New names of some free variables.
        """
        disjuncts: list[Literals] = []
        for parameters, literals in self._dnf(formula, True, names or {}, dict(scope)):
            variables = (*scope.items(), *((p.name, p.types) for p in parameters))
            positive: list[Atom] = []
            negative: list[Atom] = []
            equalities: list[tuple[str, str, bool]] = []
            for sign, atom in literals:
                if atom.predicate == "=":
                    equalities.append((atom.terms[0], atom.terms[1], sign))
                else:
                    (positive if sign else negative).append(self._typed(atom))
            disjuncts.append(
                Literals(
                    variables,
                    _unique(positive),
                    _unique(negative),
                    tuple(dict.fromkeys(equalities)),
                )
            )

        return disjuncts

    def _typed(self, atom: Atom) -> Atom:
        """Replace a type used as a predicate by the type's relation."""
        if atom.predicate in self._domain.types and atom.predicate not in self._domain.predicates:
            return Atom(type_relation((atom.predicate,)), atom.terms)
        return Atom(atom.predicate, atom.terms)

    def _dnf(
        self, formula: Formula, sign: bool, names: Mapping[str, str], scope: dict[str, Types]
    ) -> list[_Part]:
        if isinstance(formula, Atom):
            terms = tuple(names.get(term, term) for term in formula.terms)
            if sign and formula.predicate in self._unfolded:
                return self._unfold(self._unfolded[formula.predicate], terms, scope)
            return [((), ((sign, Atom(formula.predicate, terms)),))]
        if isinstance(formula, Not):
            return self._dnf(formula.body, not sign, names, scope)
        if isinstance(formula, And | Or):
            parts = [self._dnf(part, sign, names, scope) for part in formula.parts]
            if isinstance(formula, And) is not sign:
                return [disjunct for part in parts for disjunct in part]
            return self._product(parts, scope)
        names = dict(names)
        parameters: list[Parameter] = []
        for parameter in formula.parameters:
            self._renamed += 1
            names[parameter.name] = f"{parameter.name} {self._renamed}"
            parameters.append(Parameter(names[parameter.name], parameter.types))
            scope[names[parameter.name]] = parameter.types
        if isinstance(formula, Exists) is sign:
            return [
                ((*parameters, *more), literals)
                for more, literals in self._dnf(formula.body, sign, names, scope)
            ]
        # not exists x. f(x): a negated auxiliary predicate that f defines
        inner = [
            ((*parameters, *more), literals)
            for more, literals in self._dnf(formula.body, not sign, names, scope)
        ]
        if not inner:
            return [((), ())]
        return [((), ((False, self._name(formula, inner, scope, "forall")),))]

    def _unfold(
        self, rule: Derived, terms: tuple[str, ...], scope: dict[str, Types]
    ) -> list[_Part]:
        """Put the rule's body in the place of its head, with the types that it asks of its
        arguments.
        """
        names = dict(zip(rule.head.terms, terms, strict=True))
        typed = tuple(
            (True, Atom(type_relation(parameter.types), (names[parameter.name],)))
            for parameter in rule.parameters
            if "object" not in parameter.types
        )
        return [
            (more, (*typed, *literals))
            for more, literals in self._dnf(rule.body, True, names, scope)
        ]

    def _product(self, parts: list[list[_Part]], scope: dict[str, Types]) -> list[_Part]:
        size = 1
        for part in parts:
            size *= len(part)
        product: list[_Part] = [((), ())]
        for part in parts:
            if size > MAX_CONJUNCTIONS and len(part) > 1:
                part = [((), ((True, self._name(None, part, scope, "or")),))]
            product = [((*p, *q), (*a, *b)) for p, a in product for q, b in part]
        return product

    def _name(
        self, formula: Formula | None, parts: list[_Part], scope: dict[str, Types], kind: str
    ) -> Atom:
        """Name an auxiliary predicate of the free variables that holds when one of the parts
        does.
        """
        free: dict[str, Types] = {}
        for parameters, literals in parts:
            bound = {parameter.name for parameter in parameters}
            for _, atom in literals:
                for term in atom.terms:
                    if term.startswith("?") and term not in bound:
                        free[term] = scope[term]
        name = f"{kind} {len(self.auxiliary) + 1}"
        head = Atom(name, tuple(free))
        self.auxiliary[name] = (
            formula if formula is not None else Or(tuple(_formula(part) for part in parts))
        )
        rules: list[Definition] = []
        for parameters, literals in parts:
            body = And(tuple(atom if sign else Not(atom) for sign, atom in literals))
            types = {**free, **{parameter.name: parameter.types for parameter in parameters}}
            rules += [Definition(head, split) for split in self.split(body, types)]
        self.definitions[name] = rules
        return head

    def goal(self, disjuncts: list[Literals], formula: Formula) -> Atom:
        """Name an auxiliary predicate without arguments that holds when one of the disjuncts
        does.
        """
        name = f"goal {len(self.auxiliary) + 1}"
        self.auxiliary[name] = formula
        self.definitions[name] = [Definition(Atom(name, ()), literals) for literals in disjuncts]
        return Atom(name, ())

    def reached(self, roots: Iterable[Literals], recursive: frozenset[str]) -> list[str]:
        """Return the predicates whose facts must be derived; others are only ever negated, and
        worked out fact by fact.

        Args:
            roots: All conjunctions in which an action or the goal uses predicates.
            recursive: Predicates whose negation is evaluated on states.
        """
        wanted = self.polarities(roots, recursive)
        return [name for name in self.definitions if (name, False) in wanted]

    def polarities(
        self, roots: Iterable[Literals], recursive: frozenset[str]
    ) -> dict[tuple[str, bool], None]:
        """Return the predicates that have rules, each with whether its rules are to be refuted: for
        the roots, which are to hold, and for one another. The arguments are those of `reached`.
        """
        wanted: dict[tuple[str, bool], None] = {}
        for literals in roots:
            self._want(literals, False, wanted)
        done = 0
        while done < len(wanted):
            name, refuted = list(wanted)[done]
            done += 1
            if refuted and name in recursive and not name.startswith("forall "):
                wanted.setdefault((name, False))
            for rule in self.definitions[name]:
                self._want(rule.literals, refuted, wanted)
        return wanted

    def _want(
        self, literals: Literals, refuted: bool, wanted: dict[tuple[str, bool], None]
    ) -> None:
        for atom in literals.positive:
            if atom.predicate in self.definitions:
                wanted.setdefault((atom.predicate, False))  # a join goes over its facts
                if refuted:
                    wanted.setdefault((atom.predicate, True))
        for atom in literals.negative:
            if atom.predicate in self.definitions:
                wanted.setdefault((atom.predicate, not refuted))

    def meanings(self) -> dict[str, Meaning]:
        """Show the auxiliary predicates' formulas in PDDL, by name."""
        return {name: meaning_of(formula) for name, formula in self.auxiliary.items()}


def type_relation(types: Types) -> str:
    """Name the relation of the objects that have one of the types. Not a word of PDDL, since it
    has a blank.
    """
    return " ".join(("type", *sorted(types)))


def _formula(part: _Part) -> Formula:
    parameters, literals = part
    body = And(tuple(atom if sign else Not(atom) for sign, atom in literals))
    return Exists(parameters, body) if parameters else body


def _unique(atoms: Iterable[Atom]) -> tuple[Atom, ...]:
    return tuple(dict.fromkeys(atoms))
