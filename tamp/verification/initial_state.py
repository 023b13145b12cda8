"""The initial state, worked out from the scene and compared with what the plan says of it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from tamp.geometric.scene.pose import base_difference, pose_difference
from tamp.geometric.scene.scene import Body, Scene
from tamp.plan.read import PlanFile
from tamp.plan.violation import Violation
from tamp.symbolic.pddl.structs import Domain, Fact

FLUENT_ARITY = {"at-pose": 2, "holding": 2, "hand-empty": 0, "at-base": 1, "riding": 4}
"""Fluents whose geometric meaning we know."""
OF_AN_ARM = frozenset({"holding", "hand-empty"})
"""Those of them that may be of one of several arms, which comes first then."""
KINDS_OF_OBJECTS = frozenset({"body", "movable", "fixed", "surface", "container", "arm"})
"""Types that the scene decides about."""
START_TOLERANCE = 1e-6
"""Metres or radians by which a start in the plan may differ from the problem's."""


def has_standard_meaning(domain: Domain, predicate: str) -> bool:
    """Tell whether the domain's predicate is the fluent of that name whose meaning we know."""
    declared = domain.predicates.get(predicate)
    if declared is None:
        return False
    more = len(declared.parameters) - FLUENT_ARITY[predicate]
    return more == 0 or (more == 1 and predicate in OF_AN_ARM)


def check_objects(
    plan: PlanFile, scene: Scene, domain: Domain, arms: Sequence[str]
) -> Iterator[Violation]:
    """Check that the plan's objects are the scene's and the robot's arms, and what it says of them
    is so.
    """
    bodies = {name.lower(): body for name, body in scene.bodies.items()}
    places = {name.lower() for name in (*scene.surfaces, *scene.cavities)}
    for name, types in plan.objects.items():
        value = plan.values.get(name)
        if value is not None and types in ((value.type,), ("object",)):
            continue
        if name not in {*bodies, *places, *arms, *domain.constants}:
            yield Violation("initial", f"the problem has no '{name}'", bodies=(name,))
            continue
        truths = kinds_of(scene, name) | ({"arm"} if name in arms else set())
        for type_ in types:
            if type_ in KINDS_OF_OBJECTS and type_ not in truths:
                yield Violation("initial", f"'{name}' is not {type_}", bodies=(name,))
    for name, body in bodies.items():
        if body.movable and name not in plan.objects:
            yield Violation(
                "initial", f"the body '{name}' is missing among the objects", bodies=(name,)
            )


def check_initial(
    plan: PlanFile, scene: Scene, domain: Domain, given: frozenset[Fact], static: set[str],
    arms: Sequence[str],
) -> Iterator[Violation]:  # fmt: skip
    """Check that the plan's initial facts are those that the scene and the problem's `init` imply.

    Args:
        plan: The plan.
        scene: The problem's.
        domain: The domain.
        given: The problem's own initial facts.
        static: Predicates that are verified as certified facts, and may stand among the initial
            ones.
        arms: Names of the robot's arms.
    """
    facts = set(plan.initial)
    for fact in sorted(given - facts):
        yield Violation("initial", f"({' '.join(fact)}) of the problem's init is missing")

    bodies = {name.lower(): scene.bodies[name] for name in scene.movable}
    placed: list[str] = []

    for fact in plan.initial:
        predicate, *terms = fact
        text = f"({' '.join(fact)})"
        standard = predicate in FLUENT_ARITY and has_standard_meaning(domain, predicate)
        if standard and len(terms) != len(domain.predicates[predicate].parameters):
            yield Violation("initial", f"{text} has a wrong number of arguments")
        elif (
            fact in given
            or (not standard and predicate in static)
            or _is_kind(fact, plan, scene, domain)
            or (predicate == "arm" and tuple(terms) in {(arm,) for arm in arms})
        ):
            continue
        elif standard and predicate == "at-pose" and terms[0] in bodies:
            placed.append(terms[0])
            value = plan.values.get(terms[1])
            if value is None or value.type != "pose":
                yield Violation(
                    "initial", f"{text}: '{terms[1]}' is not a pose", bodies=(terms[0],)
                )
            else:
                moved, turned = pose_difference(value.data, bodies[terms[0]].pose.matrix)
                if moved > START_TOLERANCE or turned > 1e-4:
                    off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg"
                    message = f"{text}: {terms[0]} starts {off} from there"
                    yield Violation("initial", message, bodies=(terms[0],), depth=moved)
        elif standard and predicate == "at-base":
            value = plan.values.get(terms[0])
            if value is None or value.type != "base-conf":
                yield Violation("initial", f"{text}: '{terms[0]}' is not a base-conf")
            elif base_difference(value.data, np.array(scene.robot.base)) > START_TOLERANCE:
                yield Violation("initial", f"{text}: the base starts elsewhere")
        elif not (standard and predicate == "hand-empty"):
            yield Violation("initial", f"the problem does not imply {text}")

    if has_standard_meaning(domain, "at-pose"):
        for name in bodies:
            if placed.count(name) != 1:
                yield Violation(
                    "initial",
                    f"'{name}' has {placed.count(name)} poses at the start",
                    bodies=(name,),
                )

    for predicate in ("hand-empty", "at-base"):
        if not has_standard_meaning(domain, predicate):
            continue
        stated = {fact[1:] for fact in facts if fact[0] == predicate}
        by_arm = len(domain.predicates[predicate].parameters) > FLUENT_ARITY[predicate]
        if by_arm and stated != {(arm,) for arm in arms}:
            yield Violation("initial", f"{predicate} does not hold of each arm once at the start")
        elif not by_arm and len(stated) != 1:
            yield Violation("initial", f"{predicate} holds {len(stated)} times at the start")


def kinds_of(scene: Scene, name: str) -> set[str]:
    """List the kinds that the scene says an object is of."""
    kinds: set[str] = set()
    for body in scene.bodies.values():
        if body.name.lower() == name:
            kinds |= {"body", "movable" if body.movable else "fixed"}
            if has_top(body):
                kinds.add("surface")
    if name in {surface.lower() for surface in scene.surfaces}:
        kinds.add("surface")
    if name in {cavity.lower() for cavity in scene.cavities}:
        kinds.add("container")
    return kinds


def has_top(body: Body) -> bool:
    """Tell whether a body's top may be a surface of its own name: what is on it rests on the
    body.
    """
    return body.movable and not (body.surfaces or body.cavities or body.bare)


def owner_of(scene: Scene, place: str) -> Body | None:
    """Return the body that has a surface or a cavity of this PDDL name, or a top."""
    places = (*scene.surfaces.values(), *scene.cavities.values())
    owners = {one.name.lower(): one.body for one in places}
    tops = {name.lower(): name for name, body in scene.bodies.items() if has_top(body)}
    name = owners.get(place) or tops.get(place)
    return None if name is None else scene.bodies[name]


def _is_kind(fact: Fact, plan: PlanFile, scene: Scene, domain: Domain) -> bool:
    """Tell whether a fact says of an object only what it is."""
    if len(fact) != 2:
        return False
    declared = fact[0] in domain.types and fact[0] in plan.objects.get(fact[1], ())
    return declared or fact[0] in kinds_of(scene, fact[1])
