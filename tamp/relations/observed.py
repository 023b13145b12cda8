"""Ask classifiers about the relations of a scene: alike in planning, execution and judging.

A classifier is what the user means by a relation, whether written or learned; it is no part of the
planner. Whoever asks brings a scene of its own reading: the planner its poses, execution what it
sees, the judge the physics engine's.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

from tamp.errors import InputError
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY, Classifier, Unanswered, probability
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.symbolic.pddl.relations import Relation, instances
from tamp.symbolic.pddl.structs import Domain, Fact


@dataclass(frozen=True)
class ClassifierAnswers:
    """The answers of a classifier about a relation.

    Attributes:
        holds: Facts that hold.
        fails: Facts that do not hold.
        unanswered: Why it did not answer, by the relation's arguments.
        answers: The probabilities, by the relation's arguments; PDDL's names.
    """

    holds: frozenset[Fact] = frozenset()
    fails: frozenset[Fact] = frozenset()
    unanswered: Mapping[tuple[str, ...], str] = field(default_factory=dict[tuple[str, ...], str])
    answers: Mapping[tuple[str, ...], float] = field(default_factory=dict[tuple[str, ...], float])


def observe(
    relation: Relation,
    classifier: Classifier,
    scene: Scene,
    domain: Domain,
    objects: Mapping[str, tuple[str, ...]],
    facts: Collection[Fact],
    at: Mapping[str, str],
) -> ClassifierAnswers:
    """Ask a classifier of everything in a scene that its relation may be about.

    Args:
        relation: The relation.
        classifier: Its classifier.
        scene: Bodies where they are.
        domain: Of the relation.
        objects: Types by PDDL name.
        facts: What is known of objects.
        at: The poses' names, by the PDDL names of bodies that stand somewhere.
    """
    names = scene_names(scene)
    holds: set[Fact] = set()
    fails: set[Fact] = set()
    unanswered: dict[tuple[str, ...], str] = {}
    answers: dict[tuple[str, ...], float] = {}
    for bound in instances(relation, domain, objects, facts, at, names):
        words = tuple(bound[variable] for variable in relation.arguments)
        try:
            answers[words] = probability(classifier, scene, [names[word] for word in words])
        except Unanswered as error:
            unanswered[words] = str(error)
            continue
        if not math.isnan(answers[words]):
            (holds if answers[words] >= LIKELY_PROBABILITY else fails).update(
                relation.substitute(bound, at)
            )
    return ClassifierAnswers(frozenset(holds), frozenset(fails), unanswered, answers)


def scene_names(scene: Scene) -> dict[str, str]:
    """Map PDDL names, which are lower case, to the scene's names of bodies and places."""
    return {name.lower(): name for name in (*scene.bodies, *scene.surfaces, *scene.cavities)}


def moved(scene: Scene, poses: Mapping[str, Pose], absent: Collection[str] = ()) -> Scene:
    """Move bodies of a scene to poses T_world_body, by name; those in hands are taken out."""
    bodies = {
        name: replace(body, pose=poses[name]) if name in poses else body
        for name, body in scene.bodies.items()
        if name not in absent
    }
    return replace(scene, bodies=bodies)


def refuse_silent(relation: str, seen: ClassifierAnswers) -> None:
    """Refuse a classifier that answered nothing that it was asked.

    Raises:
        InputError: With what it was asked and what happened.
    """
    if seen.unanswered and not seen.answers:
        words, why = next(iter(seen.unanswered.items()))
        raise InputError(
            f"the classifier of '{relation}' does not work: "
            f"asked of ({' '.join((relation, *words))}), {why}",
            remedy="classify(scene, arguments) returns the probability that the relation holds, "
            "or nan",
        )
