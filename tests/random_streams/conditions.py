"""Random atoms and conditions over what a problem has so far."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random

from tests.random_streams.problems import CONSTANTS, MADE, THINGS, Atom, Formula, Problem

Scope = dict[str, str]

PURE, UP, DOWN = "pure", "up", "down"
"""What a predicate is with more results: the same, more, less."""


class Conditions:
    """A problem in the making, and its predicates by kind."""

    def __init__(self, seed: int) -> None:
        self.rng = rng = Random(seed)
        self.problem = Problem(seed, rng.random() < 0.35)
        self.kinds: dict[str, str] = {}
        self.count = 0
        self.words: Sequence[str] = CONSTANTS

    def declare(self, name: str, kinds: Sequence[str], kind: str) -> None:
        self.problem.predicates[name] = tuple(kinds)
        self.kinds[name] = kind

    def generating(self, up: bool, state: bool = False) -> list[str]:
        """The predicates whose atoms say where variables come from."""
        names = [name for name in self.problem.predicates if state or not name.startswith("w")]
        return [
            name for name in names if self.kinds[name] == PURE or (up and self.kinds[name] == UP)
        ]

    def anchor(self, name: str, scope: Scope, same: float) -> Atom:
        """An atom over variables of the scope and new ones, which are put into it."""
        terms: list[str] = []
        for kind in self.problem.predicates[name]:
            known = [term for term, one in scope.items() if one == kind and term not in terms]
            if known and self.rng.random() < same:
                terms.append(self.rng.choice(known))
            else:
                self.count += 1
                terms.append(f"?{kind[0]}{self.count}")
                scope[terms[-1]] = kind
        return (name, *terms)

    def leaf(self, names: Sequence[str], scope: Scope) -> Atom | None:
        """An atom over the scope's variables and the problem's objects."""
        for name in self.rng.sample(names, len(names)):
            terms: list[str] = []
            for kind in self.problem.predicates[name]:
                mine = [term for term, one in scope.items() if one == kind]
                choices = [
                    *mine,
                    *mine,
                    *(o for o in self.words if self.problem.objects[o] == kind),
                ]
                if not choices:
                    break
                terms.append(self.rng.choice(choices))
            else:
                return (name, *terms)
        return None

    def fluent(self, scope: Scope) -> Atom | None:
        return self.leaf(self.problem.fluents, scope)

    def mentioning(self, term: str, scope: Scope) -> Atom | None:
        """A fluent atom with the variable in it: it holds of what was touched only."""
        for _ in range(8):
            atom = self.fluent(scope)
            if atom is not None and term in atom:
                return atom
        return None

    def formula(self, scope: Scope, depth: int, up: bool, pure: bool = False) -> Formula:
        """A condition that more results help (`up`), or hinder."""
        rng = self.rng
        wanted = {PURE} if pure else {PURE, UP} if up else {PURE, DOWN}
        kind = (
            rng.choice(("leaf", "leaf", "and", "or", "not", "not", "exists", "forall", "="))
            if depth
            else "leaf"
        )
        if kind in ("and", "or"):
            return (kind, *(self.formula(scope, depth - 1, up, pure) for _ in range(2)))
        if kind == "not":
            return ("not", self.formula(scope, depth - 1, not up, pure))
        if kind == "=":
            pairs = [(x, y) for x in scope for y in scope if x < y and scope[x] == scope[y]]
            if pairs:
                same: Formula = ("=", *rng.choice(pairs))
                return same if rng.random() < 0.3 else ("not", same)
        if kind in ("exists", "forall"):
            return self.quantified(kind, scope, depth, up, pure)
        if not pure and rng.random() < 0.25:
            other = self.leaf(
                [
                    name
                    for name, one in self.kinds.items()
                    if one in ({PURE, DOWN} if up else {PURE, UP})
                ],
                scope,
            )
            if other is not None and not other[0].startswith("w"):
                return ("not", other)
        names = [
            name for name, one in self.kinds.items() if one in wanted and not name.startswith("w")
        ]
        return self.leaf(names, scope) or ("and",)

    def quantified(self, kind: str, scope: Scope, depth: int, up: bool, pure: bool) -> Formula:
        self.count += 1
        name, what = f"?q{self.count}", self.rng.choice((*THINGS, *MADE))
        inner = {**scope, name: what}
        body = self.formula(inner, depth - 1, up, pure)
        if what in THINGS:
            return (kind, ((name, what),), body)
        guard = self.mentioning(name, inner)
        if guard is None:
            return ("and",)
        if kind == "exists":
            return ("exists", ((name, what),), ("and", guard, body))
        return ("forall", ((name, what),), ("imply", guard, body))

    def _rows(self, kinds: Sequence[str]) -> Iterator[tuple[str, ...]]:
        if not kinds:
            yield ()
            return
        for name in [o for o, kind in self.problem.objects.items() if kind == kinds[0]]:
            for rest in self._rows(kinds[1:]):
                yield (name, *rest)
