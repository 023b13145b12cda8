"""Stream files in PDDLStream's syntax: text in, checked declarations out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from tamp.symbolic.pddl.formulas import (
    Scope,
    parse_atom,
    parse_conjunction,
    parse_function_term,
    scope_of,
)
from tamp.symbolic.pddl.nodes import (
    Group,
    Node,
    Symbol,
    as_group,
    as_name,
    as_symbol,
    as_variable,
    error,
)
from tamp.symbolic.pddl.optimizers import check_optimizer
from tamp.symbolic.pddl.sections import Section, keyword_values, read_sections
from tamp.symbolic.pddl.structs import Atom, Domain, Function, Parameter, Stream, StreamFile
from tamp.symbolic.pddl.typed import refuse_duplicates

SECTIONS = (":stream", ":wild-stream", ":function", ":predicate", ":rule", ":optimizer")
STREAM_KEYWORDS = (":inputs", ":domain", ":fluents", ":outputs", ":certified")


def parse_streams(
    text: str, domain: Domain, file: str | Path | None = None, *, waiting: bool = False
) -> StreamFile:
    """Read the streams of a domain.

    Args:
        text: The streams file's.
        domain: Whose predicates they speak of.
        file: Where the text is from, for errors.
        waiting: Whether what actions change may stand in a stream's :domain, see `exogenous`, and
            in its :certified, see `started`.

    Raises:
        InputError: With file, line and column of what is wrong.
    """
    name, sections = read_sections(text, "stream", SECTIONS, file)
    by_keyword = {
        keyword: [s for s in sections if s.keyword.text == keyword] for keyword in SECTIONS
    }
    streamed = [
        section for section in sections if section.keyword.text in (":stream", ":wild-stream")
    ]
    streams = [_stream(section, domain, waiting) for section in streamed]
    rules = [
        _rule(number, section, domain, waiting)
        for number, section in enumerate(by_keyword[":rule"], start=1)
    ]
    read = [
        check_optimizer(section, [*streams, *rules], domain) for section in by_keyword[":optimizer"]
    ]
    result = StreamFile(
        name.text,
        tuple(streams),
        tuple(
            _function(section, domain, parse_function_term) for section in by_keyword[":function"]
        ),
        None if file is None else str(file),
        tuple(_function(section, domain, parse_atom) for section in by_keyword[":predicate"]),
        tuple(rules),
        tuple(note for notes, _ in read for note in notes),
        tuple(note for _, alone in read for note in alone),
    )
    refuse_duplicates((as_symbol(section.items[0], "a name") for section in streamed), "stream")

    for keyword in (":function", ":predicate"):
        heads = (
            as_group(section.items[0], f"a {keyword[1:]}").items[0]
            for section in by_keyword[keyword]
        )
        refuse_duplicates((as_symbol(head, "a name") for head in heads), keyword[1:])

    for predicate in result.predicates:
        _check_static(predicate, domain)
    return result


def output_types(stream: Stream, domain: Domain) -> dict[str, tuple[str, ...]]:
    """Return the types of a stream's outputs: those that the predicates it certifies declare, the
    most special ones.

    An output that several predicates declare differently has all of those types; one of which
    nothing is known is an ("object",).
    """
    result: dict[str, tuple[str, ...]] = {}
    for output in stream.outputs:
        declared = [type_ for atom in stream.certified for type_ in _declared(atom, output, domain)]
        special = [
            one
            for one in dict.fromkeys(declared)
            if not any(other != one and domain.is_a(other, one) for other in declared)
        ]
        result[output] = tuple(special) or ("object",)
    return result


def _declared(atom: Atom, variable: str, domain: Domain) -> list[str]:
    if atom.predicate not in domain.predicates:
        return [atom.predicate] if variable in atom.terms else []
    parameters = domain.predicates[atom.predicate].parameters
    pairs = zip(atom.terms, parameters, strict=True)
    return [type_ for term, parameter in pairs if term == variable for type_ in parameter.types]


def _stream(section: Section, domain: Domain, waiting: bool) -> Stream:
    if not section.items:
        raise error(section.group, "a stream has no name")
    name = as_name(section.items[0], "a stream's name")
    owner = f"stream '{name.text}'"
    values = keyword_values(section.items[1:], owner, STREAM_KEYWORDS)
    inputs, outputs = (_variables(values.get(key), key) for key in (":inputs", ":outputs"))
    refuse_duplicates((*inputs, *outputs), f"variable of {owner}:")
    condition = _atoms(
        values.get(":domain"), _scope(domain, inputs), domain, f":domain of {owner}", waiting
    )
    scope, where = _scope(domain, [*inputs, *outputs]), f":certified of {owner}"
    certified = _atoms(values.get(":certified"), scope, domain, where, waiting, derived=False)
    if not certified:
        raise error(values.get(":certified", section.group), f"{owner} certifies nothing")
    _check_covered(inputs, condition, f"input of {owner} does not stand in its :domain")
    fluents = tuple(_fluent(node, domain) for node in _list(values.get(":fluents"), ":fluents"))

    return Stream(
        name.text,
        tuple(symbol.text for symbol in inputs),
        condition,
        tuple(symbol.text for symbol in outputs),
        certified,
        fluents,
        section.group.place,
    )


def _rule(number: int, section: Section, domain: Domain, waiting: bool) -> Stream:
    """Parse `(:rule :inputs (?a) :domain (f ?a) :certified (g ?a))`: what holds whenever the
    domain does.
    """
    owner = f"rule {number}"
    values = keyword_values(section.items, owner, (":inputs", ":domain", ":certified"))
    inputs = _variables(values.get(":inputs"), ":inputs")
    condition = _atoms(
        values.get(":domain"), _scope(domain, inputs), domain, f":domain of {owner}", waiting
    )
    where = f":certified of {owner}"
    certified = _atoms(
        values.get(":certified"), _scope(domain, inputs), domain, where, waiting, derived=False
    )
    if not certified:
        raise error(values.get(":certified", section.group), f"{owner} certifies nothing")
    _check_covered(inputs, condition, f"input of {owner} does not stand in its :domain")
    names = tuple(symbol.text for symbol in inputs)
    return Stream(owner.replace(" ", ""), names, condition, (), certified, (), section.group.place)


def _check_static(predicate: Function, domain: Domain) -> None:
    """Check that a predicate that Python decides never changes."""
    for names, what in (
        (domain.fluent_predicates, "changed by actions"),
        (domain.derived_predicates, "derived"),
    ):
        if predicate.name in names and predicate.place:
            raise error(
                predicate.place, f"'{predicate.name}' is {what}, so Python cannot decide it"
            )


def _function(section: Section, domain: Domain, parse: Callable[[Node, Scope], Atom]) -> Function:
    """Parse `(:function (f ?a ?b) CONDITION)` as in PDDLStream, or with the keywords :inputs and
    :domain.

    A `:predicate` looks the same; `parse` reads the head.
    """
    if not section.items:
        raise error(section.group, "expected a head such as (distance ?a ?b)")
    head = as_group(section.items[0], "a head such as (distance ?a ?b)")
    arguments = [as_variable(item) for item in head.items[1:]]
    refuse_duplicates(arguments, "argument")
    scope = _scope(domain, arguments)
    term = parse(head, scope)
    tail = section.items[1:]
    if len(tail) == 1 and isinstance(tail[0], Group):
        node: Node | None = tail[0]
    else:
        values = keyword_values(tail, f"function '{term.predicate}'", (":inputs", ":domain"))
        node = values.get(":domain")
        given = [symbol.text for symbol in _variables(values.get(":inputs"), ":inputs")]
        if ":inputs" in values and given != list(term.terms):
            raise error(
                values[":inputs"],
                f"the inputs are not the arguments {' '.join(term.terms)} of the function",
            )

    condition = _atoms(node, scope, domain, f"the domain of function '{term.predicate}'")
    _check_covered(
        arguments,
        condition,
        f"argument of function '{term.predicate}' does not stand in its domain",
    )
    return Function(term.predicate, term.terms, condition, section.group.place)


def _atoms(
    node: Node | None,
    scope: Scope,
    domain: Domain,
    where: str,
    may_change: bool = False,
    *,
    derived: bool = True,
) -> tuple[Atom, ...]:
    """Parse the facts of a conjunction, none of which an action may change: streams speak of what
    holds for ever.

    With `may_change` an action may, and with `derived` too, a rule may make them.
    """
    atoms = parse_conjunction(node, scope) if node is not None else ()
    for atom in () if may_change and derived else atoms:
        kind = "derived" if atom.predicate in domain.derived_predicates else ""
        kind = (
            "changed by actions"
            if atom.predicate in domain.fluent_predicates and not may_change
            else kind
        )
        if kind and atom.place:
            remedy = (
                "Streams speak of what never changes; a function sees the state through :fluents"
            )
            raise error(
                atom.place,
                f"'{atom.predicate}' is {kind}, it cannot stand in {where}",
                remedy=remedy,
            )
    return atoms


def _check_covered(variables: Sequence[Symbol], atoms: Sequence[Atom], message: str) -> None:
    used = {term for atom in atoms for term in atom.terms}
    for variable in variables:
        if variable.text not in used:
            raise error(variable, f"'{variable.written}': this {message}")


def _scope(domain: Domain, variables: Sequence[Symbol]) -> Scope:
    return scope_of(domain).with_variables(Parameter(symbol.text) for symbol in variables)[0]


def _variables(node: Node | None, keyword: str) -> list[Symbol]:
    items = _list(node, keyword)
    for item in items:
        if isinstance(item, Symbol) and item.text == "-":
            raise error(
                item,
                f"{keyword} have no types",
                remedy="Write the type as a fact: (movable ?o) in :domain",
            )
    return [as_variable(item) for item in items]


def _list(node: Node | None, keyword: str) -> Sequence[Node]:
    return as_group(node, f"a list after {keyword}").items if node is not None else ()


def _fluent(node: Node, domain: Domain) -> str:
    symbol = as_name(node, "a predicate's name")
    if symbol.text not in domain.predicates:
        choices = domain.predicates
        raise error(
            symbol, f"unknown predicate '{symbol.written}'", found=symbol.text, choices=choices
        )
    return symbol.text
