"""Evaluation of the goal in what is seen."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence

from tamp.errors import InputError
from tamp.execution.deviation import MAX_DISPLACEMENT_M, MAX_TURN_RAD
from tamp.execution.expected import COMPARED_RELATIONS, Expected
from tamp.execution.observation import ObservedScene
from tamp.execution.relations import Own
from tamp.execution.report import GoalFact
from tamp.geometric.samplers.choice import Registry
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.geometric.samplers.sampler import Classifier
from tamp.geometric.scene.classifier import Unanswered, probability
from tamp.geometric.scene.pose import pose_difference
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.relations import POSE
from tamp.symbolic.pddl.structs import Atom, Formula, Not
from tamp.verification.formulas import flat
from tamp.verification.semantics import Semantics, State

NO_RELATIONS = Own({})

SEEN_FLUENTS = frozenset({"holding", "hand-empty", "at-pose"})
"""Facts that are seen and not believed."""


def judged(
    goal: Formula,
    expected: Expected,
    truth: ObservedScene,
    hands: Mapping[str, str | None],
    classifiers: Mapping[str, tuple[str, Classifier]],
    own: Own = NO_RELATIONS,
) -> tuple[GoalFact, ...]:
    """Evaluate each part of the goal, by the geometry; and what the classifiers of its relations
    say. `hands`: the body in each hand, by the names of the arms.

    Classifiers of the user's own relations decide about these. Others than them, `on` and `inside`
    hold as the plan has them for bodies that are where the plan put them.
    """
    facts = {
        (name, *row)
        for name, rows in expected.state.facts.items()
        for row in rows
        if name not in SEEN_FLUENTS
    }
    facts |= set(_of_hands(expected, hands))
    held = [body for body in hands.values() if body is not None]
    there = dict(_in_place(expected, truth, held))
    placed = [name.lower() for name in truth.scene.movable if name not in held] if own.asked else []
    at = {body: f"{body} seen" for body in placed} | there
    facts |= {("at-pose", body, pose) for body, pose in at.items()}
    for seen in own.observe(truth, next(iter(held), None), expected, at).values():
        facts = (facts - seen.fails) | seen.holds

    state = State.of(facts | truth.facts)
    semantics = _with_poses(expected.semantics, at).without(COMPARED_RELATIONS)
    said = {
        **classifiers,
        **{name: (called, classifier) for name, (_, called, classifier) in own.asked.items()},
    }

    found: list[GoalFact] = []
    for part in flat(goal):
        holds = semantics.holds(part, state)
        name, probability = _classified(part, truth, held, said)
        why = None if holds else _reason(part, truth, held) or _moved(part, there, expected, own)
        found.append(GoalFact(to_text(part), holds, why, name, probability))
    return tuple(found)


def _of_hands(expected: Expected, hands: Mapping[str, str | None]) -> Iterator[tuple[str, ...]]:
    """Yield the facts of which hand is empty and which holds what, with the arm first in a domain
    that has arms.
    """
    held = {arm: body.lower() for arm, body in hands.items() if body is not None}
    if not held:
        yield ("hand-empty",)
    for arm in hands.keys() - held.keys():
        yield ("hand-empty", arm)
    for fact in expected.state.facts.get("holding", set()):
        first, *rest = fact
        if first in held.values() or (first in held and held[first] in rest):
            yield ("holding", *fact)


def classifiers_of(registry: Registry) -> dict[str, tuple[str, Classifier]]:
    """Load, for each relation, the name and the object of the first learned classifier whose
    weights are there.
    """
    found: dict[str, tuple[str, Classifier]] = {}
    for relation, makers in registry.items():
        if relation not in SAMPLERS:
            continue  # a relation of the user's own has the classifier that the plan names
        for name, make in makers.items():
            classifier = _made(make)
            if classifier is not None:
                found[relation] = name, classifier
                break
    return found


def _made(make: Callable[[], object]) -> Classifier | None:
    try:
        made = make()
    except InputError:  # no weights
        return None
    return made if isinstance(made, Classifier) else None


def _classified(
    part: Formula,
    truth: ObservedScene,
    held: Sequence[str],
    classifiers: Mapping[str, tuple[str, Classifier]],
) -> tuple[str | None, float | None]:
    if isinstance(part, Not):
        part = part.body
    if not isinstance(part, Atom) or part.predicate not in classifiers:
        return None, None
    name, classifier = classifiers[part.predicate]
    scene = truth.scene
    names = {one.lower(): one for one in (*scene.bodies, *scene.surfaces, *scene.cavities)}
    if not all(term in names and names[term] not in held for term in part.terms):
        return None, None
    try:
        number = probability(classifier, scene, [names[term] for term in part.terms])
    except Unanswered:
        return None, None
    return (None, None) if math.isnan(number) else (name, number)


def _with_poses(semantics: Semantics, at: Mapping[str, str]) -> Semantics:
    """Bind names for the poses that bodies are seen at."""
    domain = semantics.domain
    kind = POSE if POSE in domain.types else "object"
    new = {pose: (kind,) for pose in at.values() if pose not in semantics.objects}
    return Semantics(domain, {**semantics.objects, **new}) if new else semantics


def _in_place(
    expected: Expected, truth: ObservedScene, held: Sequence[str]
) -> Iterator[tuple[str, str]]:
    """Yield the bodies and poses, in PDDL's names, of those that are seen where the plan has
    them.
    """
    bodies = {name.lower(): name for name in truth.scene.movable if name not in held}
    for terms in expected.state.all("at-pose"):
        value = expected.plan.values.get(terms[-1])
        if len(terms) != 2 or terms[0] not in bodies or value is None or value.type != "pose":
            continue
        moved, turned = pose_difference(
            value.data, truth.scene.bodies[bodies[terms[0]]].pose.matrix
        )
        if moved < MAX_DISPLACEMENT_M and turned < MAX_TURN_RAD:
            yield terms[0], terms[1]


def _moved(part: Formula, there: Mapping[str, str], expected: Expected, own: Own) -> str | None:
    """Describe a body of a relation of the user's own that is elsewhere than the plan has it, where
    no classifier decides.
    """
    if (
        not isinstance(part, Atom)
        or part.predicate in COMPARED_RELATIONS
        or part.predicate in own.asked
    ):
        return None
    placed = {terms[0] for terms in expected.state.all("at-pose")}
    gone = [body for body in part.terms if body in placed - there.keys()]
    return f"{gone[0]} is not where the plan put it" if gone else None


def _reason(part: Formula, truth: ObservedScene, held: Sequence[str]) -> str | None:
    if not isinstance(part, Atom) or not part.terms:
        return None
    body = part.terms[0]
    if body in {name.lower() for name in held}:
        return "it is in the hand"
    if body not in {name.lower() for name in truth.scene.bodies}:
        return "it is gone"
    return truth.reasons.get((part.predicate, *part.terms))
