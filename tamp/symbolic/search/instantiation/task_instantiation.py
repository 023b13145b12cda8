"""Instantiation: from a lifted task to operators without variables, by joins over static facts and
relaxed reachability.

Predicates that no action changes and no rule derives are static: their facts are joined, smallest
first, never enumerated. Fluent and derived preconditions take part in the join as relations that
grow by a semi-naive fixpoint, so that only what is reachable in the delete relaxation is
instantiated (Helmert, Concise finite-domain representations, 2009).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from tamp.errors import InputError
from tamp.symbolic.pddl.structs import Action, Fact, Task
from tamp.symbolic.search.instantiation.axioms import stratify
from tamp.symbolic.search.instantiation.datalog import Row, Rule, filler, fixpoint
from tamp.symbolic.search.instantiation.effects import LiftedEffect, lifted_effects
from tamp.symbolic.search.instantiation.negation import Needs, Negation
from tamp.symbolic.search.instantiation.normal_form import Definition, Literals, Normalizer, Types
from tamp.symbolic.search.instantiation.operator_templates import (
    OperatorTemplate,
    Variant,
    action_rule,
    effect_rules,
)
from tamp.symbolic.search.instantiation.predicate_kinds import Assumed, PredicateKinds
from tamp.symbolic.search.operators import Axiom, Goal, InstantiatedTask, Operator


class Instantiation:
    """A task with its relations, its rules and what they have reached so far.

    Args:
        task: Gives actions, derived rules, the initial state, the goal, costs.
        assumed: Static predicates of tests that are taken to hold, see `Assumed`.
        given: Derived predicates of which facts are given besides.

    Attributes:
        absences: The static predicates that some condition wants not to hold.
    """

    def __init__(self, task: Task, assumed: Assumed, given: frozenset[str] = frozenset()) -> None:
        self._task = task
        self._normalizer = normalizer = Normalizer(task.domain, given)
        split: list[tuple[Action, Literals, tuple[LiftedEffect, ...]]] = []

        for action in task.domain.actions:
            effects = lifted_effects(action, normalizer)
            scope = {parameter.name: parameter.types for parameter in action.parameters}
            split += [
                (action, literals, effects)
                for literals in normalizer.split(action.precondition, scope)
            ]

        goals = normalizer.split(task.goal, {})
        if len(goals) != 1 or goals[0].variables:
            goals = [Literals((), (normalizer.goal(goals, task.goal),), (), ())]
        (self._goal_literals,) = goals
        self._predicates = predicates = PredicateKinds(task, normalizer, assumed)
        self._recursive = predicates.recursive()
        self._variants = [Variant(*variant, action_rule(predicates, *variant)) for variant in split]
        roots = [*(v.literals for v in self._variants), *goals]
        roots += [c for v in self._variants for effect in v.effects for c in effect.conditions]
        self._definitions: dict[str, list[tuple[Definition, Rule]]] = {
            name: [
                (d, Rule(d.literals.names, predicates.body(d.literals), (d.head,)))
                for d in normalizer.definitions[name]
            ]
            for name in normalizer.reached(roots, self._recursive)
        }
        self._rules = [variant.rule for variant in self._variants]
        self._rules += [
            rule for variant in self._variants for rule in effect_rules(predicates, variant)
        ]
        self._rules += [rule for pairs in self._definitions.values() for _, rule in pairs]
        self.absences = frozenset(
            atom.predicate for rule in self._rules for atom in rule.body.negative
        )
        self._made: list[dict[Row, Operator]] = [{} for _ in self._variants]
        self._joined = False

    def instantiate(
        self, facts: Iterable[Fact], objects: Mapping[str, Types], refused: frozenset[Fact]
    ) -> InstantiatedTask:
        """Run the fixpoint from what is new, and build everything from what it reached."""
        predicates = self._predicates
        predicates.refused = refused
        delta = predicates.add(facts, objects)
        fixpoint(predicates.relations, self._rules, delta if self._joined else None)
        self._joined = True
        self._negation = Negation(predicates, self._recursive)
        self._axioms: dict[Axiom, None] = {}
        self._needed: dict[Fact, None] = {}
        self._waiting: list[Fact] = []
        self._heads: dict[str, dict[Fact, list[tuple[int, Row]]]] = {}
        self._bodies: dict[str, list[list[list[Callable[[Row], Fact]]]]] = {}
        operators = [
            operator
            for variant, made in zip(self._variants, self._made, strict=True)
            for operator in self._operators(variant, made)
        ]
        operators.sort(key=lambda o: (o.name, o.arguments))
        goal = self._goal()
        self._derive()
        heads = {axiom.head for axiom in self._axioms}
        reachable = {
            (p, *row) for p in sorted(predicates.fluent) for row in predicates.relations.rows(p)
        } | heads
        initial = frozenset(f for f in self._task.initial if f[0] in predicates.fluent)
        meanings = {**self._normalizer.meanings(), **self._negation.meanings}

        return InstantiatedTask(
            initial, goal, tuple(operators), stratify(self._axioms), frozenset(reachable), meanings
        )

    def _operators(self, variant: Variant, made: dict[Row, Operator]) -> list[Operator]:
        """Instantiate the operators of all bindings.

        `made` keeps those that nothing which may come along can change.
        """
        rows = sorted(variant.rule.rows)
        if not rows:
            return []
        template = OperatorTemplate(
            variant, rows, self._predicates, self._negation, self._need, self._cost
        )

        operators: list[Operator] = []
        for row in rows:
            if (kept := made.get(row)) is not None:
                operators.append(template.renew(kept, row))
                continue
            operator = template.instantiate(row)
            if operator is not None:
                operators.append(operator)
                if template.is_final(operator):
                    made[row] = operator
        return operators

    def _cost(self, fact: Fact) -> float:
        if fact not in self._task.costs:
            raise InputError(
                f"the cost ({' '.join(fact)}) is not known",
                file=self._task.domain.file,
                remedy=f"Give its value in the initial state: (= ({' '.join(fact)}) 1)",
            )
        return self._task.costs[fact]

    def _goal(self) -> Goal:
        literals = self._goal_literals
        kinds = self._predicates.classify(literals)
        relations = self._predicates.relations
        needs = Needs()
        static: list[Fact] = []
        for atom in (*kinds.positive, *kinds.derived):
            needs.positive.append((atom.predicate, *atom.terms))
        for atom in kinds.static:
            holds = atom.terms in relations.rows(atom.predicate)
            if not (holds and atom.predicate.startswith("type ")):
                (static if holds else needs.positive).append((atom.predicate, *atom.terms))

        for atom in kinds.negative:
            if atom.terms in relations.rows(atom.predicate):
                needs.negative.append((atom.predicate, *atom.terms))
        for atom in kinds.absent:
            if atom.terms in relations.rows(atom.predicate):
                needs.positive.append(("not", atom.predicate, *atom.terms))
        for left, right, same in literals.equalities:
            if (left == right) is not same:
                needs.positive.append(("=", left, right) if same else ("not", "=", left, right))
        for atom in kinds.refuted:
            refuted = self._negation.refute((atom.predicate, *atom.terms), guards=False)
            needs.add(refuted)
            if refuted.impossible:
                needs.positive.append(("not", atom.predicate, *atom.terms))

        for fact in (*needs.positive, *needs.negative):
            self._need(fact)
        return Goal(frozenset(needs.positive), frozenset(needs.negative), frozenset(static))

    def _need(self, fact: Fact) -> None:
        """Ask for the axioms of a derived fact (others are ignored)."""
        if (
            fact[0] in self._definitions or fact[0].startswith("choice ")
        ) and fact not in self._needed:
            self._needed[fact] = None
            self._waiting.append(fact)

    def _derive(self) -> None:
        """Make the axioms of all needed derived facts, and of those that their bodies need."""
        choices: dict[Fact, list[Axiom]] = {}
        used = 0
        while self._waiting:
            fact = self._waiting.pop()
            for axiom in self._negation.axioms[used:]:
                choices.setdefault(axiom.head, []).append(axiom)
            used = len(self._negation.axioms)
            for axiom in (
                choices.get(fact, ()) if fact[0].startswith("choice ") else self._axioms_of(fact)
            ):
                self._axioms.setdefault(axiom)
                for other in sorted(axiom.positive | axiom.negative):
                    self._need(other)

    def _axioms_of(self, fact: Fact) -> list[Axiom]:
        predicate = fact[0]
        if predicate not in self._heads:
            heads = self._heads[predicate] = dict[Fact, list[tuple[int, Row]]]()
            bodies = self._bodies[predicate] = []
            for i, (definition, rule) in enumerate(self._definitions[predicate]):
                columns = {name: k for k, name in enumerate(rule.variables)}
                head = filler((predicate, *definition.head.terms), columns)
                for row in sorted(rule.rows):
                    heads.setdefault(head(row), []).append((i, row))
                kinds = self._predicates.classify(definition.literals)
                static = [atom for atom in kinds.static if not atom.predicate.startswith("type ")]
                static += self._predicates.unnamed(definition.literals)
                parts = ((*kinds.positive, *kinds.derived), kinds.negative, kinds.refuted, static)
                bodies.append(
                    [[filler((a.predicate, *a.terms), columns) for a in part] for part in parts]
                )
                for atom in kinds.refuted:
                    self._negation.prepare(
                        atom.predicate, map(filler(atom.terms, columns), sorted(rule.rows))
                    )

        axioms: list[Axiom] = []
        if fact in self._predicates.given:
            axioms.append(Axiom(fact, frozenset(), frozenset(), frozenset((fact,))))
        rows = self._predicates.relations.rows

        for i, row in self._heads[predicate].get(fact, ()):
            positive, negative, refuted, static = self._bodies[predicate][i]
            needs = Needs([fill(row) for fill in positive])
            needs.negative += [f for f in (fill(row) for fill in negative) if f[1:] in rows(f[0])]
            for fill in refuted:
                needs.add(self._negation.refute(fill(row), guards=False))
            if not needs.impossible:
                given = frozenset([fill(row) for fill in static])
                axioms.append(
                    Axiom(fact, frozenset(needs.positive), frozenset(needs.negative), given)
                )

        return axioms
