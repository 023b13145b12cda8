"""Domains of one's own: a new relation with a grounding, and an untyped domain as written for PDDLStream."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tamp
from tamp.verification.verify import verify

NEAR = """
  (:derived (near ?o - movable ?other - fixed)
    (exists (?p - pose) (and (near-pose ?o ?p ?other) (at-pose ?o ?p))))
"""

SAMPLE_NEAR = """
  (:stream sample-near
    :inputs (?o ?other) :domain (and (movable ?o) (fixed ?other))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (proposed ?o ?p ?other)))
  (:stream test-near
    :inputs (?o ?p ?other) :domain (proposed ?o ?p ?other)
    :certified (near-pose ?o ?p ?other))
"""

PROBLEM = """
domain: {domain}
robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}}
  cupboard: {{furniture: cupboard, size: [0.9, 0.42, 0.75], at: [-1.6, 0.4, 0.0], yaw: 90 deg}}
  lamp: {{cylinder: {{radius: 0.04, height: 0.3}}, on: cupboard_top, fixed: true, surfaces: {{}}}}
  can: {{cylinder: {{radius: 0.033, height: 0.102}}, on: table, at: [0.1, 0.1]}}
goal: {goal}
"""


class Near:
    """Within 20 cm of another body, at its height."""

    def classify(self, scene: tamp.Scene, arguments: Sequence[str]) -> float:
        first, second = (np.array(scene.bodies[name].pose.position) for name in arguments)
        return float(np.linalg.norm((first - second)[:2]) < 0.2)

    def propose(
        self, scene: tamp.Scene, arguments: Sequence[str], count: int, rng: np.random.Generator
    ) -> list[tamp.Pose]:
        body, other = (scene.bodies[name] for name in arguments)
        x, y, z = other.pose.position
        spots = rng.uniform(-0.3, 0.3, (count, 2))
        return [
            tamp.Pose((x + dx, y + dy, z - 0.15 + 0.051), body.pose.quaternion) for dx, dy in spots
        ]


def near_domain(root: Path, folder: Path) -> Path:
    domain = (root / "domains/cupboard.pddl").read_text()
    domain = domain.replace("(:functions", "  (:functions", 1)
    domain = domain.replace(
        "    (on ?o - body ?s - surface)\n",
        "    (on ?o - body ?s - surface)\n    (near ?o - movable ?other - fixed)\n"
        "    (near-pose ?o - movable ?p - pose ?other - fixed) (proposed ?o - movable ?p - pose ?other - fixed)\n",
        1,
    )
    domain = domain.replace("  (:action move", NEAR + "  (:action move", 1)
    streams = (root / "domains/cupboard.streams.pddl").read_text()
    (folder / "mine.pddl").write_text(domain)
    (folder / "mine.streams.pddl").write_text(streams.rstrip()[:-1] + SAMPLE_NEAR + ")\n")
    problem = folder / "mine.yaml"
    problem.write_text(PROBLEM.format(domain="mine.pddl", goal="(near can lamp)"))
    return problem


def test_a_relation_of_ones_own(root: Path, tmp_path: Path) -> None:
    problem = tamp.load_problem(near_domain(root, tmp_path), groundings={"near": Near()})
    solution = tamp.solve(problem, max_time=30.0, seed=0)
    assert solution.solved
    (placed,) = [action for action in solution.plan if action.name == "place"]
    pose = next(
        value
        for name in placed.arguments
        if isinstance(value := solution.values.get(name), tamp.Pose)
    )
    lamp = problem.scene.bodies["lamp"].pose.position
    assert np.hypot(pose.position[0] - lamp[0], pose.position[1] - lamp[1]) < 0.2
    report = verify(tamp.write_plan(solution, tmp_path / "plan.json"))
    assert report.holds, report.violations


def test_a_relation_without_a_grounding_is_an_error(root: Path, tmp_path: Path) -> None:
    with pytest.raises(tamp.InputError, match="sample-near"):
        tamp.load_problem(near_domain(root, tmp_path))


def test_an_untyped_domain(root: Path, tmp_path: Path) -> None:
    """The cupboard with predicates in the place of types: (movable ?o) instead of ?o - movable."""
    domain = (root / "domains/cupboard.pddl").read_text()
    domain = re.sub(r";[^\n]*", "", domain)
    domain = re.sub(r"\(:types.*?object\)\s*\(:predicates", "(:predicates", domain, flags=re.DOTALL)
    domain = re.sub(r"\s+-\s+[a-z-]+", "", domain)
    domain = domain.replace(
        "(:predicates", "(:predicates (movable ?o) (fixed ?o) (body ?o) (surface ?s) (container ?c)"
    )
    domain = domain.replace(":typing ", "")
    assert " - " not in domain
    (tmp_path / "plain.pddl").write_text(domain)
    (tmp_path / "plain.streams.pddl").write_text(
        (root / "domains/cupboard.streams.pddl").read_text()
    )
    path = tmp_path / "plain.yaml"
    path.write_text(PROBLEM.format(domain="plain.pddl", goal="(on can cupboard_top)"))
    solution = tamp.solve(tamp.load_problem(path), max_time=30.0, seed=0)
    assert solution.solved
    report = verify(tamp.write_plan(solution, tmp_path / "plan.json"))
    assert report.holds, report.violations


def test_a_cost_that_python_computes(root: Path, tmp_path: Path) -> None:
    domain = (root / "domains/cupboard.pddl").read_text()
    domain = domain.replace(
        "(:functions (total-cost))", "(:functions (total-cost) (effort ?b - base-conf))"
    )
    domain = domain.replace(
        "(at-base ?b)\n                 (increase (total-cost) 1)",
        "(at-base ?b) (increase (total-cost) (effort ?b))",
    )
    assert "(increase (total-cost) (effort ?b))" in domain
    (tmp_path / "dear.pddl").write_text(domain)
    streams = (root / "domains/cupboard.streams.pddl").read_text().rstrip().removesuffix(")")
    (tmp_path / "dear.streams.pddl").write_text(
        streams + "\n  (:function (effort ?b) (standing ?b)))"
    )
    path = tmp_path / "dear.yaml"
    path.write_text(PROBLEM.format(domain="dear.pddl", goal="(on can cupboard_top)"))
    problem = tamp.load_problem(
        path, functions={"effort": lambda context, base: 3.0 + 0.5 * abs(base.array[0])}
    )
    assert problem.warnings == ()
    solution = tamp.solve(problem, max_time=30.0, seed=0)
    assert solution.solved
    moves = [action for action in solution.plan if action.name == "move"]
    bases: list[Any] = [solution.values[action.arguments[0]] for action in moves]
    assert [action.cost for action in moves] == [3.0 + 0.5 * abs(base.array[0]) for base in bases]
    (tmp_path / "dear.streams.pddl").write_text(
        streams + "\n  (:predicate (hot ?b) (standing ?b)))"
    )
    (tmp_path / "dear.pddl").write_text(
        domain.replace("(hand-empty)", "(hand-empty) (hot ?b - base-conf)", 1)
    )
    with pytest.raises(tamp.InputError, match="'hot' is a :predicate, which scenes do not have"):
        tamp.load_problem(path)
