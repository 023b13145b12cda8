"""Exogenous streams, those that wait for actions: a `:domain` that names what actions change, or
what rules derive.

Such a stream may be called once its domain has come true; what it certifies then holds. So the
planner asks it for values as if that were so, and conditions read each fact that rests on it
through a rule: the stream gave it, and all of its domain that actions change was true at some time
(of what rules derive: is true now). PDDLStream calls such streams exogenous.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

from tamp.errors import InputError
from tamp.symbolic.pddl.complement import atoms_of_conditions
from tamp.symbolic.pddl.nodes import error
from tamp.symbolic.pddl.structs import (
    Action,
    And,
    Atom,
    Derived,
    Domain,
    Exists,
    Fact,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
    Predicate,
    Stream,
    StreamFile,
)


@dataclass(frozen=True)
class CompiledTask:
    """A task whose streams speak of what never changes.

    Attributes:
        domain: With rules for what rests on a waiting stream.
        streams: Each certifies as well that it gave its outputs for its inputs.
        goal: Over those rules.
        facts: The initial ones, with what was true at first.
    """

    domain: Domain
    streams: StreamFile
    goal: Formula
    facts: frozenset[Fact]


def compile_away(
    domain: Domain, streams: StreamFile, goal: Formula, facts: frozenset[Fact]
) -> CompiledTask:
    """Move what changes from the streams' domains into rules; nothing is changed where there is
    none.

    Raises:
        InputError: What rests on a waiting stream has to be false somewhere.
    """
    made = [*streams.streams, *streams.rules]
    changing = domain.fluent_predicates | domain.derived_predicates
    dependent = _dependent(made, changing)
    if not dependent:
        return CompiledTask(domain, streams, goal, facts)
    for atom, sign in atoms_of_conditions(domain, goal):
        if not sign and atom.predicate in dependent:
            what = (
                f"'{atom.predicate}' has to be false here, "
                "and its stream waits for what actions change"
            )
            remedy = (
                "Put what it waits for in the action's precondition instead of the stream's :domain"
            )
            raise (
                InputError(what, remedy=remedy)
                if atom.place is None
                else error(atom.place, what, remedy=remedy)
            )

    awaited = {
        atom.predicate for stream in made for atom in stream.domain
    } & domain.fluent_predicates
    rewriting = _Rewriting(domain, dependent, sorted(awaited), facts)
    changed = {stream.name: rewriting.stream(stream) for stream in made}
    actions = tuple(rewriting.action(action) for action in domain.actions)
    derived = tuple(rewriting.rules)
    predicates = {**domain.predicates, **rewriting.predicates}

    return CompiledTask(
        replace(domain, predicates=predicates, actions=actions, derived=derived),
        replace(
            streams,
            streams=tuple(changed[stream.name] for stream in streams.streams),
            rules=tuple(changed[stream.name] for stream in streams.rules),
        ),
        renamed(goal, rewriting.now),
        facts | rewriting.started,
    )


class _Rewriting:
    """A domain on the way to one whose streams do not wait.

    Attributes:
        now: Of what rests on waiting streams: the derived predicate that conditions read.
        was: Of what actions change and streams wait for: what notes that it has been true.
        predicates: The new ones.
        rules: The domain's over `now`, and those that define it, of the streams seen so far.
        started: What is noted of the initial facts.
    """

    def __init__(
        self,
        domain: Domain,
        dependent: Collection[str],
        awaited: Collection[str],
        facts: frozenset[Fact],
    ) -> None:
        self._domain = domain
        self._changing = domain.fluent_predicates | domain.derived_predicates
        self.predicates: dict[str, Predicate] = {}
        self.now = {predicate: self._like(predicate, f"{predicate}-now") for predicate in dependent}
        self.was = {predicate: self._like(predicate, f"was-{predicate}") for predicate in awaited}
        self.rules = [replace(rule, body=renamed(rule.body, self.now)) for rule in domain.derived]
        self.started = {(self.was[fact[0]], *fact[1:]) for fact in facts if fact[0] in self.was}
        for predicate in dependent:
            given = [fact for fact in facts if fact[0] == predicate]
            if given:
                name = self._like(predicate, f"given-{predicate}")
                self.started |= {(name, *fact[1:]) for fact in given}
                terms = tuple(f"?x{i}" for i in range(len(domain.predicates[predicate].parameters)))
                self.rules.append(
                    _rule(Atom(self.now[predicate], terms), terms, (Atom(name, terms),))
                )

    def stream(self, stream: Stream) -> Stream:
        """Rewrite a stream into one that does not wait, and add the rules for what it certifies."""
        certified = [atom for atom in stream.certified if atom.predicate in self.now]
        if not certified:
            return stream
        terms = (*stream.inputs, *stream.outputs)
        result = Atom(
            self._new(f"{stream.name}-result", tuple(Parameter(term) for term in terms)), terms
        )
        waits = [self._awaited(atom) for atom in stream.domain]
        body = (result, *(atom for atom in waits if atom is not None))
        self.rules += [
            _rule(replace(atom, predicate=self.now[atom.predicate]), terms, body)
            for atom in certified
        ]
        static = tuple(atom for atom in stream.domain if atom.predicate not in self._changing)
        return replace(stream, domain=static, certified=(*stream.certified, result))

    def action(self, action: Action) -> Action:
        """Rewrite the action over the rules; what it makes true is noted as having been true."""
        effects = [
            replace(effect, condition=renamed(effect.condition, self.now))
            for effect in action.effects
        ]
        noted = [
            replace(effect, atom=replace(effect.atom, predicate=self.was[effect.atom.predicate]))
            for effect in effects
            if effect.adds and effect.atom.predicate in self.was
        ]
        return replace(
            action, precondition=renamed(action.precondition, self.now), effects=(*effects, *noted)
        )

    def _awaited(self, atom: Atom) -> Atom | None:
        """Return what a rule asks in the place of a stream's domain; nothing of what never
        changes.
        """
        name = self.was.get(atom.predicate) or self.now.get(atom.predicate)
        if name is not None:
            return replace(atom, predicate=name)
        return atom if atom.predicate in self._changing else None

    def _like(self, predicate: str, name: str) -> str:
        return self._new(name, self._domain.predicates[predicate].parameters)

    def _new(self, name: str, parameters: tuple[Parameter, ...]) -> str:
        while name in self._domain.predicates or name in self.predicates:
            name += "~"
        self.predicates[name] = Predicate(name, parameters)
        return name


def _dependent(streams: Sequence[Stream], changing: Collection[str]) -> list[str]:
    """Return what streams certify whose domain changes, or rests on such a stream."""
    found: dict[str, None] = {}
    before = -1
    while len(found) > before:
        before = len(found)
        for stream in streams:
            if any(atom.predicate in changing or atom.predicate in found for atom in stream.domain):
                found.update(dict.fromkeys(atom.predicate for atom in stream.certified))
    return list(found)


def _rule(head: Atom, variables: Sequence[str], body: Sequence[Atom]) -> Derived:
    """Build a rule whose head holds when there are such variables; it may have constants, and a
    variable twice.
    """
    fresh = tuple(f"?x{i}" for i in range(len(head.terms)))
    plain = len(set(head.terms)) == len(head.terms) and set(head.terms) <= set(variables)
    terms = head.terms if plain else fresh
    equal = () if plain else tuple(Atom("=", pair) for pair in zip(fresh, head.terms, strict=True))
    quantified = tuple(Parameter(variable) for variable in variables if variable not in terms)
    conditions = And((*body, *equal))
    return Derived(
        replace(head, terms=terms),
        tuple(Parameter(term) for term in terms),
        Exists(quantified, conditions) if quantified else conditions,
    )


def renamed(formula: Formula, names: Mapping[str, str]) -> Formula:
    """Rename some of a formula's predicates."""
    match formula:
        case Atom(predicate):
            return replace(formula, predicate=names.get(predicate, predicate))
        case Not(body):
            return Not(renamed(body, names))
        case And(parts) | Or(parts):
            return type(formula)(tuple(renamed(part, names) for part in parts))
        case Exists(parameters, body) | Forall(parameters, body):
            return type(formula)(parameters, renamed(body, names))
