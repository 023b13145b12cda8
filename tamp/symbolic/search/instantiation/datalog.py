"""Relations with indexes, joins over them, and the semi-naive fixpoint of rules (delete relaxation
as Datalog).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from operator import itemgetter
from typing import Any

from tamp.symbolic.pddl.structs import Atom

Row = tuple[str, ...]
_EMPTY: tuple[Row, ...] = ()


@dataclass(frozen=True, slots=True)
class RuleBody:
    """A conjunction with free variables. Variables of `negative` and `equalities` occur in
    `positive` too.

    Attributes:
        positive: Atoms to join; types are unary atoms.
        negative: Atoms of static predicates that must be absent.
        equalities: (term, term, whether they must be equal).
    """

    positive: tuple[Atom, ...]
    negative: tuple[Atom, ...] = ()
    equalities: tuple[tuple[str, str, bool], ...] = ()


@dataclass(slots=True)
class _Index:
    """The rows that match a pattern: from the values at some positions to the lists of those at
    others.
    """

    matches: Callable[[Row], bool] | None
    key: Callable[[Row], Any]
    value: Callable[[Row], Row]
    table: dict[Any, list[Row]] = field(default_factory=lambda: {})

    def add(self, rows: Iterable[Row]) -> None:
        table, key, value, matches = self.table, self.key, self.value, self.matches
        for row in rows:
            if matches is None or matches(row):
                table.setdefault(key(row), []).append(value(row))


def getter(positions: Sequence[int]) -> Callable[[Row], Row]:
    """Build a function that picks the positions out of a row, always as a tuple."""
    if not positions:
        return lambda row: ()
    if len(positions) == 1:
        (only,) = positions
        return lambda row: (row[only],)
    return itemgetter(*positions)


class Relations:
    """Rows by predicate, with indexes that are built when first asked for and kept up to date."""

    def __init__(self) -> None:
        self._rows: dict[str, dict[Row, None]] = {}
        self._indexes: dict[str, dict[Any, _Index]] = {}
        self._distinct: dict[tuple[str, int], tuple[int, int]] = {}

    def rows(self, predicate: str) -> dict[Row, None]:
        """Return the predicate's rows in the order of their arrival (a dict used as an ordered
        set).
        """
        return self._rows.setdefault(predicate, {})

    def add(self, predicate: str, rows: Iterable[Row]) -> list[Row]:
        """Add rows, return the new ones."""
        present = self.rows(predicate)
        new: list[Row] = []
        for row in rows:
            if row not in present:
                present[row] = None
                new.append(row)
        if new:
            for index in self._indexes.get(predicate, {}).values():
                index.add(new)
        return new

    def index(self, atom: Atom, bound: Sequence[int], free: Sequence[int]) -> dict[Any, list[Row]]:
        """Return the rows matching the atom's constants and repeated variables, by the bound
        positions' values.

        The key is the bare value when one position is bound.
        """
        terms = atom.terms
        first = {term: terms.index(term) for term in terms}
        constants = tuple((i, t) for i, t in enumerate(terms) if not t.startswith("?"))
        same = tuple(
            (i, first[t]) for i, t in enumerate(terms) if t.startswith("?") and first[t] != i
        )
        name = (tuple(bound), tuple(free), constants, same)
        indexes = self._indexes.setdefault(atom.predicate, {})
        found = indexes.get(name)
        if found is None:

            def fits(row: Row) -> bool:
                return all(row[i] == t for i, t in constants) and all(
                    row[i] == row[j] for i, j in same
                )

            matches = fits if constants or same else None
            key: Callable[[Row], Any] = itemgetter(*bound) if bound else lambda row: ()
            found = indexes[name] = _Index(matches, key, getter(free))
            found.add(self.rows(atom.predicate))
        return found.table

    def fan_out(self, atom: Atom, bound: Iterable[str]) -> float:
        """Estimate how many rows an atom adds to each binding of the known variables."""
        rows = self.rows(atom.predicate)
        distinct = 1
        for position, term in enumerate(atom.terms):
            if not term.startswith("?") or term in bound:
                distinct = max(distinct, self._count(atom.predicate, position))
        return len(rows) / distinct

    def _count(self, predicate: str, position: int) -> int:
        rows = self.rows(predicate)
        size, count = self._distinct.get((predicate, position), (-1, 0))
        if size != len(rows):
            count = len({row[position] for row in rows})
            self._distinct[predicate, position] = (len(rows), count)
        return count


def join(
    relations: Relations,
    body: RuleBody,
    variables: tuple[str, ...],
    rows: list[Row],
    order: Iterable[str],
) -> list[Row]:
    """Extend the bindings `rows` of `variables` to all that satisfy the body; return the bindings
    of `order`.

    Ground atoms are looked up first; the others are joined greedily, that which adds the fewest
    rows first, through an index on what is bound already.
    """
    atoms: list[Atom] = []
    for atom in body.positive:
        if any(term.startswith("?") for term in atom.terms):
            atoms.append(atom)
        elif atom.terms not in relations.rows(atom.predicate):
            return []
    negative = list(body.negative)
    equalities = list(body.equalities)
    positions = {variable: i for i, variable in enumerate(variables)}

    while rows:
        rows = _filter(relations, positions, negative, equalities, rows)
        if not atoms:
            break
        bound_whole = (a for a in atoms if positions.keys() >= _variables(a))
        atom = next(bound_whole, None) or min(atoms, key=lambda a: relations.fan_out(a, positions))
        atoms.remove(atom)
        bound: list[int] = []
        free: list[int] = []
        columns: list[int] = []
        fresh: list[str] = []
        for position, term in enumerate(atom.terms):
            if term in positions:
                bound.append(position)
                columns.append(positions[term])
            elif term.startswith("?") and term not in fresh:
                free.append(position)
                fresh.append(term)
        table = relations.index(atom, bound, free)
        if not bound:
            added = table.get((), _EMPTY)
            rows = (
                [row + more for row in rows for more in added] if free else (rows if added else [])
            )
        else:
            key = itemgetter(*columns)
            if free:
                get = table.get
                rows = [row + more for row in rows for more in get(key(row), _EMPTY)]
            else:
                rows = [row for row in rows if key(row) in table]
        for term in fresh:
            positions[term] = len(positions)

    if not rows:
        return []
    return list(map(getter([positions[variable] for variable in order]), rows))


def _variables(atom: Atom) -> set[str]:
    return {term for term in atom.terms if term.startswith("?")}


def _filter(
    relations: Relations,
    positions: dict[str, int],
    negative: list[Atom],
    equalities: list[tuple[str, str, bool]],
    rows: list[Row],
) -> list[Row]:
    """Apply the equalities and negative atoms whose variables are all known, and take them off the
    lists.
    """
    for equality in equalities[:]:
        left, right, same = equality
        if all(not term.startswith("?") or term in positions for term in (left, right)):
            equalities.remove(equality)
            a, b = positions.get(left), positions.get(right)
            rows = [
                row for row in rows
                if ((left if a is None else row[a]) == (right if b is None else row[b])) is same
            ]  # fmt: skip
    for atom in negative[:]:
        if positions.keys() >= _variables(atom):
            negative.remove(atom)
            present = relations.rows(atom.predicate)
            fill = filler(atom.terms, positions)
            rows = [row for row in rows if fill(row) not in present]
    return rows


def filler(terms: Sequence[str], positions: dict[str, int]) -> Callable[[Row], Row]:
    """Build a function from a binding to the terms with variables replaced."""
    constants = tuple(term for term in terms if term not in positions)
    if not constants:
        return getter([positions[term] for term in terms])
    # Constants are appended to the row, so that one itemgetter call fills in everything.
    width = len(positions)
    places = {term: width + i for i, term in enumerate(constants)}
    pick = getter([positions[term] if term in positions else places[term] for term in terms])
    return lambda row: pick(row + constants)


@dataclass(slots=True)
class Rule:
    """body -> heads. `rows` collects the bindings of `variables` that satisfied the body, in order
    of arrival.
    """

    variables: tuple[str, ...]
    body: RuleBody
    heads: tuple[Atom, ...]
    rows: dict[Row, None] = field(default_factory=lambda: {})


def fixpoint(
    relations: Relations, rules: Sequence[Rule], delta: Mapping[str, list[Row]] | None = None
) -> None:
    """Apply the rules until nothing new follows (semi-naive evaluation); relations and rules' rows
    are extended in place.

    Semi-naive: a rule is joined from the new rows of each predicate in its body only.

    Args:
        relations: What is known.
        rules: What follows from what.
        delta: What became known since the last fixpoint of these rules; None for the first one.
    """
    while delta is None or delta:
        derived: dict[str, dict[Row, None]] = {}
        for rule in rules:
            new: list[Row] = []
            for row in _triggered(relations, rule, delta):
                if row not in rule.rows:
                    rule.rows[row] = None
                    new.append(row)
            if not new:
                continue
            positions = {variable: i for i, variable in enumerate(rule.variables)}
            for head in rule.heads:
                derived.setdefault(head.predicate, {}).update(
                    dict.fromkeys(map(filler(head.terms, positions), new))
                )
        added = {predicate: relations.add(predicate, rows) for predicate, rows in derived.items()}
        delta = {predicate: rows for predicate, rows in added.items() if rows}


def _triggered(
    relations: Relations, rule: Rule, delta: Mapping[str, list[Row]] | None
) -> Iterable[Row]:
    if delta is None:
        yield from join(relations, rule.body, (), [()], rule.variables)
        return
    for position, atom in enumerate(rule.body.positive):
        if atom.predicate not in delta:
            continue
        fresh = Relations()
        fresh.add(atom.predicate, delta[atom.predicate])
        variables = tuple(dict.fromkeys(term for term in atom.terms if term.startswith("?")))
        start = join(fresh, RuleBody((atom,)), (), [()], variables)
        others = rule.body.positive[:position] + rule.body.positive[position + 1 :]
        body = RuleBody(others, rule.body.negative, rule.body.equalities)
        yield from join(relations, body, variables, start, rule.variables)
