"""The initial state of a scene in symbols: objects, facts, values."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tamp.geometric.scene.scene import Scene
from tamp.geometric.values import BaseConf, Grasp
from tamp.symbolic.pddl.structs import Domain, Fact

START_BASE = "base_start"


@dataclass
class InitialState:
    """Objects by name with types, initial facts, values behind names. PDDL names are lower case."""

    objects: dict[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    facts: set[Fact] = field(default_factory=set[Fact])
    values: dict[str, Any] = field(default_factory=dict[str, Any])


def initial_state(scene: Scene, domain: Domain, holding: Grasp | None = None) -> InitialState:
    """Say the scene in the words of the domain.

    Facts of predicates that the domain does not declare are left out. Where it declares a predicate
    `movable`, `fixed`, `surface` or `container` instead of a type of that name, the fact takes the
    type's place.

    Args:
        scene: The scene.
        domain: The domain.
        holding: What is in the hand; that body is nowhere else.
    """
    state = InitialState()
    for name, body in scene.bodies.items():
        _object(state, domain, name, "movable" if body.movable else "fixed")
    for name in scene.surfaces:
        _object(state, domain, name, "surface")
    for name in scene.cavities:
        _object(state, domain, name, "container")

    start = _value(state, domain, START_BASE, "base-conf", BaseConf(*scene.robot.base))
    facts: list[Fact] = [("at-base", start), ("standing", start)]
    if holding is None:
        facts.append(("hand-empty",))
    else:
        held = holding.body.lower()
        grasp = _value(state, domain, f"{held}_held", "grasp", holding)
        facts += [("grasp", held, grasp), ("holding", held, grasp)]

    for name in scene.movable:
        if holding is not None and name == holding.body:
            continue
        body = scene.bodies[name]
        word = name.lower()
        pose = _value(state, domain, f"{word}_start", "pose", body.pose)
        facts += [("pose", word, pose), ("at-pose", word, pose)]

        below = body.support or ""
        if below in scene.surfaces:
            facts.append(("supported", word, pose, below.lower()))
        if below in scene.cavities:
            facts.append(("contained", word, pose, below.lower()))

        carriers = (
            scene.surfaces[below].body if below in scene.surfaces else below,
            *body.carriers,
        )
        facts += [
            ("rests-on", word, pose, carrier.lower())
            for carrier in dict.fromkeys(carriers)
            if carrier in scene.bodies and scene.bodies[carrier].movable
        ]

    state.facts.update(fact for fact in facts if _fits(domain, fact))
    return state


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
