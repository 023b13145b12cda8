"""PDDL as frozen data. Facts are tuples of strings: ("on", "mug", "cupboard_top")."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Fact = tuple[str, ...]
"""A predicate's name and its objects' names."""


@dataclass(frozen=True, slots=True)
class Place:
    """A place in a file; lines and columns count from 1."""

    file: str | None
    line: int
    column: int


@dataclass(frozen=True, slots=True)
class Parameter:
    """A variable ("?o") and its types; an untyped one has ("object",)."""

    name: str
    types: tuple[str, ...] = ("object",)


@dataclass(frozen=True, slots=True)
class Atom:
    """predicate(terms); a term is a variable ("?o") or an object. Equality is the predicate "="."""

    predicate: str
    terms: tuple[str, ...]
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Not:
    """The body does not hold."""

    body: Formula


@dataclass(frozen=True, slots=True)
class And:
    """All parts hold; without parts it always does."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Or:
    """Some part holds; without parts it never does."""

    parts: tuple[Formula, ...]


@dataclass(frozen=True, slots=True)
class Exists:
    """The body holds for some objects of the parameters' types."""

    parameters: tuple[Parameter, ...]
    body: Formula


@dataclass(frozen=True, slots=True)
class Forall:
    """The body holds for all objects of the parameters' types."""

    parameters: tuple[Parameter, ...]
    body: Formula


Formula = Atom | Not | And | Or | Exists | Forall
"""`imply` is parsed into Or(Not, ...)."""


@dataclass(frozen=True, slots=True)
class Effect:
    """One simple effect: for all `parameters`, when `condition` holds, add or delete `atom`."""

    atom: Atom
    adds: bool
    condition: Formula = And(())
    parameters: tuple[Parameter, ...] = ()


@dataclass(frozen=True, slots=True)
class Action:
    """A lifted action. `cost` is a number, or a function term whose value is a fact's cost
    (":function" streams).
    """

    name: str
    parameters: tuple[Parameter, ...]
    precondition: Formula
    effects: tuple[Effect, ...]
    cost: float | Atom = 1.0
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Derived:
    """A derived predicate's rule: head(parameters) holds when the body does. A head may have
    several rules.
    """

    head: Atom
    parameters: tuple[Parameter, ...]
    body: Formula
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Predicate:
    """A declared predicate or function."""

    name: str
    parameters: tuple[Parameter, ...]
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True)
class Domain:
    """A parsed domain. `types` maps each type to its parent; "object" is the root and its own
    parent.

    A type declared below `(either a b)` or twice has further parents, in `more_parents`; so ask
    `is_a`. `notes` are oddities that are no errors, each with its place.
    """

    name: str
    types: Mapping[str, str]
    constants: Mapping[str, tuple[str, ...]]
    predicates: Mapping[str, Predicate]
    functions: Mapping[str, Predicate]
    actions: tuple[Action, ...]
    derived: tuple[Derived, ...]
    file: str | None = None
    more_parents: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    notes: tuple[str, ...] = ()

    def is_a(self, type_: str, ancestor: str) -> bool:
        """Check that `type_` is `ancestor` or below it."""
        waiting, seen = [type_], {type_}
        while waiting:
            one = waiting.pop()
            if one == ancestor:
                return True
            above = {self.types.get(one, "object"), *self.more_parents.get(one, ())} - seen
            seen |= above
            waiting += above
        return False

    def fits(self, types: tuple[str, ...], wanted: tuple[str, ...]) -> bool:
        """Check that an object of all these types may stand where one of the `wanted` types is
        asked for.
        """
        return "object" in wanted or any(self.is_a(own, want) for own in types for want in wanted)

    @property
    def fluent_predicates(self) -> frozenset[str]:
        """Name the predicates that some action changes."""
        return frozenset(
            effect.atom.predicate for action in self.actions for effect in action.effects
        )

    @property
    def derived_predicates(self) -> frozenset[str]:
        """Name the predicates that rules define."""
        return frozenset(rule.head.predicate for rule in self.derived)


@dataclass(frozen=True, slots=True)
class Stream:
    """A stream's declaration: given inputs for which `domain` holds, its function yields outputs
    for which `certified` holds.

    Without outputs it is a test. `fluents` names the predicates whose facts in the current state
    its function is shown.
    """

    name: str
    inputs: tuple[str, ...]
    domain: tuple[Atom, ...]
    outputs: tuple[str, ...]
    certified: tuple[Atom, ...]
    fluents: tuple[str, ...] = ()
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Function:
    """A numeric function computed by Python: its value is the cost of the action that names it."""

    name: str
    inputs: tuple[str, ...]
    domain: tuple[Atom, ...]
    place: Place | None = field(default=None, compare=False)


@dataclass(frozen=True)
class StreamFile:
    """A parsed streams file.

    Attributes:
        streams: Those that need a function.
        functions: Costs that Python computes.
        predicates: Static predicates that Python decides.
        rules: What follows from certified facts, as streams without outputs that always succeed.
        notes: Oddities that are no errors, each with its place.
        uncalled: What only an optimizer would certify, which is never called, each with its place.
    """

    name: str
    streams: tuple[Stream, ...]
    functions: tuple[Function, ...] = ()
    file: str | None = None
    predicates: tuple[Function, ...] = ()
    rules: tuple[Stream, ...] = ()
    notes: tuple[str, ...] = ()
    uncalled: tuple[str, ...] = ()


@dataclass(frozen=True)
class Task:
    """A symbolic problem: objects with their types, initial facts, goal, and costs of function
    facts.

    `notes` are oddities of its file that are no errors, each with its place.
    """

    name: str
    domain: Domain
    objects: Mapping[str, tuple[str, ...]]
    initial: frozenset[Fact]
    goal: Formula
    costs: Mapping[Fact, float]
    notes: tuple[str, ...] = ()
