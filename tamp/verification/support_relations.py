"""Support relations, compared with what the plan, its certified facts and the goal say."""

from __future__ import annotations

from tamp.plan.read import PlanFile
from tamp.simulation.world import World
from tamp.symbolic.pddl.structs import Fact, Formula
from tamp.verification.formulas import show
from tamp.verification.initial_state import meant
from tamp.verification.semantics import Semantics, State
from tamp.verification.support_geometry import Stand, Supports
from tamp.verification.violation_log import Log

RELATIONS = frozenset({"supported", "contained", "rests-on"})
"""Certified predicates of a body, a pose and a place, decided in states with the body there."""


class Standing:
    """Asks after the support of bodies in a world that a replay moves.

    Attributes:
        notes: What the problem itself leaves standing on nothing.
    """

    def __init__(
        self, plan: PlanFile, world: World, semantics: Semantics, known: set[str], log: Log
    ) -> None:
        self._plan, self._world, self._semantics, self._log = plan, world, semantics, log
        self._supports = Supports(world)
        self._bodies = {name.lower(): name for name in world.scene.bodies}
        self._places = {
            "supported": {name.lower(): surface for name, surface in world.scene.surfaces.items()},
            "contained": {name.lower(): cavity for name, cavity in world.scene.cavities.items()},
        }

        facts = sorted({*plan.certified, *plan.initial})
        self._relations = [
            fact for fact in facts if fact[0] in RELATIONS & known and len(fact) == 4
        ]
        self._checked: set[Fact] = set()

        # A problem may let a body float; it is not the plan's fault while the robot leaves it be.
        self._floating = {
            name: world.pose(name).tobytes()
            for name in world.scene.movable
            if self._supports.stand(name).why
        }
        self.notes = [
            f"{name} stands on nothing at the start, as the problem says" for name in self._floating
        ]

    def stand(self, body: str, in_hand: str | None) -> Stand:
        """Find how a body stands while another one is in the hand."""
        return self._supports.stand(body, absent=in_hand if in_hand != body else None)

    def check(self, in_hand: str | None) -> None:
        """Check that every body that is not held stands still."""
        for name in self._world.scene.movable:
            if name == in_hand or self._floating.get(name) == self._world.pose(name).tobytes():
                continue
            why = self.stand(name, in_hand).why
            if why:
                self._log.add("support", f"{name} does not stand: {why}", name)

    def check_relations(self, state: State, in_hand: str | None) -> None:
        """Check certified relations of bodies with places, in the first state with it there."""
        there = set(state.all("at-pose")) if meant(self._semantics.domain, "at-pose") else set()
        for fact in self._relations:
            if fact not in self._checked and (fact[1], fact[2]) in there:
                self._checked.add(fact)
                self._check_relation(fact, in_hand)

    def check_unused(self, in_hand: str | None) -> None:
        """Check the same about poses at which the body never was: as if it were there now."""
        for fact in self._relations:
            pose, name = self._plan.values.get(fact[2]), self._bodies.get(fact[1])
            if (
                fact not in self._checked
                and pose is not None
                and pose.type == "pose"
                and name is not None
            ):
                before = self._world.pose(name)
                self._world.place(name, pose.data)
                self._check_relation(fact, in_hand)
                self._world.place(name, before)

    def check_goal(self, goal: Formula, state: State, in_hand: str | None) -> None:
        """Check the goal by the facts, and again by what the bodies say is on and inside what."""
        if not self._semantics.holds(goal, state):
            self._log.add("goal", f"{show(goal)} does not follow from the facts at the end")

        felt: set[Fact] = set()
        reasons: dict[str, str] = {}
        for name in self._world.scene.movable:
            if name == in_hand:
                continue
            stand = self.stand(name, in_hand)
            below = stand.on - self._world.scene.surfaces.keys()
            felt |= {("on", name.lower(), body.lower()) for body in below}
            for predicate, relation in (("on", "supported"), ("inside", "contained")):
                for place in self._places[relation]:
                    fact = (predicate, name.lower(), place)
                    why = self._why_not(relation, name, place, stand)
                    if why is None:
                        felt.add(fact)
                    else:
                        reasons[f"({' '.join(fact)})"] = why

        facts = {(name, *row) for name, rows in state.facts.items() for row in rows}
        if not self._semantics.without(("on", "inside")).holds(goal, State.of(facts | felt)):
            asked = "; ".join(
                f"{fact}: {why}" for fact, why in reasons.items() if fact in show(goal)
            )
            message = f"{show(goal)} does not hold in the geometry at the end"
            self._log.add("goal", f"{message}: {asked}" if asked else message)

    def _check_relation(self, fact: Fact, in_hand: str | None) -> None:
        relation, body, _, place = fact
        name = self._bodies.get(body)
        if name is None or name == in_hand:
            return
        stand = self.stand(name, in_hand)
        if relation == "rests-on":
            why = (
                None
                if self._bodies.get(place) in stand.on
                else f"it rests on {', '.join(sorted(stand.on))}"
            )
        else:
            why = self._why_not(relation, name, place, stand)
        if why:
            self._log.add("certified", f"({' '.join(fact)}) does not hold: {why}", body, place)

    def _why_not(self, relation: str, body: str, place: str, stand: Stand) -> str | None:
        if relation == "supported":
            surface = self._world.scene.surfaces.get(self._name(relation, place))
            return (
                "there is no such surface"
                if surface is None
                else self._supports.on(body, surface, stand)
            )
        cavity = self._world.scene.cavities.get(self._name(relation, place))
        return (
            "there is no such cavity"
            if cavity is None
            else self._supports.inside(body, cavity, stand)
        )

    def _name(self, relation: str, place: str) -> str:
        found = self._places[relation].get(place)
        return found.name if found is not None else ""
