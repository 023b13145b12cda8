"""The expected state after each action, by the plan and PDDL's meaning."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Scene
from tamp.plan.read import Hold, PlanFile, TimedAction
from tamp.symbolic.pddl.structs import Atom, Domain, Fact
from tamp.verification.semantics import Semantics, State

COMPARED_RELATIONS = ("on", "inside")
"""Predicates that are compared with the geometry."""


@dataclass
class Expected:
    """Follows a plan's facts.

    Args:
        plan: The plan.
        domain: Its domain.
        scene: Whose names bodies, surfaces and cavities have; PDDL's are lower case.
    """

    plan: PlanFile
    domain: Domain
    scene: Scene

    def __post_init__(self) -> None:
        values = {name: (value.type,) if value.type in self.domain.types else ("object",)
                  for name, value in self.plan.values.items()}  # fmt: skip
        self.semantics = Semantics(
            self.domain, {**self.domain.constants, **values, **self.plan.objects}
        )
        self.state = State.of((*self.plan.initial, *self.plan.certified))
        self._accepted: dict[str, tuple[str, Array]] = {}
        self._bodies = {name.lower(): name for name in self.scene.bodies}

    def apply(self, action: TimedAction) -> None:
        """Apply the action's effects; an action that the domain does not know has none."""
        lifted = self.semantics.actions.get(action.name)
        if lifted is not None and len(lifted.parameters) == len(action.arguments):
            self.state = self.semantics.apply(lifted, action.arguments, self.state)

    def accept(self, seen: Mapping[str, Array]) -> None:
        """Expect bodies where they are seen, T_world_body (4, 4), until the plan moves them."""
        for body, pose in self.state.all("at-pose"):
            name = self._bodies.get(body)
            if name is not None and name in seen:
                self._accepted[name] = pose, seen[name]

    @property
    def poses(self) -> dict[str, Array]:
        """Return T_world_body (4, 4) of the bodies that stand somewhere."""
        found: dict[str, Array] = {}
        for terms in self.state.all("at-pose"):
            value = self.plan.values.get(terms[-1])
            if (
                len(terms) == 2
                and terms[0] in self._bodies
                and value is not None
                and value.type == "pose"
            ):
                name = self._bodies[terms[0]]
                pose, T = self._accepted.get(name, (None, value.data))
                found[name] = T if pose in (None, terms[1]) else value.data
        return found

    @property
    def held(self) -> tuple[str, Array] | None:
        """Return the body in the hand, any hand, and its T_tool_body."""
        return self.held_by(None)

    def held_by(self, arm: str | None) -> tuple[str, Array] | None:
        """Return the body in the hand of an arm, and its T_tool_body; of any where the domain has
        no arms.
        """
        for *of, body, grasp in (terms for terms in self.state.all("holding") if len(terms) > 1):
            value = self.plan.values.get(grasp)
            if of not in ([], [arm]) and arm is not None:
                continue
            if body in self._bodies and value is not None and isinstance(value.data, Hold):
                return self._bodies[body], value.data.T_tool_body
        return None

    @property
    def in_hands(self) -> dict[str, tuple[str, Array]]:
        """Return the bodies in the hands of several arms, and their T_tool_body, by the arms'
        names; none where the domain has no arms.
        """
        arms = {terms[0] for terms in self.state.all("holding") if len(terms) == 3}
        held = {arm: self.held_by(arm) for arm in sorted(arms)}
        return {arm: one for arm, one in held.items() if one is not None}

    @property
    def load(self) -> frozenset[str]:
        """Return the bodies that ride on another one, and go where that is carried."""
        riding = (terms[0] for terms in self.state.all("riding") if len(terms) == 4)
        return frozenset(self._bodies[name] for name in riding if name in self._bodies)

    @property
    def facts(self) -> frozenset[Fact]:
        """Derive the facts of which body should be on and inside what, among surfaces and cavities;
        PDDL's names.
        """
        found: set[Fact] = set()
        for predicate, places in zip(
            COMPARED_RELATIONS, (self.scene.surfaces, self.scene.cavities), strict=True
        ):
            if (
                predicate not in self.domain.predicates
                or len(self.domain.predicates[predicate].parameters) != 2
            ):
                continue
            for body in self.scene.movable:
                for place in places:
                    atom = Atom(predicate, (body.lower(), place.lower()))
                    if all(
                        term in self.semantics.objects for term in atom.terms
                    ) and self.semantics.holds(atom, self.state):
                        found.add((predicate, *atom.terms))
        return frozenset(found)
