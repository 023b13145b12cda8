"""Loads: bodies that ride on what the hand holds, by the facts (riding ?o ?p ?below ?pb), felt."""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.scene.pose import Array, pose_difference
from tamp.plan.read import Hold, PlanFile
from tamp.simulation.world import World
from tamp.verification.certified_facts import POSE_DIFFERENCE_M, POSE_DIFFERENCE_RAD
from tamp.verification.collision_sweep import Sweeper
from tamp.verification.execution_state import ExecutionState, Held, carried
from tamp.verification.initial_state import has_standard_meaning
from tamp.verification.semantics import Semantics, State
from tamp.verification.support_relations import SupportRelations
from tamp.verification.violation_log import ViolationLog

LOADED_TILT_RAD = math.radians(12.0)
"""Radians by which a body may lean while others stand on it."""


class Loads:
    """Says what rides on which body, where it is, and whether it is carried level."""

    def __init__(
        self,
        plan: PlanFile,
        world: World,
        semantics: Semantics,
        supports: SupportRelations,
        log: ViolationLog,
    ) -> None:
        self._plan, self._world, self._supports, self._log = plan, world, supports, log
        self._bodies = {name.lower(): name for name in world.scene.bodies}
        self._meant = has_standard_meaning(semantics.domain, "riding")
        self._upright: dict[str, Array] = {}

    def on(
        self, hold: Hold, body: str, T_world_tool: Array, state: State, arm: int = 0
    ) -> tuple[Held, ...]:
        """Return what rides on a body that the hand closes on, of which it is felt that it rests
        there; the rest is left behind. The plan must say the same of it.
        """
        load = self._riders(body, T_world_tool, state, arm) if self._meant else ()
        says, rides = {name for name, _ in hold.load}, {one.body.lower() for one in load}
        if says != rides:
            told, true = (" and ".join(sorted(names)) or "nothing" for names in (says, rides))
            message = f"the plan says that {told} goes with {body}, by the facts {true} rides on it"
            self._log.add("grasp", message, body, *sorted(says ^ rides))
        T_body_tool = np.linalg.inv(self._world.pose(body))
        for name, T_body_rider in hold.load:
            seen = T_body_tool @ self._world.pose(self._bodies[name]) if name in rides else None
            moved, turned = (0.0, 0.0) if seen is None else pose_difference(seen, T_body_rider)
            if moved > POSE_DIFFERENCE_M or turned > POSE_DIFFERENCE_RAD:
                off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg"
                message = f"{name} is {off} from where the plan has it on {body}"
                self._log.add("grasp", message, name, body, depth=moved)
        return load

    def _riders(self, body: str, T_world_tool: Array, state: State, arm: int) -> tuple[Held, ...]:
        self._upright[body] = self._world.pose(body)[2, :3].copy()
        load: list[Held] = []
        for rider, _, below, _ in state.all("riding"):
            name = self._bodies.get(rider)
            if name is None or below != body.lower():
                continue
            on = self._supports.stand(name, frozenset()).on
            if on != {body}:
                supports = ", ".join(sorted(on)) or "nothing"
                self._log.add(
                    "grasp", f"{name} does not ride on {body}: it rests on {supports}", name
                )
                continue
            T_tool_rider = np.linalg.inv(T_world_tool) @ self._world.pose(name)
            load.append(Held(name, T_tool_rider, arm=arm))
        return tuple(load)

    def check_level(self, held: Held, rows: Array, sweeper: Sweeper) -> None:
        """Check that a body with others on it does not lean on the way through states (n, 11)."""
        if not held.load:
            return
        up = self._upright[held.body]
        leans = [
            float((sweeper.tool(row, held.arm)[2, :3] @ held.T_tool_body[:3, :3]) @ up)
            for row in rows
        ]
        lean = math.acos(max(-1.0, min(1.0, min(leans))))
        if lean > LOADED_TILT_RAD:
            others = " and ".join(one.body for one in held.load)
            message = f"{held.body} leans by {math.degrees(lean):.1f} deg with {others} on it"
            self._log.add("support", message, held.body, *(one.body for one in held.load))

    def compare(self, state: State, course: ExecutionState) -> None:
        """Log bodies that are not where they ride by the facts: where the one below has got to."""
        for fact in state.all("riding") if self._meant else ():
            name, below = (self._bodies.get(fact[at]) for at in (0, 2))
            poses = [self._plan.values.get(fact[at]) for at in (1, 3)]
            if name is None or below is None or any(p is None or p.type != "pose" for p in poses):
                self._log.add("state", f"(riding {' '.join(fact)}) is not of bodies and poses")
                continue
            was, carrier = (pose.data for pose in poses if pose is not None)
            there = self._world.pose(below) @ np.linalg.inv(carrier) @ was
            moved, turned = pose_difference(self._world.pose(name), there)
            if moved > POSE_DIFFERENCE_M or turned > POSE_DIFFERENCE_RAD:
                off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg"
                message = f"{name} is {off} from where it rides on {below}"
                self._log.add("state", message, name, depth=moved)
            load = {one.body for one in carried(course.held)}
            if below in course.in_hand and name not in load:
                self._log.add("state", f"{name} does not ride on {below}", name)
