"""A goal in disjunctive form: its conjuncts, and for each the conjunctions of fluent literals by
which it can hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import Axiom, InstantiatedTask

MAX_ALTERNATIVES = 512
"""Conjunctions into which a goal is opened at most; beyond, it excludes nothing."""

MOST_WORK = 100_000
"""Rules opened and conjunctions joined for a part of the goal, and for the choices of all parts
together, at most: the rest excludes none.
"""

Literal = tuple[Fact, bool]
"""A fact, and whether it is to hold."""

Way = frozenset[Literal]
"""Literals over fluents that together make a goal hold."""


@dataclass(frozen=True)
class GoalPart:
    """A part of the goal: the literal that names it, and all ways in which it can hold.

    Attributes:
        literal: Names it.
        ways: Its ways; one that asks for nothing where they are too many.
        choices: Parts of which it holds together or not at all, one such list for each rule of an
            auxiliary fact: a goal with "or" or "exists" is one fact.
    """

    literal: Literal
    ways: tuple[Way, ...]
    choices: tuple[tuple[GoalPart, ...], ...] = ()


def goal_parts(instantiated: InstantiatedTask) -> list[GoalPart]:
    """List the goal's conjuncts, universal ones taken apart, each with its ways to hold."""
    rules = _by_head(instantiated.axioms)
    literals = [(fact, True) for fact in sorted(instantiated.goal.positive)]
    literals += [(fact, False) for fact in sorted(instantiated.goal.negative)]
    opened: dict[Literal, None] = {}
    auxiliary = instantiated.meanings.keys()
    for literal in literals:
        for part in _opened(literal, rules, auxiliary, ()):
            opened[part] = None
    opener = _Opener(rules)
    return [_part(literal, rules, auxiliary, opener) for literal in opened]


def _part(literal: Literal, rules: Rules, auxiliary: Iterable[str], opener: _Opener) -> GoalPart:
    """Open a conjunct; `opener` opens the choices of all of them, whose work is bounded as one."""
    fact, wanted = literal
    choices: list[tuple[GoalPart, ...]] = []
    if wanted and fact[0] in auxiliary:
        for axiom in rules.get(fact, []):
            opened = dict.fromkeys(
                part for one in _body(axiom) for part in _opened(one, rules, auxiliary, (fact,))
            )
            choices.append(tuple(GoalPart(one, tuple(opener.ways(one))) for one in opened))
    return GoalPart(literal, tuple(_Opener(rules).ways(literal)), tuple(choices))


Rules = dict[Fact, list[Axiom]]


def _by_head(axioms: Iterable[Axiom]) -> Rules:
    rules: Rules = {}
    for axiom in axioms:
        rules.setdefault(axiom.head, []).append(axiom)
    return rules


def _body(axiom: Axiom) -> list[Literal]:
    return [
        *((fact, True) for fact in sorted(axiom.positive)),
        *((fact, False) for fact in sorted(axiom.negative)),
    ]


def _opened(
    literal: Literal, rules: Rules, auxiliary: Iterable[str], above: tuple[Fact, ...]
) -> Iterator[Literal]:
    """Yield the conjuncts that an auxiliary fact stands for; of other facts the literal itself."""
    fact, wanted = literal
    made = rules.get(fact, [])
    if fact[0] in auxiliary and fact not in above:
        if wanted and len(made) == 1:
            for part in _body(made[0]):
                yield from _opened(part, rules, auxiliary, (*above, fact))
            return
        if not wanted and made and all(len(_body(axiom)) == 1 for axiom in made):
            for axiom in made:
                ((part, sign),) = _body(axiom)
                yield from _opened((part, not sign), rules, auxiliary, (*above, fact))
            return
    yield literal


ANY_WAY: list[Way] = [frozenset()]
"""How a literal holds of which nothing is known."""


class _Opener:
    """Opens literals by their rules, with bounded work: rules in circles have no end of ways."""

    def __init__(self, rules: Rules) -> None:
        self._rules, self._work = rules, 0

    def ways(self, literal: Literal, above: frozenset[Fact] = frozenset()) -> list[Way]:
        """List conjunctions of fluent literals of which one holds wherever the literal does."""
        fact, wanted = literal
        if fact not in self._rules:
            return [frozenset((literal,))]

        self._work += 1
        if fact in above or self._work > MOST_WORK:
            return ANY_WAY
        above |= {fact}

        if wanted:
            ways: list[Way] = []
            for axiom in self._rules[fact]:
                ways += self._product([self.ways(part, above) for part in _body(axiom)])
                if len(ways) > MAX_ALTERNATIVES:
                    return ANY_WAY
            return ways

        return self._product(
            [
                [way for part, sign in _body(axiom) for way in self.ways((part, not sign), above)]
                for axiom in self._rules[fact]
            ]
        )

    def _product(self, choices: list[list[Way]]) -> list[Way]:
        """Join one of each without contradictions; choices beyond ALTERNATIVES stay open."""
        ways = ANY_WAY
        for choice in sorted(choices, key=len):
            if len(ways) * len(choice) > MAX_ALTERNATIVES:
                continue
            self._work += len(ways) * len(choice)
            joined = (a | b for a in ways for b in choice)
            ways = [way for way in joined if not any((fact, not sign) in way for fact, sign in way)]
        return ways
