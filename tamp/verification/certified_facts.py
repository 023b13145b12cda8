"""Certified facts of streams, worked out again from the geometry."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Iterator

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import rest_row, with_arm
from tamp.geometric.scene.pose import Array, base_difference, pose_difference
from tamp.plan.read import Hold, PlanFile
from tamp.plan.violation import Violation
from tamp.simulation.world import World
from tamp.symbolic.pddl.structs import Domain, Fact
from tamp.verification.collision_sweep import MAX_PENETRATION_M, CollisionFindings, Sweeper
from tamp.verification.execution_state import Held
from tamp.verification.hands import Hands
from tamp.verification.initial_state import owner_of
from tamp.verification.limits import RANGE_TOLERANCE
from tamp.verification.makers_limits import limits_of

POSE_DIFFERENCE_M = 0.001
"""Metres by which two poses that should be one may differ."""
POSE_DIFFERENCE_RAD = math.radians(0.5)
"""Radians by which they may be turned."""
OF_AN_ARM = frozenset(
    {"reachable", "grasp", "kin", "exchange", "handover-motion", "pick-motion", "place-motion",
     "approach", "approach-clear", "reach-clear"}
)  # fmt: skip
"""Predicates that may be of one of several arms, which comes first then."""


class Certified:
    """Checks facts whose predicates have a geometric meaning that we know.

    Facts about surfaces and cavities are not decided here but in the states in which they matter.
    """

    def __init__(
        self, plan: PlanFile, world: World, robot: Robot, sweeper: Sweeper, domain: Domain
    ) -> None:
        self._plan, self._world, self._robot, self._sweeper, self._domain = (
            plan,
            world,
            robot,
            sweeper,
            domain,
        )

        self._bodies = {name.lower(): name for name in world.scene.bodies}
        self._arms = {arm.arm: number for number, arm in enumerate(robot.arms)}
        self._arm = 0
        self._hands = Hands(world, robot, sweeper)
        self._checks: dict[str, tuple[str, Callable[[list[str]], str | None]]] = {
            "pose": ("op", lambda _: None),
            "reachable": ("op", lambda _: None),  # advice: what rests on it is checked itself
            "supported": ("op?", lambda _: None),
            "contained": ("op?", lambda _: None),
            "rests-on": ("opo", lambda _: None),
            "grounded": ("op", lambda _: None),
            "borne": ("opop", lambda _: None),
            "stacked": ("op?op", lambda _: None),
            "packed": ("op?op", lambda _: None),
            "sampled": ("op", lambda _: None),
            "shifted": ("opoppp", self._shifted),
            "portable": ("o", lambda _: None),
            "anchored": ("?", self._anchored),
            "stackable": ("o?o", self._stackable),
            "grasp": ("og", self._grasp),
            "standing": ("b", self._base_conf),
            "base-conf": ("b", self._base_conf),
            "kin": ("opgbq", self._kinematics),
            "base-motion": ("bt", self._base_motion),
            "pick-motion": ("opgbqt", self._kinematics),
            "place-motion": ("opgbqt", self._kinematics),
            "exchange": ("ogagbpqq", self._exchange),
            "handover-motion": ("ogagbpqqt", self._exchange),
            "approach": ("opg", self._approach),
            "approach-clear": ("opgop", self._approach_clear),
            "pose-clear": ("opop", self._pose_clear),
            "reach-clear": ("opgbqop", self._reach_clear),
        }

    @property
    def checkable(self) -> set[str]:
        """Return the predicates that can be checked in this domain."""
        declared = self._domain.predicates
        return {
            name for name, (kinds, _) in self._checks.items()
            if name in declared
            and len(declared[name].parameters) in (len(kinds), len(kinds) + (name in OF_AN_ARM))
        }  # fmt: skip

    def check(self, facts: Iterable[Fact], trusted: Counter[str]) -> Iterator[Violation]:
        """Yield violations of facts; those of unknown predicates are counted in `trusted`."""
        changed = {
            effect.atom.predicate for action in self._domain.actions for effect in action.effects
        }
        changed |= self._domain.derived_predicates

        checkable = self.checkable
        for fact in sorted(set(facts)):
            predicate, *terms = fact
            text = f"({' '.join(fact)})"
            if predicate in changed:
                yield Violation(
                    "certified",
                    f"{text}: actions and rules decide about {predicate}, streams do not",
                )
            elif predicate not in checkable:
                trusted[predicate] += 1
            else:
                kinds, check = self._checks[predicate]
                rest = self._of_arm(predicate, kinds, terms)
                if rest is None:
                    why = f"'{terms[0]}' is no arm"
                else:
                    why = self._malformed(kinds, rest) or check(rest)
                if why:
                    bodies = tuple(term for term in terms if term in self._bodies)
                    yield Violation("certified", f"{text} does not hold: {why}", bodies=bodies)

    def _of_arm(self, predicate: str, kinds: str, terms: list[str]) -> list[str] | None:
        """Return a fact's terms without the arm that it is of, the first one where it names none;
        None where that is no arm.
        """
        self._arm = 0
        if predicate not in OF_AN_ARM or len(terms) != len(kinds) + 1:
            return terms
        if terms[0] not in self._arms:
            return None
        self._arm = self._arms[terms[0]]
        return terms[1:]

    def why_not_held(
        self, body: str, T_tool_body: Array, opening: float, arm: int = 0
    ) -> str | None:
        """Say why an arm's fingers at an opening do not hold a body at T_tool_body; None when they
        do.
        """
        return self._hands.why_not_held(body, T_tool_body, opening, arm)

    def _malformed(self, kinds: str, terms: list[str]) -> str | None:
        types = {"p": "pose", "g": "grasp", "b": "base-conf", "q": "reach", "t": "motion"}
        if len(terms) != len(kinds):
            return f"it takes {len(kinds)} arguments"
        for kind, term in zip(kinds, terms, strict=True):
            if kind == "o" and term not in self._bodies:
                return f"'{term}' is not a body"
            if kind == "a" and term not in self._arms:
                return f"'{term}' is no arm"
            if kind in types:
                value = self._plan.values.get(term)
                if value is None or value.type != types[kind]:
                    return f"'{term}' is not a {types[kind]}"
        return None

    def _shifted(self, terms: list[str]) -> str | None:
        pose, was, now, shifted = (self._plan.values[terms[at]].data for at in (1, 3, 4, 5))
        moved, turned = pose_difference(now @ np.linalg.inv(was) @ pose, shifted)
        if moved > POSE_DIFFERENCE_M or turned > POSE_DIFFERENCE_RAD:
            off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg"
            return f"carried along it would be {off} from there"
        return None

    def _anchored(self, terms: list[str]) -> str | None:
        owner = owner_of(self._world.scene, terms[0])
        if owner is None:
            return "there is no such place"
        return f"{owner.name} may be moved" if owner.movable else None

    def _stackable(self, terms: list[str]) -> str | None:
        owner = owner_of(self._world.scene, terms[1])
        below = self._world.scene.bodies[self._bodies[terms[2]]]
        if owner is None or owner.name != below.name:
            return f"{terms[1]} is no place of {below.name}"
        return None if below.movable else f"{below.name} is fixed"

    def _grasp(self, terms: list[str]) -> str | None:
        hold: Hold = self._plan.values[terms[1]].data
        if hold.body != terms[0]:
            return f"{terms[1]} is a grasp of {hold.body}"
        return self.why_not_held(self._bodies[terms[0]], hold.T_tool_body, hold.opening, self._arm)

    def _base_conf(self, terms: list[str]) -> str | None:
        x, y, _ = self._plan.values[terms[0]].data
        room = self._world.scene.room
        inside = (
            room.x[0] - 1e-4 <= x <= room.x[1] + 1e-4 and room.y[0] - 1e-4 <= y <= room.y[1] + 1e-4
        )
        return None if inside else "it is out of the room"

    def _kinematics(self, terms: list[str]) -> str | None:
        pose, hold, base, (approach, lift) = (self._plan.values[term].data for term in terms[1:5])
        if self._beyond(approach, lift):
            return "the path leaves the joints' limits"
        for joints in (approach[-1], lift[0]):
            row = with_arm(
                self._robot, rest_row(self._robot, base), self._arm, joints, hold.opening
            )
            T_world_tool = self._sweeper.tool(row, self._arm)
            moved, turned = pose_difference(T_world_tool @ hold.T_tool_body, pose)
            if moved > POSE_DIFFERENCE_M or turned > POSE_DIFFERENCE_RAD:
                off = f"{1000 * moved:.1f} mm, {math.degrees(turned):.1f} deg"
                return f"the hand would hold it {off} from there"
        return None

    def _exchange(self, terms: list[str]) -> str | None:
        """Say why two arms do not hold a body at once; the first is the fact's own arm."""
        body, grasp, taker, other, base, pose, gives, takes = terms[:8]
        giver = self._arm
        if giver == self._arms[taker]:
            return "an arm hands nothing over to itself"
        for arm, held, reach in ((giver, grasp, gives), (self._arms[taker], other, takes)):
            self._arm = arm
            why = self._kinematics([body, pose, held, base, reach])
            if why:
                return f"{self._robot.arms[arm].arm}: {why}"
        return None

    def _beyond(self, *paths: Array) -> bool:
        """Check whether joint positions (n, joints) are out of the limits."""
        limits = limits_of(self._robot.arms[self._arm])
        lower = np.array(limits.lower) - RANGE_TOLERANCE
        upper = np.array(limits.upper) + RANGE_TOLERANCE
        return any(bool(((path < lower) | (path > upper)).any()) for path in paths)

    def _base_motion(self, terms: list[str]) -> str | None:
        paths = [path for path in self._plan.values[terms[1]].data or () if path[0] == "base"]
        target = self._plan.values[terms[0]].data
        if paths and base_difference(paths[-1][1][-1], target) > POSE_DIFFERENCE_M:
            return "it ends elsewhere"
        return None

    def _pose_clear(self, terms: list[str]) -> str | None:
        first, second = self._bodies[terms[0]], self._bodies[terms[2]]
        if first == second:
            return None
        for body, term in ((first, terms[1]), (second, terms[3])):
            self._world.place(body, self._plan.values[term].data)
        distance = self._world.body_distance(first, second)
        if distance >= -MAX_PENETRATION_M:
            return None
        return f"they penetrate by {-1000 * distance:.1f} mm"

    def _approach(self, terms: list[str]) -> str | None:
        pose, hold = (self._plan.values[term].data for term in terms[1:3])
        T_world_tool = pose @ np.linalg.inv(hold.T_tool_body)
        hits = (
            self._hands.meets(name, T_world_tool, self._arm) for name in self._world.scene.fixed
        )
        return next((hit for hit in hits if hit), None)

    def _approach_clear(self, terms: list[str]) -> str | None:
        other = self._bodies[terms[3]]
        if self._bodies[terms[0]] == other:
            return None
        pose, hold = (self._plan.values[term].data for term in terms[1:3])
        self._world.place(other, self._plan.values[terms[4]].data)
        return self._hands.meets(other, pose @ np.linalg.inv(hold.T_tool_body), self._arm)

    def _reach_clear(self, terms: list[str]) -> str | None:
        other = self._bodies[terms[5]]
        if self._bodies[terms[0]] == other:
            return None
        hold, base, (approach, lift) = (self._plan.values[term].data for term in terms[2:5])
        if self._beyond(approach, lift):
            return "the path leaves the joints' limits"
        self._world.place(other, self._plan.values[terms[6]].data)
        findings = CollisionFindings(clearance=False)
        robot, arm = self._robot, self._arm
        held = Held(self._bodies[terms[0]], hold.T_tool_body, arm=arm)
        ways = ((approach, robot.arms[arm].opening, ()), (lift, hold.opening, (held,)))
        rest = rest_row(robot, base)
        for path, opening, carried in ways:
            rows = np.array([with_arm(robot, rest, arm, joints, opening) for joints in path])
            times = np.arange(len(rows), dtype=float)
            self._sweeper.sweep(rows, times, carried, findings, against=frozenset({other}))
        worst = min(findings.worst.values(), key=lambda contact: contact.distance, default=None)
        return f"{worst.first} is {-1000 * worst.distance:.1f} mm in it" if worst else None
