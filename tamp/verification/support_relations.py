"""Support relations, compared with what the plan, its certified facts and the goal say."""

from __future__ import annotations

from collections.abc import Collection

from tamp.plan.read import PlanFile
from tamp.simulation.world import World
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.structs import Fact, Formula
from tamp.verification.formulas import facts as facts_of
from tamp.verification.initial_state import has_standard_meaning
from tamp.verification.semantics import Semantics, State
from tamp.verification.support_geometry import SupportContact, Supports
from tamp.verification.violation_log import ViolationLog

SUPPORT_PREDICATES = {
    "supported": 4,
    "contained": 4,
    "rests-on": 4,
    "grounded": 3,
    "borne": 5,
    "stacked": 6,
    "packed": 6,
}
"""Certified predicates of a body and a pose, a place, a body below and its pose, with their
lengths; decided in states with the bodies there."""


class SupportRelations:
    """Asks after the support of bodies in a world that a replay moves.

    Attributes:
        notes: What the problem itself leaves standing on nothing.
    """

    def __init__(
        self,
        plan: PlanFile,
        world: World,
        semantics: Semantics,
        checkable: set[str],
        log: ViolationLog,
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
            fact
            for fact in facts
            if fact[0] in checkable and len(fact) == SUPPORT_PREDICATES.get(fact[0])
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

    def stand(self, body: str, in_hand: frozenset[str]) -> SupportContact:
        """Find how a body stands while others are in hands."""
        return self._supports.stand(body, absent=in_hand - {body})

    def check(self, in_hand: frozenset[str], aboard: Collection[str] = ()) -> None:
        """Check that every body that is neither held nor `aboard` of what is stands still."""
        others = [name for name in self._world.scene.movable if name not in in_hand]
        stands = {name: self.stand(name, in_hand) for name in others}
        for name in others:
            if name in aboard or self._floating.get(name) == self._world.pose(name).tobytes():
                continue
            why = stands[name].why or self._supports.why_overloaded(name, stands)
            if why:
                self._log.add("support", f"{name} does not stand: {why}", name)

    def check_relations(self, state: State, in_hand: frozenset[str]) -> None:
        """Check certified relations of bodies with places, in the first state with it there."""
        there = (
            set(state.all("at-pose"))
            if has_standard_meaning(self._semantics.domain, "at-pose")
            else set()
        )
        for fact in self._relations:
            if fact not in self._checked and there.issuperset(_posed(fact)):
                self._checked.add(fact)
                self._check_relation(fact, in_hand)

    def check_unused(self, in_hand: frozenset[str]) -> None:
        """Check the same about poses at which the body never was: as if it were there now."""
        for fact in self._relations:
            posed = [
                (self._bodies.get(body), self._plan.values.get(pose)) for body, pose in _posed(fact)
            ]
            if fact in self._checked:
                continue
            there = {
                name: pose.data
                for name, pose in posed
                if name is not None and pose is not None and pose.type == "pose"
            }
            if len(there) < len(posed):
                continue
            before = {name: self._world.pose(name) for name in there}
            for name, pose in there.items():
                self._world.place(name, pose)
            self._check_relation(fact, in_hand - there.keys())
            for name, pose in before.items():
                self._world.place(name, pose)

    def check_goal(self, goal: Formula, state: State, in_hand: frozenset[str]) -> None:
        """Check the goal by the facts, and again by what the bodies say is on and inside what."""
        if not self._semantics.holds(goal, state):
            self._log.add("goal", f"{to_text(goal)} does not follow from the facts at the end")

        observed: set[Fact] = set()
        reasons: dict[Fact, str] = {}
        for name in self._world.scene.movable:
            if name in in_hand:
                continue
            stand = self.stand(name, in_hand)
            below = stand.on - self._world.scene.surfaces.keys()
            observed |= {("on", name.lower(), body.lower()) for body in below}
            for predicate, relation in (("on", "supported"), ("inside", "contained")):
                for place in self._places[relation]:
                    fact = (predicate, name.lower(), place)
                    why = self._why_not(relation, name, place, stand)
                    if why is None:
                        observed.add(fact)
                    else:
                        reasons[fact] = why

        facts = {(name, *row) for name, rows in state.facts.items() for row in rows}
        if not self._semantics.without(("on", "inside")).holds(goal, State.of(facts | observed)):
            wanted = facts_of(goal)
            asked = "; ".join(
                f"({' '.join(fact)}): {why}" for fact, why in reasons.items() if fact in wanted
            )
            message = f"{to_text(goal)} does not hold in the geometry at the end"
            self._log.add("goal", f"{message}: {asked}" if asked else message)

    def _check_relation(self, fact: Fact, in_hand: frozenset[str]) -> None:
        name = self._bodies.get(fact[1])
        if name is None or name in in_hand:
            return
        stand = self.stand(name, in_hand)
        why = self._why_no_relation(fact, name, stand)
        if why:
            bodies = [term for term in (fact[1], *fact[3:]) if term in self._bodies]
            self._log.add("certified", f"({' '.join(fact)}) does not hold: {why}", *bodies)

    def _why_no_relation(self, fact: Fact, name: str, stand: SupportContact) -> str | None:
        relation, supports = fact[0], f"it rests on {', '.join(sorted(stand.on)) or 'nothing'}"
        if relation == "grounded":
            return supports if stand.on & set(self._world.scene.movable) else None
        if relation in ("supported", "contained"):
            return self._why_not(relation, name, fact[3], stand)

        below = self._bodies.get(fact[3 if relation != "stacked" else 4])
        if relation in ("rests-on", "borne"):
            return None if below in stand.on else supports
        if relation == "packed":
            return self._why_not("contained", name, fact[3], stand)
        if fact[3] in self._places["supported"]:
            return self._why_not("supported", name, fact[3], stand)
        return stand.why if below in stand.on else supports

    def _why_not(self, relation: str, body: str, place: str, stand: SupportContact) -> str | None:
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


def _posed(fact: Fact) -> tuple[tuple[str, str], ...]:
    """Return the bodies and poses that a certified relation is about."""
    below = ((fact[-2], fact[-1]),) if fact[0] in ("borne", "stacked", "packed") else ()
    return ((fact[1], fact[2]), *below)
