"""Conditions: nodes in, formulas out, every name checked."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from tamp.pddl.nodes import Group, Node, Symbol, as_group, as_symbol, error, show
from tamp.pddl.structs import And, Atom, Domain, Exists, Forall, Formula, Not, Or, Parameter, Predicate
from tamp.pddl.typed import parameters

CONNECTIVES = ("and", "or", "not", "imply", "exists", "forall")
UNSUPPORTED = ("<", ">", "<=", ">=", "preference")
EFFECT_WORDS = ("when", "increase", "decrease", "assign", "scale-up", "scale-down")
RESERVED = frozenset((*CONNECTIVES, *EFFECT_WORDS, "=", "either", "define", *UNSUPPORTED))
"""Words that cannot name a predicate."""


@dataclass(frozen=True)
class Scope:
    """The names that a formula may use.

    Attributes:
        domain: Types, predicates and functions.
        objects: Objects (and constants) with their types; an object has all of them.
        variables: What each written variable stands for; one that hides an outer one is renamed, so that in a parsed
            formula no name is bound twice.
    """

    domain: Domain
    objects: Mapping[str, tuple[str, ...]]
    variables: Mapping[str, Parameter]

    def with_variables(self, more: Iterable[Parameter]) -> tuple[Scope, tuple[Parameter, ...]]:
        """The scope inside a quantifier, and the quantifier's parameters under their final names."""
        taken = {parameter.name for parameter in self.variables.values()}
        variables = dict(self.variables)
        renamed: list[Parameter] = []
        for parameter in more:
            name, number = parameter.name, 2
            while name in taken:
                name, number = f"{parameter.name}~{number}", number + 1
            taken.add(name)
            variables[parameter.name] = replace(parameter, name=name)
            renamed.append(variables[parameter.name])
        return replace(self, variables=variables), tuple(renamed)


def scope_of(domain: Domain, objects: Mapping[str, tuple[str, ...]] | None = None) -> Scope:
    """The scope outside of all quantifiers: the domain's constants and the given objects."""
    return Scope(domain, {**domain.constants, **(objects or {})}, {})


def parse_formula(node: Node, scope: Scope) -> Formula:
    """Read a condition; `()` is the empty conjunction, `imply` becomes a disjunction."""
    group = as_group(node, "a condition such as (on ?a ?b)")
    if not group.items:
        return And(())
    head = as_symbol(group.items[0], "a predicate or one of " + ", ".join(CONNECTIVES))
    rest = group.items[1:]
    match head.text:
        case "and":
            return And(tuple(parse_formula(part, scope) for part in rest))
        case "or":
            return Or(tuple(parse_formula(part, scope) for part in rest))
        case "not":
            _count(group, head, 1, "one condition")
            return Not(parse_formula(rest[0], scope))
        case "imply":
            _count(group, head, 2, "two conditions")
            return Or((Not(parse_formula(rest[0], scope)), parse_formula(rest[1], scope)))
        case "exists" | "forall":
            _count(group, head, 2, "a list of variables and a condition")
            listed = parameters(as_group(rest[0], "a list of variables such as (?x - body)").items, scope.domain.types)
            inner, bound = scope.with_variables(listed)
            body = parse_formula(rest[1], inner)
            return Exists(bound, body) if head.text == "exists" else Forall(bound, body)
        case word if word in UNSUPPORTED:
            raise error(head, f"'{head.written}' is not supported")
        case word if word in EFFECT_WORDS:
            raise error(head, f"'{head.written}' belongs into an effect, not into a condition")
        case _:
            return parse_atom(group, scope)


def parse_atom(node: Node, scope: Scope) -> Atom:
    """Read `(predicate term ...)`; a type is also a predicate of one argument, and `=` one of two."""
    group = as_group(node, "a fact such as (on ?a ?b)")
    head = _head(group, "a predicate")
    name, domain = head.text, scope.domain
    if name == "=":
        return _applied(group, Predicate("=", (Parameter("?a"), Parameter("?b"))), scope)
    if name in domain.predicates:
        return _applied(group, domain.predicates[name], scope)
    if name in domain.types:
        return _applied(group, Predicate(name, (Parameter("?x"),)), scope)
    if any(isinstance(item, Group) for item in group.items[1:]):
        raise error(head, f"unknown connective '{head.written}'", found=name, choices=CONNECTIVES)
    if name in domain.functions:
        raise error(head, f"'{head.written}' is a function, not a predicate")
    words = dict.fromkeys((*domain.predicates, *(type_ for type_ in domain.types if type_ != "object")))
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
        _term(as_symbol(node, "a variable or an object"), parameter.types, scope) for node, parameter in terms
    )
    return Atom(predicate.name, checked, group.place)


def _term(symbol: Symbol, types: tuple[str, ...], scope: Scope) -> str:
    if symbol.text.startswith("?"):
        if symbol.text not in scope.variables:
            choices = scope.variables
            raise error(symbol, f"unknown variable '{symbol.written}'", found=symbol.text, choices=choices)
        return scope.variables[symbol.text].name
    name = _object(symbol, scope)
    if name is not None and scope.domain.fits(scope.objects[name], types):
        return name
    fitting = [other for other, own in scope.objects.items() if scope.domain.fits(own, types)]
    if name is None:
        choices = (*scope.variables, *(fitting or scope.objects))
        message = f"unknown object '{symbol.written}'" + ("" if choices else "; there are no objects")
        raise error(symbol, message, found=symbol.written, choices=choices)
    own = " and ".join(scope.objects[name])
    message = f"'{name}' is {_article(own)}, not {_article(' or '.join(types))}"
    raise error(symbol, message + ("" if fitting else "; there is none"), choices=fitting)


def _object(symbol: Symbol, scope: Scope) -> str | None:
    """The object's name as its owner writes it: a scene's names may have capitals, which PDDL ignores."""
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
        raise error(group, f"'{head.text}' takes {what}, found {found} part{'' if found == 1 else 's'}: {show(group)}")


def _article(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"
