"""A plan by the book: the lifted actions, rules and goal on real facts, nothing instantiated.

It shares no code with instantiation and search, so that a fault there is not repeated here.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from tamp.symbolic.pddl.structs import (
    Action,
    And,
    Atom,
    Derived,
    Exists,
    Fact,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
    Task,
)
from tamp.symbolic.search.recursion import strata_of
from tamp.symbolic.search.replay_formulas import (
    Binding,
    conjunct_atoms,
    formula_words,
    guard_atoms,
    substituted,
)

REFUTED_TEXT = (
    "a plan was dropped that did not hold when it was replayed, "
    "a mistake of the planner's: please report it"
)
"""How the reason is told to people."""


def violation(
    task: Task,
    actions: Sequence[tuple[str, tuple[str, ...]]],
    facts: Iterable[Fact] = (),
    objects: Mapping[str, tuple[str, ...]] | None = None,
    shown: Callable[[frozenset[Fact]], Iterable[Fact]] | None = None,
) -> str | None:
    """Replay a plan and say what is wrong; None where it leads from the start to the goal.

    Args:
        task: Gives actions, rules, the initial state and the goal.
        actions: Names and arguments.
        facts: What holds in every state besides the task's static facts: what streams certified.
        objects: Types of the objects besides the task's.
        shown: What streams certified of a state only, given its fluent facts.

    Returns:
        A sentence that names the step, counted from 1.
    """
    there = {**task.domain.constants, **task.objects, **(objects or {})}
    lifted = {action.name: action for action in task.domain.actions}

    static = {*task.initial, *facts}
    changing = task.domain.fluent_predicates
    state = frozenset(fact for fact in static if fact[0] in changing)
    static.difference_update(state)

    world = _World(task, there, static)

    for number, (name, arguments) in enumerate(actions):
        step = f"step {number + 1}, ({' '.join((name, *arguments))})"
        action = lifted.get(name)
        if action is None or len(arguments) != len(action.parameters):
            return f"{step}: there is no such action"

        for parameter, word in zip(action.parameters, arguments, strict=True):
            if not world.fits(word, parameter):
                return f"{step}: '{word}' is no {' or '.join(parameter.types)}"
        world.enter(state, shown(state) if shown else ())
        binding = {
            parameter.name: word
            for parameter, word in zip(action.parameters, arguments, strict=True)
        }
        failed = world.failing(action.precondition, binding)
        if failed is not None:
            return f"{step}: the precondition does not hold, {failed}"
        state = world.after(action, binding, state)

    world.enter(state, shown(state) if shown else ())
    failed = world.failing(task.goal, {})
    return None if failed is None else f"the goal does not hold in the end, {failed}"


def _by_predicate(facts: Iterable[Fact]) -> dict[str, set[Fact]]:
    rows: dict[str, set[Fact]] = defaultdict(set)
    for fact in facts:
        rows[fact[0]].add(fact)
    return dict(rows)


class _World:
    """The facts that hold in one state after the other."""

    def __init__(
        self, task: Task, objects: Mapping[str, tuple[str, ...]], static: Iterable[Fact]
    ) -> None:
        self._task, self._objects, self._kinds_there = task, objects, set(objects.values())
        self._rules: dict[str, list[Derived]] = defaultdict(list)
        for rule in task.domain.derived:
            self._rules[rule.head.predicate].append(rule)
        self._types = {"=", *task.domain.types.keys() - task.domain.predicates.keys()}
        self._kinds, self._recursive = strata_of(self._rules)
        self._of_types: dict[tuple[str, ...], dict[str, None]] = {}
        self._static = _by_predicate(static)
        self._rows = dict(self._static)
        self._plain: dict[int, tuple[Atom, ...]] = {}
        self._truths: dict[Fact, bool] = {}
        self._asked: tuple[frozenset[str], dict[Fact, bool]] | None = None

    def enter(self, state: Iterable[Fact], shown: Iterable[Fact]) -> None:
        """Go to a state: its fluent facts, and what was certified of it alone."""
        self._rows, self._truths, self._asked = dict(self._static), {}, None
        for predicate, facts in _by_predicate((*state, *shown)).items():
            self._rows[predicate] = facts | self._static.get(predicate, set())

    def fits(self, word: str, parameter: Parameter) -> bool:
        """Check that an object is there and of one of the parameter's types."""
        return word in self._fitting(parameter.types)

    def _fitting(self, types: tuple[str, ...]) -> dict[str, None]:
        found = self._of_types.get(types)
        if found is None:
            fits = {own: self._task.domain.fits(own, types) for own in self._kinds_there}
            fitting = (name for name, own in self._objects.items() if fits[own])
            found = self._of_types[types] = dict.fromkeys(fitting)
        return found

    def failing(self, formula: Formula, binding: Binding) -> str | None:
        """Return the part of a conjunction that does not hold, in words."""
        if isinstance(formula, And):
            said = (self.failing(part, binding) for part in formula.parts)
            return next((one for one in said if one is not None), None)
        return None if self.holds(formula, binding) else formula_words(formula, binding)

    def holds(self, formula: Formula, binding: Binding) -> bool:
        """Check that a condition holds."""
        match formula:
            case Atom():
                return self._fact(substituted(formula, binding))
            case Not(body):
                return not self.holds(body, binding)
            case And(parts):
                return all(self.holds(part, binding) for part in parts)
            case Or(parts):
                return any(self.holds(part, binding) for part in parts)
            case Exists(parameters, body):
                return any(
                    self.holds(body, full)
                    for full in self._bindings(parameters, self._where(body, True), binding)
                )
            case Forall(parameters, body):
                where = self._where(body, False)
                return all(
                    self.holds(body, full) for full in self._bindings(parameters, where, binding)
                )

    def _where(self, formula: Formula, sign: bool) -> tuple[Atom, ...]:
        """Return the atoms that are facts wherever the formula holds, or wherever it does not."""
        cached = self._plain.get(id(formula))
        if cached is None:
            atoms = conjunct_atoms(formula) if sign else guard_atoms(formula)
            kept = (
                atom
                for atom in atoms
                if atom.predicate not in self._rules and atom.predicate not in self._types
            )
            cached = self._plain[id(formula)] = tuple(kept)
        return cached

    def _bindings(
        self, parameters: Sequence[Parameter], atoms: Sequence[Atom], binding: Binding
    ) -> Iterator[Binding]:
        """Yield the parameters' values for which the atoms hold, as far as none is derived."""
        names = {parameter.name: parameter for parameter in parameters}
        outer = {name: word for name, word in binding.items() if name not in names}
        yield from self._join(
            [atom for atom in atoms if not names.keys().isdisjoint(atom.terms)], names, outer
        )

    def _join(
        self, atoms: Sequence[Atom], names: Mapping[str, Parameter], binding: Binding
    ) -> Iterator[Binding]:
        if atoms:
            atom = min(
                atoms,
                key=lambda one: (
                    sum(self._open(t, names, binding) for t in one.terms),
                    len(self._of(one)),
                ),
            )
            others = [one for one in atoms if one is not atom]
            for fact in self._of(atom):
                grown = self._matched(atom, fact, names, binding)
                if grown is not None:
                    yield from self._join(others, names, grown)
            return

        left = [name for name in names if name not in binding]
        if not left:
            yield binding
            return
        for word in self._fitting(names[left[0]].types):
            yield from self._join((), names, {**binding, left[0]: word})

    def _of(self, atom: Atom) -> set[Fact]:
        return self._rows.get(atom.predicate, set())

    @staticmethod
    def _open(term: str, names: Mapping[str, Parameter], binding: Binding) -> bool:
        return term in names and term not in binding

    def _matched(
        self, atom: Atom, fact: Fact, names: Mapping[str, Parameter], binding: Binding
    ) -> Binding | None:
        grown = dict(binding)
        for term, word in zip(atom.terms, fact[1:], strict=True):
            if self._open(term, names, grown):
                if not self.fits(word, names[term]):
                    return None
                grown[term] = word
            elif grown.get(term, term) != word:
                return None
        return grown

    def _fact(self, fact: Fact) -> bool:
        if fact[0] == "=":
            return fact[1] == fact[2]
        if fact[0] in self._types:
            return fact[1] in self._fitting((fact[0],))
        if fact in self._rows.get(fact[0], ()):
            return True
        return fact[0] in self._rules and self._derived(fact)

    def _derived(self, fact: Fact) -> bool:
        """Check that a rule gives the fact.

        Where its predicate rests on itself: the least fixpoint over what is asked for of its kind
        on the way to it.
        """
        if fact in self._truths:
            return self._truths[fact]
        outer, kind = self._asked, self._kinds[fact[0]]
        if outer is not None and outer[0] == kind:  # within the fixpoint: what is known by now
            return outer[1].setdefault(fact, False)
        asked = {fact: False}
        self._asked = kind, asked
        changed = True
        while changed:
            size, changed = len(asked), False
            for one in list(asked):
                if not asked[one] and self._follows(one):
                    asked[one] = changed = True
            changed = fact[0] in self._recursive and (changed or len(asked) > size)
        self._asked = outer
        self._truths.update(asked)
        return asked[fact]

    def _follows(self, fact: Fact) -> bool:
        for rule in self._rules[fact[0]]:
            binding: dict[str, str] = {}
            same = all(
                binding.setdefault(term, word) == word if term.startswith("?") else term == word
                for term, word in zip(rule.head.terms, fact[1:], strict=True)
            )
            fits = same and all(
                self.fits(binding[one.name], one) for one in rule.parameters if one.name in binding
            )
            if fits and self.holds(rule.body, binding):
                return True
        return False

    def after(self, action: Action, binding: Binding, state: frozenset[Fact]) -> frozenset[Fact]:
        """Return the state after an action; adding wins over deleting."""
        added: set[Fact] = set()
        deleted: set[Fact] = set()
        for effect in action.effects:
            changed = added if effect.adds else deleted
            for full in self._bindings(
                effect.parameters, self._where(effect.condition, True), binding
            ):
                if self.holds(effect.condition, full):
                    changed.add(substituted(effect.atom, full))
        return (state - deleted) | added
