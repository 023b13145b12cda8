"""Facts that stay for good and keep actions from being taken: "can stays loaded with crate"."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.atoms import necessary_atoms
from tamp.symbolic.pddl.structs import And, Atom, Fact, Formula, Not
from tamp.symbolic.search.lasting import forbidden_by, lasting
from tamp.symbolic.search.operators import InstantiatedTask, Operator

MAX_CALLS_NAMED = 2
"""Calls that are named as the reason why a thing stays where it is."""


def kept_from(
    problem: StreamTask,
    instantiated: InstantiatedTask,
    calls: Sequence[tuple[frozenset[str], Cause]],
    goal: Iterable[str],
) -> Iterator[Cause]:
    """Yield the actions about the goal's objects that are forbidden for good: by what, and why.

    Args:
        problem: The task, whose rules say what a fact means.
        instantiated: The optimistic task.
        calls: The calls that ended without a value: the objects that each is about, and the cause.
        goal: Its terms.
    """
    wanted = set(goal)
    for_good = lasting(instantiated).forbidden
    for operator, facts in for_good or forbidden_by(instantiated, instantiated.initial):
        about = [word for word in operator.arguments if word in wanted]
        if not about:
            continue

        for fact in sorted(facts):
            others = [
                word
                for word in fact[1:]
                if isinstance(problem.values.get(word), str) and word not in about
            ]
            reasons = [cause for names, cause in calls if not names.isdisjoint(others)]
            named = reasons[:MAX_CALLS_NAMED]
            because = f" ({', '.join(cause.text for cause in named)})" if named else ""
            objects = problem.named(
                (*about, *fact[1:], *(name for cause in named for name in cause.objects))
            )
            state = _state(problem, operator, fact)
            if not for_good and (state is None or not others or not reasons):
                continue  # it may be only for now

            if state is None:
                absent = f"{operator.name} wants ({' '.join(fact)}) not to hold"
                said = f"{absent}, which nothing makes false{because}"
                yield Cause(said, CauseKind.FORBIDDEN, objects)
                continue

            things = " ".join(
                word for word in state[1:] if isinstance(problem.values.get(word), str)
            )
            with_others = f" with {' and '.join(others)}" if others else ""
            never = f", so that {operator.name} is never possible" if for_good else ""
            stays = "stays" if for_good else "is"
            said = f"{things} {stays} {state[0]}{with_others}{never}{because}"
            yield Cause(said, CauseKind.FORBIDDEN, problem.named((*objects, *state[1:])))


def _state(problem: StreamTask, operator: Operator, fact: Fact) -> Fact | None:
    """Find the derived fact that the operator wants not to hold, which a fluent one makes hold."""
    domain = problem.task.domain
    for action in domain.actions:
        if action.name != operator.name:
            continue
        given = dict(
            zip(
                (parameter.name for parameter in action.parameters),
                operator.arguments,
                strict=False,
            )
        )

        for atom in _unwanted(action.precondition):
            head = (atom.predicate, *(given.get(term, term) for term in atom.terms))
            if head == fact:
                return None
            for rule in domain.derived:
                if rule.head.predicate == atom.predicate and _follows(
                    problem, rule.head, rule.body, head, fact
                ):
                    return head
    return None


def _unwanted(formula: Formula) -> Iterator[Atom]:
    if isinstance(formula, Not) and isinstance(formula.body, Atom):
        yield formula.body
    elif isinstance(formula, And):
        for part in formula.parts:
            yield from _unwanted(part)


def _follows(problem: StreamTask, rule_head: Atom, body: Formula, head: Fact, fact: Fact) -> bool:
    """Check that the rule derives the head from the fact, given what plainly holds at the start."""
    binding = dict(zip(rule_head.terms, head[1:], strict=False))
    atoms = necessary_atoms(body)
    for atom in atoms:
        if atom.predicate != fact[0]:
            continue
        grown = {**dict(zip(atom.terms, fact[1:], strict=False)), **binding}
        if (atom.predicate, *(grown.get(term, term) for term in atom.terms)) != fact:
            continue

        others = [
            tuple(grown.get(term, term) for term in other.terms)
            for other in atoms
            if other is not atom
        ]
        names = [other.predicate for other in atoms if other is not atom]
        if all(
            (name, *terms) in problem.task.initial
            for name, terms in zip(names, others, strict=True)
        ):
            return True
    return False
