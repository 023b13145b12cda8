"""Templates of operators: an action's disjunct, joined by its rule, filled in for each binding."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from tamp.symbolic.pddl.structs import Action, Atom, Fact
from tamp.symbolic.search.instantiation.datalog import Row, Rule, RuleBody, filler
from tamp.symbolic.search.instantiation.effects import EffectTemplates, LiftedEffect
from tamp.symbolic.search.instantiation.lazy_guards import LazyGuards
from tamp.symbolic.search.instantiation.negation import Needs, Negation
from tamp.symbolic.search.instantiation.normal_form import Literals
from tamp.symbolic.search.instantiation.predicate_kinds import PredicateKinds
from tamp.symbolic.search.operators import Operator


@dataclass(frozen=True, slots=True)
class Variant:
    """One disjunct of an action's precondition."""

    action: Action
    literals: Literals
    effects: tuple[LiftedEffect, ...]
    rule: Rule


class OperatorTemplate:
    """The operators of one variant, to be filled in for its bindings.

    Args:
        variant: The action's disjunct.
        rows: All bindings, sorted.
        predicates: The task's predicates and relations.
        negation: Works out the negated derived facts.
        need: Told every derived fact that an operator names.
        cost_of: Gives the value of a function term.
    """

    def __init__(
        self,
        variant: Variant,
        rows: list[Row],
        predicates: PredicateKinds,
        negation: Negation,
        need: Callable[[Fact], None],
        cost_of: Callable[[Fact], float],
    ) -> None:
        self._action = action = variant.action
        self._relations = predicates.relations
        self._negation, self._need, self._cost_of = negation, need, cost_of
        self._columns = columns = {name: i for i, name in enumerate(variant.rule.variables)}

        kinds = predicates.classify(variant.literals)
        for atom in kinds.refuted:
            negation.prepare(atom.predicate, map(filler(atom.terms, columns), rows))
        self._positive = self._fills((*kinds.positive, *kinds.derived))
        self._derived = self._fills(kinds.derived)
        fills = self._fills(kinds.negative)
        self._negative = [
            (atom.predicate, fill) for atom, fill in zip(kinds.negative, fills, strict=True)
        ]
        self._refuted = self._fills(kinds.refuted)

        # A parameter's object stands among the operator's arguments; another variable's is needed.
        named = {parameter.name for parameter in action.parameters}
        unnamed = [a for a in predicates.unnamed(variant.literals) if a.terms[0] not in named]
        static = [atom for atom in kinds.static if not atom.predicate.startswith("type ")]
        self._static = self._fills([*static, *unnamed])
        self._arguments = filler([parameter.name for parameter in action.parameters], columns)
        self._effects = EffectTemplates(
            variant.effects, variant.rule.variables, rows, predicates, negation, need
        )

        cost = action.cost
        self._price = (
            filler((cost.predicate, *cost.terms), columns) if isinstance(cost, Atom) else None
        )
        self._simple = not (kinds.negative or kinds.refuted) and all(
            effect.simple for effect in variant.effects
        )
        self._deletes = sum(not effect.adds for effect in variant.effects)

    def instantiate(self, row: Row) -> Operator | None:
        """Instantiate the operator of a binding; None where its precondition cannot hold."""
        before = frozenset([fill(row) for fill in self._positive])
        needs = self._needs(row)
        if needs.positive:
            before |= frozenset(needs.positive)
        for fact in needs.positive:
            self._need(fact)

        after = frozenset(needs.negative)
        if needs.impossible or not before.isdisjoint(after):
            return None
        for fact in needs.negative:
            self._need(fact)

        added, deleted, conditional = self._effects.of(row, before)
        guards = tuple(needs.guards)
        return Operator(
            self._action.name,
            self._arguments(row),
            before,
            after,
            added,
            deleted,
            self._cost(row),
            frozenset([fill(row) for fill in self._static]),
            LazyGuards(guards, tuple(needs.blocked)) if needs.blocked else guards,
            conditional,
        )

    def renew(self, kept: Operator, row: Row) -> Operator:
        """Return an operator kept from the last time, at the cost that it has now."""
        for fill in self._derived:
            self._need(fill(row))
        spent = self._cost_of(self._price(row)) if self._price else kept.cost
        return kept if spent == kept.cost else replace(kept, cost=spent)

    def is_final(self, operator: Operator) -> bool:
        """Check that no fact which may come along can change the operator."""
        return self._simple and len(operator.deleted) == self._deletes

    def _fills(self, atoms: Sequence[Atom]) -> list[Callable[[Row], Fact]]:
        return [filler((atom.predicate, *atom.terms), self._columns) for atom in atoms]

    def _needs(self, row: Row) -> Needs:
        """Work out what the negative literals need, and ask for the derived facts."""
        needs = Needs()
        for predicate, fill in self._negative:
            fact = fill(row)
            if fact[1:] in self._relations.rows(predicate):
                needs.negative.append(fact)
        for fill in self._refuted:
            needs.add(self._negation.refute(fill(row), guards=True))
        for fill in self._derived:
            self._need(fill(row))
        return needs

    def _cost(self, row: Row) -> float:
        if self._price:
            return self._cost_of(self._price(row))
        cost = self._action.cost
        return float(cost) if isinstance(cost, int | float) else 0.0


def action_rule(
    predicates: PredicateKinds,
    action: Action,
    literals: Literals,
    effects: tuple[LiftedEffect, ...],
) -> Rule:
    """Build the rule of an action. A parameter that neither conditions nor effects nor the cost
    mention takes one value: others change nothing.
    """
    heads = tuple(effect.atom for effect in effects if effect.adds and effect.simple)
    conditions = (literals, *(condition for effect in effects for condition in effect.conditions))
    mentioned = {
        term for one in conditions for atom in (*one.positive, *one.negative) for term in atom.terms
    }
    mentioned |= {
        term for one in conditions for left, right, _ in one.equalities for term in (left, right)
    }
    mentioned |= {term for effect in effects for term in effect.atom.terms}
    mentioned |= set(action.cost.terms) if isinstance(action.cost, Atom) else set[str]()
    free = {name: types for name, types in literals.variables if name not in mentioned}
    body = predicates.body(
        replace(literals, variables=tuple(v for v in literals.variables if v[0] not in free))
    )
    any_ = tuple(predicates.any_atom(name, types) for name, types in free.items())
    return Rule(literals.names, replace(body, positive=(*body.positive, *any_)), heads)


def effect_rules(predicates: PredicateKinds, variant: Variant) -> list[Rule]:
    """Build the rules of the conditional and universal effects that add something."""
    rules: list[Rule] = []
    for effect in variant.effects:
        for condition in effect.conditions if effect.adds and not effect.simple else ():
            before, when = variant.rule.body, predicates.body(condition)
            body = RuleBody(
                tuple(dict.fromkeys((*before.positive, *when.positive))),
                (*before.negative, *when.negative),
                (*before.equalities, *when.equalities),
            )
            rules.append(
                Rule(
                    tuple(dict.fromkeys((*variant.literals.names, *condition.names))),
                    body,
                    (effect.atom,),
                )
            )
    return rules
