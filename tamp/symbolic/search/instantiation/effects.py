"""An action's effects: universal ones expanded, conditions checked against the static facts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from tamp.symbolic.pddl.structs import Action, And, Atom, Fact
from tamp.symbolic.search.instantiation.datalog import Row, RuleBody, filler, getter, join
from tamp.symbolic.search.instantiation.negation import Needs, Negation
from tamp.symbolic.search.instantiation.normal_form import Literals, Normalizer
from tamp.symbolic.search.instantiation.predicate_kinds import PredicateKinds
from tamp.symbolic.search.operators import NO_FACTS, ConditionalEffect, Facts


@dataclass(frozen=True, slots=True)
class LiftedEffect:
    """An effect whose own variables have names of their own, and its condition as a disjunction."""

    atom: Atom
    adds: bool
    conditions: tuple[Literals, ...]
    simple: bool


def lifted_effects(action: Action, normalizer: Normalizer) -> tuple[LiftedEffect, ...]:
    """Normalize an action's effects. A quantified variable may have the name of one of the action's
    parameters.
    """
    effects: list[LiftedEffect] = []
    for effect in action.effects:
        names = {parameter.name: f"{parameter.name} of effect" for parameter in effect.parameters}
        scope = {parameter.name: parameter.types for parameter in action.parameters}
        scope |= {names[parameter.name]: parameter.types for parameter in effect.parameters}
        atom = Atom(
            effect.atom.predicate, tuple(names.get(term, term) for term in effect.atom.terms)
        )
        simple = not effect.parameters and effect.condition == And(())
        effects.append(
            LiftedEffect(
                atom, effect.adds, tuple(normalizer.split(effect.condition, scope, names)), simple
            )
        )
    return tuple(effects)


_Instance = tuple[frozenset[Fact], frozenset[Fact], frozenset[Fact], Fact]
"""Positive and negative condition, static facts that it rests on, the fact added or deleted."""


class EffectTemplates:
    """The effects of one action's operators.

    Args:
        variables: Of the operators' bindings.
        rows: All bindings.
        need: Told every derived fact that a condition names.
    """

    def __init__(
        self,
        effects: tuple[LiftedEffect, ...],
        variables: tuple[str, ...],
        rows: list[Row],
        predicates: PredicateKinds,
        negation: Negation,
        need: Callable[[Fact], None],
    ) -> None:
        self._predicates, self._negation, self._need = predicates, negation, need
        self._columns = {name: i for i, name in enumerate(variables)}
        relations = predicates.relations
        self._adds: list[Callable[[Row], Fact]] = []
        self._deletes: list[tuple[str, Callable[[Row], Row], Callable[[Row], Fact]]] = []
        self._expanded: list[tuple[bool, Callable[[Row], Row], dict[Row, list[_Instance]]]] = []
        self._shared: dict[int, dict[Row, tuple[Facts, list[_Instance]]]] = {}
        self._rows = relations.rows
        for effect in effects:
            atom = effect.atom
            fact = filler((atom.predicate, *atom.terms), self._columns) if effect.simple else None
            if fact is not None and effect.adds:
                self._adds.append(fact)
            elif fact is not None:
                self._deletes.append((atom.predicate, filler(atom.terms, self._columns), fact))
            else:
                for condition in effect.conditions:
                    self._expand(effect, condition, rows)

    def _expand(self, effect: LiftedEffect, condition: Literals, rows: list[Row]) -> None:
        """Find all instances of one effect, by the values of the action's variables that it
        mentions.
        """
        shared, names, found = self._join(effect, condition, rows)
        own = names[len(shared) :]
        key = getter([self._columns[name] for name in shared])
        columns = {name: i for i, name in enumerate(names)}
        kinds = self._predicates.classify(condition)
        unnamed = [atom for atom in self._predicates.unnamed(condition) if atom.terms[0] in own]
        unnamed = [] if not effect.adds else unnamed
        fact = filler((effect.atom.predicate, *effect.atom.terms), columns)
        fills = {
            kind: [filler((atom.predicate, *atom.terms), columns) for atom in atoms]
            for kind, atoms in (
                ("positive", (*kinds.positive, *kinds.derived)),
                ("negative", kinds.negative),
                ("refuted", kinds.refuted),
                (
                    "static",
                    (*(a for a in kinds.static if not a.predicate.startswith("type ")), *unnamed),
                ),
            )
        }

        instances: dict[Row, list[_Instance]] = {}
        width = len(shared)
        for row in sorted(found):
            needs = Needs([fill(row) for fill in fills["positive"]])
            needs.negative += [
                f for f in (fill(row) for fill in fills["negative"]) if f[1:] in self._rows(f[0])
            ]
            for fill in fills["refuted"]:
                needs.add(self._negation.refute(fill(row), guards=False))
            if needs.impossible:
                continue
            static = frozenset([fill(row) for fill in fills["static"]]) - self._predicates.certain
            changed = fact(row)
            for needed in (*needs.positive, *needs.negative):
                self._need(needed)
            positive = frozenset(needs.positive)
            if not effect.adds:
                positive -= {changed}  # deleting what is absent changes nothing
            instances.setdefault(row[:width], []).append(
                (positive, frozenset(needs.negative), static, changed)
            )
        self._expanded.append((effect.adds, key, instances))

    def _join(
        self, effect: LiftedEffect, condition: Literals, rows: list[Row]
    ) -> tuple[tuple[str, ...], tuple[str, ...], list[Row]]:
        """Join an effect's condition with the bindings of the action's variables.

        Returns:
            The action's variables that it mentions, all its variables, those first, and bindings.
        """
        body = self._predicates.body(condition)
        used = {
            term
            for atom in (effect.atom, *condition.positive, *condition.negative)
            for term in atom.terms
        }
        used |= {term for left, right, _ in condition.equalities for term in (left, right)}
        shared = tuple(name for name in self._columns if name in used)

        # Types of the action's own parameters have been checked already; only what exists can be
        # deleted.
        atoms = [
            a
            for a in body.positive
            if not (a.predicate.startswith("type ") and a.terms[0] in self._columns)
        ]
        if not effect.adds and effect.atom not in atoms:
            atoms.append(effect.atom)
        own = tuple(name for name in condition.names if name not in self._columns)
        key = getter([self._columns[name] for name in shared])
        start = list(dict.fromkeys(map(key, rows)))

        names = (*shared, *own)
        found = join(
            self._predicates.relations,
            RuleBody(tuple(atoms), body.negative, body.equalities),
            shared,
            start,
            names,
        )
        return shared, names, found

    def of(self, row: Row, before: Facts) -> tuple[Facts, Facts, tuple[ConditionalEffect, ...]]:
        """Return the added facts, deleted facts and conditional effects of the operator with this
        binding.

        Args:
            row: The binding.
            before: The operator's positive precondition: conditions need not repeat it.
        """
        added = [fill(row) for fill in self._adds]
        deleted = [
            fact(row)
            for predicate, fill, fact in self._deletes
            if fill(row) in self._rows(predicate)
        ]
        universal: list[Facts] = []
        conditional: dict[tuple[Facts, Facts, Facts], tuple[list[Fact], list[Fact]]] = {}
        for number, (adds, key, instances) in enumerate(self._expanded):
            at = key(row)
            always, depending = self._split(number, at, instances.get(at, []))
            if adds:
                added += always
            elif always:
                universal.append(always)
            for positive, negative, static, fact in depending:
                positive -= before
                if not positive.isdisjoint(negative) or not negative.isdisjoint(before):
                    continue
                changes = conditional.setdefault((positive, negative, static), ([], []))
                changes[0 if adds else 1].append(fact)
        unconditional = conditional.pop((NO_FACTS, NO_FACTS, NO_FACTS), None)
        if unconditional:
            added += unconditional[0]
            deleted += unconditional[1]
        if len(universal) == 1 and not deleted:
            (all_deleted,) = universal  # shared among operators
        else:
            all_deleted = frozenset(deleted).union(*universal)
        return (
            frozenset(added),
            all_deleted,
            tuple(
                ConditionalEffect(positive, negative, frozenset(adds), frozenset(deletes), static)
                for (positive, negative, static), (adds, deletes) in conditional.items()
            ),
        )

    def _split(
        self, number: int, key: Row, instances: list[_Instance]
    ) -> tuple[Facts, list[_Instance]]:
        """Split off the facts changed in any case, one set for all operators with this key, from
        the conditional instances.
        """
        table = self._shared.setdefault(number, {})
        if key not in table:
            always = frozenset(
                fact
                for positive, negative, static, fact in instances
                if not (positive or negative or static)
            )
            table[key] = (always, [i for i in instances if i[0] or i[1] or i[2]])
        return table[key]
