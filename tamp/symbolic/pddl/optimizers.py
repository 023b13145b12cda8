"""PDDLStream's `:optimizer`: read and left aside; where ordinary streams do not give the same, that
is said.
"""

from __future__ import annotations

from collections.abc import Sequence

from tamp.symbolic.pddl.formulas import parse_conjunction, scope_of
from tamp.symbolic.pddl.nodes import (
    Group,
    as_group,
    as_name,
    as_symbol,
    as_variable,
    error,
    show,
    warning,
)
from tamp.symbolic.pddl.sections import Section, keyword_values
from tamp.symbolic.pddl.structs import Domain, Parameter, Stream

PARTS = (":variables", ":constraint", ":objective")
REMEDY = (
    "tamp draws values stream by stream: write each (:variables ...) as a :stream, "
    ":graph as :certified, "
    "and each (:constraint ...) as a test stream"
)
KEYWORDS = (":inputs", ":domain", ":graph", ":necessary", ":fluents")


def check_optimizer(
    section: Section, streams: Sequence[Stream], domain: Domain
) -> tuple[list[str], list[str]]:
    """Read one optimizer: notes of it, and of them those of facts that nothing else certifies.

    Initial facts may stand for those, or no plan need them.

    Raises:
        InputError: It is malformed.
    """
    if not section.items:
        raise error(section.group, "an optimizer has no name")
    name = as_name(section.items[0], "an optimizer's name")
    certified = {atom.predicate for stream in streams for atom in stream.certified}
    alone: dict[str, str] = {}

    for node in section.items[1:]:
        group = as_group(node, f"a part of the optimizer, one of {', '.join(PARTS)}")
        keyword = as_symbol(group.items[0], "a part's keyword") if group.items else None
        if keyword is None or keyword.text not in PARTS:
            found = keyword.text if keyword else None
            raise error(
                group,
                f"unknown part {show(group)} of optimizer '{name.text}'",
                found=found,
                choices=PARTS,
            )
        for predicate, where in _promised(group, keyword.text, domain):
            if predicate not in certified:
                missing = f"no stream certifies ({predicate} ...)"
                what = f"optimizer '{name.text}' is not called, and {missing}"
                alone.setdefault(predicate, warning(where, f"{what}. {REMEDY}"))

    if alone:
        return [*alone.values()], [*alone.values()]

    return [
        warning(
            section.group,
            f"optimizer '{name.text}' is left aside: streams certify all that it would",
        )
    ], []


def _promised(group: Group, keyword: str, domain: Domain) -> list[tuple[str, Group]]:
    """Return the predicates that a part of an optimizer makes true, each with its place."""
    if keyword == ":objective":
        return []
    if len(group.items) < 2:
        raise error(group, f"'{keyword}' needs a list of variables or a fact")
    head = as_group(group.items[1], "a list of variables, or a fact such as (cfree ?a ?b)")
    values = keyword_values(group.items[2:], f"the {keyword[1:]}", KEYWORDS)
    if keyword == ":variables":
        inputs = (
            as_group(values[":inputs"], "a list after :inputs").items if ":inputs" in values else ()
        )
        variables, facts = (
            [as_variable(item) for item in (*head.items, *inputs)],
            values.get(":graph"),
        )
    else:
        variables, facts = [as_variable(item) for item in head.items[1:]], head

    scope = scope_of(domain).with_variables(Parameter(symbol.text) for symbol in variables)[0]
    if facts is None:
        return []
    where = as_group(facts, "facts")
    return [(atom.predicate, where) for atom in parse_conjunction(facts, scope)]
