"""Contradictions: classifiers that say otherwise of a pose in the plan's states than when drawn."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from tamp.geometric.scene.classifier import Classifier
from tamp.geometric.scene.pose import Pose
from tamp.planner.problem import Problem
from tamp.relations.observed import moved, observe
from tamp.symbolic.algorithms.cause import Cause, CauseKind, distinct_causes
from tamp.symbolic.algorithms.result import Result
from tamp.symbolic.pddl.relations import Relation
from tamp.symbolic.pddl.structs import Action, And, Domain, Fact

MAX_CONTRADICTIONS_TOLD = 3
"""Contradictions that are told."""


@dataclass(frozen=True)
class _StandingPoses:
    """The poses' names by the names of bodies that stand, after so many actions; PDDL's names."""

    number: int
    at: Mapping[str, str]


def contradictions(problem: Problem, result: Result) -> tuple[Cause, ...]:
    """List what classifiers say in a plan's states and said otherwise when its poses were drawn.

    One that looks at its arguments alone never does; one that looks at what is around them may.
    """
    if not problem.classifiers or not result.actions:
        return ()

    task = problem.stream_task.task
    found: list[Cause] = []
    for name, classifier in problem.classifiers.items():
        relation = problem.relations[name]
        for state in _states(task.domain, task.initial, result):
            last = state.number == len(result.actions)
            # Of other facts no condition need ask.
            stated = {*result.certified, *(task.initial if last else ())}
            for words in _otherwise(
                problem, relation, classifier, state, stated, result.objects.values
            ):
                text = (
                    f"after {state.number} actions ({' '.join((name, *words))}) is not what it "
                    f"was when its pose was drawn: the classifier of '{name}' looks at "
                    "bodies that it is not asked about"
                )
                objects = problem.stream_task.named(words)
                found.append(Cause(text, CauseKind.CONTRADICTED, objects))

    return distinct_causes(found)[:MAX_CONTRADICTIONS_TOLD]


def _states(domain: Domain, initial: Collection[Fact], result: Result) -> list[_StandingPoses]:
    """List the states after each action, as far as its effects say plainly where bodies stand."""
    at = {fact[1]: fact[2] for fact in initial if fact[0] == "at-pose" and len(fact) == 3}
    actions = {action.name: action for action in domain.actions}
    states: list[_StandingPoses] = []
    for number, ground in enumerate(result.actions, 1):
        at = _after(actions[ground.name], ground.arguments, at)
        states.append(_StandingPoses(number, at))
    return states


def _after(action: Action, arguments: tuple[str, ...], at: Mapping[str, str]) -> dict[str, str]:
    table = dict(zip((one.name for one in action.parameters), arguments, strict=True))
    after = dict(at)
    plain = [
        one
        for one in action.effects
        if one.atom.predicate == "at-pose" and one.condition == And(())
    ]
    for effect in sorted(plain, key=lambda one: one.adds):
        every = {one.name for one in effect.parameters}
        body, pose = (
            None if term in every else table.get(term, term) for term in effect.atom.terms
        )
        if not effect.adds:
            gone = [one for one in after if body in (None, one) and pose in (None, after[one])]
            for one in gone:
                del after[one]
        elif body is not None and pose is not None:
            after[body] = pose
    return after


def _otherwise(
    problem: Problem,
    relation: Relation,
    classifier: Classifier,
    state: _StandingPoses,
    stated: Collection[Fact],
    values: Mapping[str, object],
) -> list[tuple[str, ...]]:
    """List arguments of which the classifier says in a state what the plan's facts deny."""
    task, scene = problem.stream_task.task, problem.scene
    words = {name.lower(): name for name in scene.movable}
    poses = {
        words[body]: pose
        for body, name in state.at.items()
        if isinstance(pose := values[name], Pose)
    }

    held = [name for name in scene.movable if name not in poses]
    seen = observe(
        relation,
        classifier,
        moved(scene, poses, held),
        task.domain,
        task.objects,
        task.initial,
        state.at,
    )

    false = {
        one: next((other for other in problem.complements if other.rstrip("~") == f"not-{one}"), "")
        for one in relation.predicates
    }

    wrong = [fact for fact in seen.fails if fact in stated]
    wrong += [fact for fact in seen.holds if (false[fact[0]], *fact[1:]) in stated]

    first = relation.facts[0]
    places = [1 + first.terms.index(variable) for variable in relation.arguments]
    return sorted(
        {tuple(fact[place] for place in places) for fact in wrong if fact[0] == first.predicate}
    )
