"""Random small stream problems: a domain with derived predicates, streams of finite tables, a task.

Everything is plain tuples, and PDDL text for the planner: nothing here knows the planner's data structures.

What conditions say of certified facts is monotone, as the streams' semantics asks: more results never forbid a plan.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import blake2b
from random import Random
from typing import Any

Term = str
Atom = tuple[str, ...]
Formula = tuple[Any, ...]
"""("pred", term, ...), ("=", a, b), ("and" or "or", ...), ("not", f), ("exists" or "forall", ((name, type),), f)."""

Params = tuple[tuple[str, str], ...]

THINGS, MADE = ("thing", "spot"), ("pose", "grip")
CONSTANTS = ("a", "s")
"""The objects that the domain names."""

POOL = 3
"""Values of one type where different calls may give the same."""


@dataclass(frozen=True)
class Source:
    """A stream: a test without outputs; with `fluents` what it gives holds only in the state that it was shown."""

    name: str
    inputs: Params
    domain: tuple[Atom, ...]
    outputs: Params
    certified: tuple[Atom, ...]
    fluents: tuple[str, ...] = ()


@dataclass(frozen=True)
class Effect:
    """For all `params`, when `condition`, the atom is added or deleted."""

    atom: Atom
    adds: bool
    condition: Formula = ("and",)
    params: Params = ()


@dataclass(frozen=True)
class Act:
    """An action; its cost is a number or a function's atom."""

    name: str
    params: Params
    condition: Formula
    effects: tuple[Effect, ...]
    cost: float | Atom = 1.0


@dataclass(frozen=True)
class Rule:
    """The head holds when the body does; rules are listed so that a head rests on earlier ones, and on itself."""

    head: Atom
    params: Params
    body: Formula


@dataclass
class Problem:
    """A random problem.

    Attributes:
        pooled: Equal values are one object, and different calls may give the same.
        predicates: Name to types of the arguments.
    """

    seed: int
    pooled: bool
    objects: dict[str, str] = field(default_factory=dict[str, str])
    predicates: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    fluents: list[str] = field(default_factory=list[str])
    rules: list[Rule] = field(default_factory=list[Rule])
    acts: list[Act] = field(default_factory=list[Act])
    sources: list[Source] = field(default_factory=list[Source])
    functions: dict[str, str] = field(default_factory=dict[str, str])
    init: set[Atom] = field(default_factory=set[Atom])
    goal: Formula = ("and",)

    def table(
        self, source: Source, inputs: tuple[str, ...], shown: frozenset[Atom] = frozenset()
    ) -> list[Atom]:
        """All that a stream gives for these values, in order; for a test [()] or []."""
        key = f"{self.seed} {source.name} {inputs} {sorted(shown)}"
        rng = Random(key)
        if not source.outputs:
            return [()] if rng.random() < 0.55 else []
        rows: list[Atom] = []
        for number in range(rng.choice((0, 1, 1, 2, 2, 3))):
            if self.pooled:
                row = tuple(f"{kind}{rng.randrange(POOL)}" for _, kind in source.outputs)
            else:
                digest = blake2b(f"{key} {number}".encode(), digest_size=5).hexdigest()
                row = tuple(f"{kind}-{i}-{digest}" for i, (_, kind) in enumerate(source.outputs))
            if row not in rows:
                rows.append(row)
        return rows

    def price(self, function: str, value: str) -> float:
        """What a function of one value costs."""
        return float(Random(f"{self.seed} {function} {value}").randrange(4))


def text(formula: Formula) -> str:
    """A condition as PDDL."""
    head, *rest = formula
    if head in ("and", "or", "not", "imply"):
        return f"({head} {' '.join(map(text, rest))})"
    if head in ("exists", "forall"):
        return f"({head} {_typed(rest[0])} {text(rest[1])})"
    return f"({' '.join(formula)})"


def _typed(params: Params) -> str:
    return f"({' '.join(f'{name} - {kind}' for name, kind in params)})"


def _effect(effect: Effect) -> str:
    said = text(effect.atom) if effect.adds else f"(not {text(effect.atom)})"
    if effect.condition != ("and",):
        said = f"(when {text(effect.condition)} {said})"
    return f"(forall {_typed(effect.params)} {said})" if effect.params else said


def domain_text(problem: Problem) -> str:
    """The domain as PDDL."""
    lines = ["(define (domain random)", "(:requirements :adl :derived-predicates :action-costs)"]
    lines.append(f"(:types {' '.join((*THINGS, *MADE, 'way'))} - object)")
    lines.append(
        f"(:constants {' '.join(f'{name} - {problem.objects[name]}' for name in CONSTANTS)})"
    )
    predicates = [
        f"({' '.join((name, *(f'?x{i} - {kind}' for i, kind in enumerate(kinds))))})"
        for name, kinds in problem.predicates.items()
    ]
    lines.append(f"(:predicates {' '.join(predicates)})")
    functions = [f"({name} ?x - {kind})" for name, kind in problem.functions.items()]
    lines.append(f"(:functions (total-cost) {' '.join(functions)})")
    for rule in problem.rules:
        head = " ".join((rule.head[0], *(f"{name} - {kind}" for name, kind in rule.params)))
        lines.append(f"(:derived ({head}) {text(rule.body)})")
    for act in problem.acts:
        cost = text(act.cost) if isinstance(act.cost, tuple) else f"{act.cost:g}"
        effects = " ".join(map(_effect, act.effects))
        lines.append(
            f"(:action {act.name} :parameters {_typed(act.params)} :precondition {text(act.condition)}"
            f" :effect (and {effects} (increase (total-cost) {cost})))"
        )
    return "\n".join((*lines, ")"))


def streams_text(problem: Problem) -> str:
    """The streams as PDDL."""
    lines = ["(define (stream random)"]
    for source in problem.sources:
        inputs = " ".join(name for name, _ in source.inputs)
        outputs = " ".join(name for name, _ in source.outputs)
        lines.append(
            f"(:stream {source.name} :inputs ({inputs}) :domain (and {' '.join(map(text, source.domain))})"
        )
        if source.fluents:
            lines.append(f":fluents ({' '.join(source.fluents)})")
        if source.outputs:
            lines.append(f":outputs ({outputs})")
        lines.append(f":certified (and {' '.join(map(text, source.certified))}))")
    for name, kind in problem.functions.items():
        lines.append(f"(:function ({name} ?x) ({kind} ?x))")
    return "\n".join((*lines, ")"))
