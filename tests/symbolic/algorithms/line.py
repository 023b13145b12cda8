"""Pick and place on a line: blocks of width 1, regions that are intervals, an arm that is a point."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.result import Result, StreamTask
from tests.symbolic.algorithms.toys import stream_task

DOMAIN = """
(define (domain line)
  (:requirements :typing :equality :negative-preconditions :derived-predicates
                 :conditional-effects :universal-preconditions)
  (:types block region pose grasp conf)
  (:predicates
    (at ?b - block ?p - pose) (holding ?b - block ?g - grasp) (hand-free) (at-conf ?q - conf)
    (pose ?b - block ?p - pose) (supported ?b - block ?p - pose ?r - region)
    (grasp ?b - block ?g - grasp) (kin ?b - block ?p - pose ?g - grasp ?q - conf) (conf ?q - conf)
    (clear ?b - block ?p - pose ?b2 - block ?p2 - pose)
    (on ?b - block ?r - region) (blocked ?b - block ?p - pose))
  (:derived (on ?b - block ?r - region)
    (exists (?p - pose) (and (supported ?b ?p ?r) (at ?b ?p))))
  (:derived (blocked ?b - block ?p - pose)
    (exists (?b2 - block ?p2 - pose) (and (at ?b2 ?p2) (not (= ?b ?b2)) (not (clear ?b ?p ?b2 ?p2)))))
  (:action move
    :parameters (?q - conf)
    :precondition (conf ?q)
    :effect (and (forall (?from - conf) (when (at-conf ?from) (not (at-conf ?from)))) (at-conf ?q)))
  (:action pick
    :parameters (?b - block ?p - pose ?g - grasp ?q - conf)
    :precondition (and (kin ?b ?p ?g ?q) (hand-free) (at-conf ?q) (at ?b ?p))
    :effect (and (holding ?b ?g) (not (hand-free)) (not (at ?b ?p))))
  (:action place
    :parameters (?b - block ?p - pose ?g - grasp ?q - conf)
    :precondition (and (kin ?b ?p ?g ?q) (pose ?b ?p) (holding ?b ?g) (at-conf ?q) (not (blocked ?b ?p)))
    :effect (and (at ?b ?p) (hand-free) (not (holding ?b ?g)))))
"""

STREAMS = """
(define (stream line)
  (:stream sample-pose
    :inputs (?b ?r) :domain (and (block ?b) (region ?r))
    :outputs (?p) :certified (and (pose ?b ?p) (supported ?b ?p ?r)))
  (:stream sample-grasp
    :inputs (?b) :domain (block ?b)
    :outputs (?g) :certified (grasp ?b ?g))
  (:stream inverse-kin
    :inputs (?b ?p ?g) :domain (and (pose ?b ?p) (grasp ?b ?g))
    :outputs (?q) :certified (and (kin ?b ?p ?g ?q) (conf ?q)))
  (:stream test-clear
    :inputs (?b ?p ?b2 ?p2) :domain (and (pose ?b ?p) (pose ?b2 ?p2))
    :certified (clear ?b ?p ?b2 ?p2)))
"""


@dataclass
class Line:
    """A world on a line.

    Attributes:
        blocks: Where each block's middle is.
        regions: Lower and upper end; blocks lie wholly inside.
        reach: The arm's lower and upper end.
    """

    blocks: Mapping[str, float]
    regions: Mapping[str, tuple[float, float]]
    reach: tuple[float, float] = (-1.0, 1000.0)

    def problem(
        self, goal: str, *, domain: str = DOMAIN, facts: str = "", **functions: Any
    ) -> StreamTask:
        """The planning problem; `functions` stand in for those of this class, underscores for hyphens."""
        given = {name.replace("_", "-"): function for name, function in functions.items()}
        known = {
            "sample-pose": self.sample_pose,
            "sample-grasp": sample_grasp,
            "inverse-kin": self.inverse_kin,
            "test-clear": clear,
        }
        objects = {name: ("block",) for name in self.blocks} | {
            name: ("region",) for name in self.regions
        }
        objects |= {f"{name}_start": ("pose",) for name in self.blocks} | {"home": ("conf",)}
        values: dict[str, object] = {"home": 0.0}
        values |= {f"{name}_start": x for name, x in self.blocks.items()}
        values |= {name: name for name in (*self.blocks, *self.regions)}
        init = f"(hand-free) (at-conf home) (conf home) {facts}" + "".join(
            f"(at {name} {name}_start) (pose {name} {name}_start)" for name in self.blocks
        )
        for name, x in self.blocks.items():
            for region, (low, high) in self.regions.items():
                if low <= x - 0.5 and x + 0.5 <= high:
                    init += f"(supported {name} {name}_start {region})"
        return stream_task(domain, STREAMS, known | given, objects, init, goal, values)

    def sample_pose(self, block: str, region: str, call: Call) -> Iterator[float]:
        low, high = self.regions[region]
        while True:
            yield call.rng.uniform(low + 0.5, high - 0.5)

    def inverse_kin(
        self, block: str, pose: float, grasp: float, call: Call
    ) -> Iterator[float | Rejection]:
        conf = pose + grasp
        if self.reach[0] <= conf <= self.reach[1]:
            yield conf
        else:
            yield Rejection("out of reach")

    def replay(self, result: Result, goal: Mapping[str, str]) -> dict[str, float]:
        """Run the plan with real values, and check every step and the goal; where the blocks end."""
        value = result.objects.values
        positions = dict(self.blocks)
        held: tuple[str, float] | None = None
        conf = 0.0
        for action in result.actions:
            arguments = [value[name] for name in action.arguments]
            if action.name == "move":
                (conf,) = arguments
            if action.name not in ("pick", "place"):
                continue
            block, pose, grasp, at = arguments
            assert (
                conf == at == pose + grasp
                and abs(grasp) <= 0.4
                and self.reach[0] <= conf <= self.reach[1]
            )
            if action.name == "pick":
                assert held is None and positions.pop(block) == pose
                held = (block, grasp)
            else:
                assert held == (block, grasp)
                assert all(abs(other - pose) >= 1.0 for other in positions.values()), "collision"
                assert any(
                    low <= pose - 0.5 and pose + 0.5 <= high for low, high in self.regions.values()
                )
                positions[block] = pose
                held = None
        for block, region in goal.items():
            low, high = self.regions[region]
            assert low <= positions[block] - 0.5 and positions[block] + 0.5 <= high
        return positions


def sample_grasp(block: str, call: Call) -> Iterator[float]:
    while True:
        yield call.rng.uniform(-0.4, 0.4)


def clear(block: str, pose: float, other: str, other_pose: float, call: Call) -> bool | Rejection:
    return abs(pose - other_pose) >= 1.0 or Rejection(f"hits {other}")
