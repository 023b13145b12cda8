"""Conditions: nodes in, formulas out, every name checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite

from tamp.symbolic.pddl.features import FEATURES, lacking, unsupported
from tamp.symbolic.pddl.nodes import Group, Node, Symbol, as_group, as_symbol, error, show, warning
from tamp.symbolic.pddl.structs import (
    And,
    Atom,
    Domain,
    Exists,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
    Predicate,
)
from tamp.symbolic.pddl.typed import distinct, parameters

CONNECTIVES = ("and", "or", "not", "imply", "exists", "forall")
UNSUPPORTED = ("<", ">", "<=", ">=", "preference")
COMPOUND = frozenset(word for word in FEATURES if not word.startswith(":"))
"""Words of features that are not supported, unless a predicate has the name: `(at truck depot)` is
a fact.
"""
EFFECT_WORDS = ("when", "increase", "decrease", "assign", "scale-up", "scale-down")
RESERVED = frozenset((*CONNECTIVES, *EFFECT_WORDS, "=", "either", "define", *UNSUPPORTED))
"""Words that cannot name a predicate."""


@dataclass(frozen=True)
class Scope:
    """The names that a formula may use.

    Attributes:
        domain: Types, predicates and functions.
        objects: Objects (and constants) with their types; an object has all of them.
        variables: What each written variable stands for; one that hides an outer one is renamed, so
            that in a parsed formula no name is bound twice.
        notes: Collects oddities that are no errors, such as an object of a more general type than
            is declared, which Fast Downward reads; None where that is an error.
        any_type: Whether such an object may be of any type, as in Fast Downward: what a predicate
            declares is no more than a comment to it.
    """

    domain: Domain
    objects: Mapping[str, tuple[str, ...]]
    variables: Mapping[str, Parameter]
    notes: list[str] | None = field(default=None, compare=False)
    any_type: bool = False

    def with_variables(self, more: Iterable[Parameter]) -> tuple[Scope, tuple[Parameter, ...]]:
        """Return the scope inside a quantifier, and the quantifier's parameters under their
        final names.
        """
        listed = tuple(more)
        renamed = distinct(listed, {parameter.name for parameter in self.variables.values()})
        inside = {old.name: new for old, new in zip(listed, renamed, strict=True)}
        return replace(self, variables={**self.variables, **inside}), renamed


def scope_of(
    domain: Domain,
    objects: Mapping[str, tuple[str, ...]] | None = None,
    notes: list[str] | None = None,
) -> Scope:
    """Return the scope outside of all quantifiers: the domain's constants and the given objects;
    `notes` as in `Scope`.
    """
    return Scope(domain, {**domain.constants, **(objects or {})}, {}, notes)


def repeated(listed: Sequence[Parameter], bound: Sequence[Parameter]) -> tuple[Atom, ...]:
    """State that a variable written twice in one list is one: (= ?x ?x~2).

    Args:
        listed: The variables as they were written.
        bound: The same under the names that `Scope.with_variables` gave them.
    """
    last = {old.name: new.name for old, new in zip(listed, bound, strict=True)}
    pairs = ((new.name, last[old.name]) for old, new in zip(listed, bound, strict=True))
    return tuple(Atom("=", pair) for pair in pairs if pair[0] != pair[1])


def parse_formula(node: Node, scope: Scope) -> Formula:
    """Read a condition; `()` is the empty conjunction, `imply` becomes a disjunction."""
    group = as_group(node, "a condition such as (on ?a ?b)")
    if not group.items:
        return And(())
    head = as_symbol(group.items[0], "a predicate or one of " + ", ".join(CONNECTIVES))
    tail = group.items[1:]

    match head.text:
        case "and":
            return And(tuple(parse_formula(part, scope) for part in tail))
        case "or":
            return Or(tuple(parse_formula(part, scope) for part in tail))
        case "not":
            _count(group, head, 1, "one condition")
            return Not(parse_formula(tail[0], scope))
        case "imply":
            _count(group, head, 2, "two conditions")
            return Or((Not(parse_formula(tail[0], scope)), parse_formula(tail[1], scope)))
        case "exists" | "forall":
            _count(group, head, 2, "a list of variables and a condition")
            listed = parameters(
                as_group(tail[0], "a list of variables such as (?x - body)").items,
                scope.domain.types,
            )
            inner, bound = scope.with_variables(listed)
            body, same = parse_formula(tail[1], inner), repeated(listed, bound)
            if head.text == "exists":
                return Exists(bound, And((body, *same)) if same else body)
            return Forall(bound, Or((body, *map(Not, same))) if same else body)
        case word if word in UNSUPPORTED:
            raise error(head, unsupported(word, head.written))
        case word if word in EFFECT_WORDS:
            raise error(head, f"'{head.written}' belongs into an effect, not into a condition")
        case _:
            return parse_atom(group, scope)


def parse_atom(node: Node, scope: Scope) -> Atom:
    """Read `(predicate term ...)`; a type is also a predicate of one argument, and `=` one of
    two.
    """
    group = as_group(node, "a fact such as (on ?a ?b)")
    head = _head(group, "a predicate")
    name, domain = head.text, scope.domain
    if name == "=":
        for item in group.items[1:]:
            if isinstance(item, Group) or _is_number(item):
                raise error(
                    item,
                    lacking(f"(= ... {show(item).strip(chr(39))})", "numeric or object fluents"),
                )
        return _applied(group, Predicate("=", (Parameter("?a"), Parameter("?b"))), scope)

    if name in domain.predicates:
        return _applied(group, domain.predicates[name], scope)
    if name in domain.types:
        return _applied(group, Predicate(name, (Parameter("?x"),)), scope)
    if any(isinstance(item, Group) for item in group.items[1:]):
        if name in COMPOUND:
            raise error(head, unsupported(name, head.written))
        raise error(head, f"unknown connective '{head.written}'", found=name, choices=CONNECTIVES)

    if name in domain.functions:
        raise error(head, f"'{head.written}' is a function, not a predicate")
    words = dict.fromkeys(
        (*domain.predicates, *(type_ for type_ in domain.types if type_ != "object"))
    )
    raise error(head, f"unknown predicate '{head.written}'", found=name, choices=words)


def parse_function_term(node: Node, scope: Scope) -> Atom:
    """Read `(function term ...)`."""
    group = as_group(node, "a function such as (distance ?a ?b)")
    head = _head(group, "a function")
    if head.text not in scope.domain.functions:
        choices = scope.domain.functions
        raise error(head, f"unknown function '{head.written}'", found=head.text, choices=choices)
    return _applied(group, scope.domain.functions[head.text], scope)


def parse_conjunction(node: Node, scope: Scope) -> tuple[Atom, ...]:
    """Read an atom or `(and atom ...)`, as streams have them."""
    group = as_group(node, "a fact such as (pose ?o ?p), or (and ...) of several")
    if not group.items:
        return ()
    if group.head == "and":
        return tuple(atom for item in group.items[1:] for atom in parse_conjunction(item, scope))
    if group.head in RESERVED:
        remedy = "Streams have facts and conjunctions of facts only"
        raise error(group.items[0], f"'{group.head}' is not possible here", remedy=remedy)
    return (parse_atom(group, scope),)


def _applied(group: Group, predicate: Predicate, scope: Scope) -> Atom:
    wanted, found = len(predicate.parameters), len(group.items) - 1
    if wanted != found:
        names = " ".join(("", *(parameter.name for parameter in predicate.parameters)))
        plural = "" if wanted == 1 else "s"
        message = f"'{predicate.name}' takes {wanted} argument{plural}, found {found}"
        raise error(group, message, remedy=f"Its form is ({predicate.name}{names})")
    terms = zip(group.items[1:], predicate.parameters, strict=True)
    checked = tuple(
        _term(as_symbol(node, "a variable or an object"), parameter.types, scope)
        for node, parameter in terms
    )
    return Atom(predicate.name, checked, group.place)


def _term(symbol: Symbol, types: tuple[str, ...], scope: Scope) -> str:
    if symbol.text.startswith("?"):
        if symbol.text not in scope.variables:
            choices = scope.variables
            raise error(
                symbol, f"unknown variable '{symbol.written}'", found=symbol.text, choices=choices
            )
        return scope.variables[symbol.text].name

    name = _object(symbol, scope)
    if name is not None and scope.domain.fits(scope.objects[name], types):
        return name
    fitting = [other for other, own in scope.objects.items() if scope.domain.fits(own, types)]
    if name is None:
        choices = (*scope.variables, *(fitting or scope.objects))
        message = f"unknown object '{symbol.written}'" + (
            "" if choices else "; there are no objects"
        )
        raise error(symbol, message, found=symbol.written, choices=choices)

    own = " and ".join(scope.objects[name])
    general = _more_general(scope.objects[name], types, scope.domain)
    if scope.notes is not None and (general or scope.any_type):
        said = "is only said to be" if general else "is"
        what = f"'{name}' {said} {_article(own)}, where {_article(' or '.join(types))} is declared"
        scope.notes.append(warning(symbol, what))
        return name

    message = f"'{name}' is {_article(own)}, not {_article(' or '.join(types))}"
    raise error(symbol, message + ("" if fitting else "; there is none"), choices=fitting)


def _more_general(own: Iterable[str], wanted: Iterable[str], domain: Domain) -> bool:
    """Check that an object of these types may be one of the wanted ones that are below them."""
    return any(domain.is_a(want, one) for want in wanted for one in own)


def _is_number(node: Node) -> bool:
    try:
        return isinstance(node, Symbol) and isfinite(float(node.text))
    except ValueError:
        return False


def _object(symbol: Symbol, scope: Scope) -> str | None:
    """Return the object's name as its owner writes it: a scene's names may have capitals, which
    PDDL ignores.
    """
    if symbol.written in scope.objects:
        return symbol.written
    if symbol.text in scope.objects:
        return symbol.text
    same = [name for name in scope.objects if name.lower() == symbol.text]
    if len(same) > 1:
        raise error(symbol, f"'{symbol.written}' may mean any of several objects", choices=same)
    return same[0] if same else None


def _head(group: Group, what: str) -> Symbol:
    if not group.items:
        raise error(group, f"expected {what}, found '()'")
    return as_symbol(group.items[0], what)


def _count(group: Group, head: Symbol, wanted: int, what: str) -> None:
    if len(group.items) - 1 != wanted:
        found = len(group.items) - 1
        raise error(
            group,
            f"'{head.text}' takes {what}, found {found} "
            f"part{'' if found == 1 else 's'}: {show(group)}",
        )


def _article(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
