"""A relation of one's own, `upright`: the cupboard's domain with it and with actions that ask for it, and a scene."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

import tamp
from tamp.geometric.scene.pose import Array

PREDICATES = """
    (maybe-stood ?o - movable ?p - pose ?s - surface)
    (stood ?o - movable ?p - pose ?s - surface)
    (upright ?o - movable ?s - surface)
    (untidy ?s - surface)
    (drunk ?o - movable) (mopped ?o - movable) (praised ?o - movable) (looked)
"""

RULES = """
  (:derived (upright ?o - movable ?s - surface)
    (exists (?p - pose) (and (stood ?o ?p ?s) (at-pose ?o ?p))))
  (:derived (untidy ?s - surface)
    (exists (?o - movable) (and (on ?o ?s) (not (upright ?o ?s)))))
"""

ACTIONS = """
  (:action drink
    :parameters (?o - movable ?s - surface)
    :precondition (and (hand-empty) (upright ?o ?s))
    :effect (and (drunk ?o) (increase (total-cost) 1)))
  (:action mop
    :parameters (?o - movable ?s - surface)
    :precondition (and (hand-empty) (not (upright ?o ?s)))
    :effect (and (mopped ?o) (increase (total-cost) 1)))
  (:action look
    :parameters (?o - movable ?s - surface)
    :precondition (hand-empty)
    :effect (and (looked) (when (upright ?o ?s) (praised ?o)) (increase (total-cost) 1)))
"""

SAMPLED = """
  (:stream sample-upright
    :inputs (?o ?s) :domain (and (movable ?o) (surface ?s))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (stood ?o ?p ?s)))
"""

TESTED = """
  (:stream sample-upright
    :inputs (?o ?s) :domain (and (movable ?o) (surface ?s))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (maybe-stood ?o ?p ?s)))
  (:stream test-upright
    :inputs (?o ?p ?s) :domain (maybe-stood ?o ?p ?s)
    :certified (stood ?o ?p ?s))
"""

SCENE = """
domain: {domain}
robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.7], at: [1.6, 0, 0], yaw: 90 deg}}
  shelf: {{furniture: table, legs: false, size: [0.8, 0.4, 0.6], at: [-1.6, 0, 0], yaw: 90 deg}}
  milk: {{box: [0.06, 0.07, 0.2], on: table, at: [0.0, -0.1], rpy: [90 deg, 0, 0.4]}}
  Tea: {{box: [0.05, 0.06, 0.15], on: table, at: [0.3, 0]}}
goal: {goal}
"""

PYTHON = '''
"""Stands on the face that its own z points away from, on that surface."""
import numpy as np
import tamp


class Upright:
    def classify(self, scene, arguments):
        body, place = scene.bodies[arguments[0]], scene.surfaces[arguments[1]]
        x, y, z = (scene.world_pose(place).inverse() @ body.pose).position
        inside = abs(x) <= place.size[0] / 2 and abs(y) <= place.size[1] / 2 and 0.0 <= z <= 0.3
        return float(inside and body.pose.matrix[2, 2] > 0.99)

    def propose(self, scene, arguments, count, rng):
        T, height = scene.world_pose(scene.surfaces[arguments[1]]), scene.bodies[arguments[0]].parts[0].shape.size[2]
        at = [(rng.uniform(-0.25, 0.25), rng.uniform(-0.1, 0.1), height / 2) for _ in range(count)]
        return [T @ tamp.Pose(position) for position in at]


grounding = Upright()
'''


class Proposing:
    """The generator of `PYTHON` alone."""

    def __init__(self, grounding: object) -> None:
        self._grounding = grounding

    def propose(
        self, scene: tamp.Scene, arguments: Sequence[str], count: int, rng: np.random.Generator
    ) -> list[tamp.Pose]:
        return self._grounding.propose(scene, arguments, count, rng)  # type: ignore[attr-defined]


def write_domain(
    root: Path, folder: Path, streams: str = TESTED, *, name: str = "mine", actions: str = ACTIONS
) -> Path:
    """The domain and its streams in a folder."""
    domain = (root / "domains/cupboard.pddl").read_text()
    domain = domain.replace(
        "    (on ?o - body ?s - surface)\n", f"    (on ?o - body ?s - surface){PREDICATES}", 1
    )
    domain = domain.replace("  (:action move", f"{RULES}\n  (:action move", 1)
    domain = domain.rstrip()[:-1] + actions + ")\n"
    own = (root / "domains/cupboard.streams.pddl").read_text().rstrip()[:-1] + streams + ")\n"
    (folder / f"{name}.pddl").write_text(domain)
    (folder / f"{name}.streams.pddl").write_text(own)
    return folder / f"{name}.pddl"


def write_problem(
    folder: Path, goal: str, *, name: str = "mine", domain: str = "mine.pddl"
) -> Path:
    """The scene with a goal: tea stands on the table, milk lies there."""
    path = folder / f"{name}.yaml"
    path.write_text(SCENE.format(goal=goal, domain=domain))
    return path


def turned(T: Array, roll: float) -> Array:
    """A pose turned about its own x axis, radians."""
    c, s = np.cos(roll), np.sin(roll)
    return T @ np.array([[1, 0, 0, 0], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])
