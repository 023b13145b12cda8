"""The initial state of a scene in symbols: objects, facts, values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from tamp.geometric.scene.scene import Body, Scene
from tamp.geometric.values import BaseConf, Grasp
from tamp.symbolic.pddl.structs import Domain, Fact

START_BASE = "base_start"

ARM = "arm"
"""Type, or predicate, of the robot's arms."""

STACKED = "stacked"
"""(stacked ?o ?p ?surface ?below ?pb): ?o at ?p stands on a surface of ?below, which is at ?pb."""


@dataclass
class InitialState:
    """Objects by name with types, initial facts, values behind names. PDDL names are lower case."""

    objects: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    facts: set[Fact] = field(default_factory=set[Fact])
    values: dict[str, Any] = field(default_factory=dict[str, Any])


def initial_state(
    scene: Scene, domain: Domain, holding: Grasp | None = None, arms: Sequence[str] = ()
) -> InitialState:
    """Say the scene in the words of the domain.

    Facts of predicates that the domain does not declare are left out. Where it declares a predicate
    `movable`, `fixed`, `surface` or `container` instead of a type of that name, the fact takes the
    type's place.

    Args:
        scene: The scene.
        domain: The domain.
        holding: What is in the hand; that body is nowhere else.
        arms: Names of the robot's arms, for a domain that has them.
    """
    state = InitialState()
    for name, body in scene.bodies.items():
        _object(state, domain, name, "movable" if body.movable else "fixed")
    for name in scene.surfaces:
        _object(state, domain, name, "surface")
    for name in scene.cavities:
        _object(state, domain, name, "container")

    has_arms = declares_arms(domain)
    for arm in arms if has_arms else ():
        _object(state, domain, arm, ARM)

    start = _value(state, domain, START_BASE, "base-conf", BaseConf(*scene.robot.base))
    facts: list[Fact] = [("at-base", start), ("standing", start)]
    if has_arms:
        facts += [("hand-empty", arm) for arm in arms]
    elif holding is None:
        facts.append(("hand-empty",))
    else:
        held = holding.body.lower()
        grasp = _value(state, domain, f"{held}_held", "grasp", holding)
        facts += [("grasp", held, grasp), ("holding", held, grasp)]

    placed = [name for name in scene.movable if holding is None or name != holding.body]
    poses = {
        name: _value(state, domain, f"{name.lower()}_start", "pose", scene.bodies[name].pose)
        for name in placed
    }
    for name, pose in poses.items():
        word = name.lower()
        facts += [("pose", word, pose), ("at-pose", word, pose)]
        facts += _support_facts(scene, scene.bodies[name], poses, STACKED in domain.predicates)

    state.facts.update(fact for fact in facts if _fits(domain, fact))
    return state


def declares_arms(domain: Domain) -> bool:
    """Tell whether a domain has arms as objects."""
    return ARM in domain.types or _fits(domain, (ARM, ""))


def _support_facts(scene: Scene, body: Body, poses: Mapping[str, str], carries: bool) -> list[Fact]:
    """Say what a body rests on at its start: places, and bodies that move.

    Args:
        scene: The scene.
        body: One of its movable bodies.
        poses: The names of the start poses of those that stand.
        carries: Whether a place of a body that moves is one of that body's pose, in a fact of its
            own.
    """
    word, pose, facts = body.name.lower(), poses[body.name], list[Fact]()
    below = body.support or ""
    place = scene.surfaces.get(below) or scene.cavities.get(below)
    under = dict.fromkeys((below if place is None else place.body, *body.carriers))
    carriers = [name for name in under if name in scene.bodies and scene.bodies[name].movable]

    if place is not None and not (carries and place.body in carriers):
        predicate = "supported" if below in scene.surfaces else "contained"
        facts.append((predicate, word, pose, below.lower()))
    for name in carriers:
        facts.append(("rests-on", word, pose, name.lower()))
        if name in poses:
            there = (name.lower(), poses[name])
            facts.append(("borne", word, pose, *there))
            if place is not None and place.body == name:
                predicate = STACKED if below in scene.surfaces else "packed"
                facts.append((predicate, word, pose, below.lower(), *there))
    facts.append(("sampled", word, pose))
    if not carriers:
        facts.append(("grounded", word, pose))
    return facts


def _object(state: InitialState, domain: Domain, name: str, kind: str) -> None:
    word = name.lower()
    state.values[word] = name
    types = (kind,) if kind in domain.types else ()
    state.objects[word] = (*state.objects.get(word, ()), *types)
    for predicate in (kind, "body"):
        if (predicate == kind or kind in ("movable", "fixed")) and _fits(domain, (predicate, word)):
            state.facts.add((predicate, word))


def _value(state: InitialState, domain: Domain, name: str, type_: str, value: Any) -> str:
    """Name a start value; a body that has its name already keeps it."""
    while name in state.objects or name in domain.constants:
        name += "_"
    state.objects[name] = (type_,) if type_ in domain.types else ("object",)
    state.values[name] = value
    return name


def _fits(domain: Domain, fact: Fact) -> bool:
    predicate = domain.predicates.get(fact[0])
    return predicate is not None and len(predicate.parameters) == len(fact) - 1
