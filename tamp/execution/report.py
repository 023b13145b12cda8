"""Report of a plan's execution in physics, for people and for programs."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import asdict, dataclass, field
from typing import Any

from tamp.errors import printable
from tamp.execution.deviation import Deviation
from tamp.execution.monitoring import ContactEvent


@dataclass(frozen=True)
class BodyDisplacement:
    """A body that an action moved without meaning to: metres and radians."""

    body: str
    moved: float
    turned: float


@dataclass(frozen=True)
class ActionOutcome:
    """One action as it went.

    Attributes:
        name: As in the domain.
        objects: The bodies, surfaces and containers among its arguments.
        start: Simulated seconds since the beginning.
        seconds: That it took.
        base: The base's largest tracking error, metres.
        arm: The arm's largest tracking error, radians.
        touches: Contacts that should not have been.
        displaced: Bodies that moved without being handled.
        deviations: What was not as the plan expects it afterwards.
        event: What somebody did meanwhile.
        after: What was made of the deviations: "goes on", "planned anew", or why not.
    """

    name: str
    objects: tuple[str, ...]
    start: float
    seconds: float
    base: float
    arm: float
    touches: tuple[ContactEvent, ...] = ()
    displaced: tuple[BodyDisplacement, ...] = ()
    deviations: tuple[Deviation, ...] = ()
    event: str | None = None
    after: str | None = None


@dataclass(frozen=True)
class GoalFact:
    """A part of the goal: whether it holds by the bodies' geometry, why not, and what a classifier
    says.
    """

    fact: str
    holds: bool
    why: str | None = None
    classifier: str | None = None
    probability: float | None = None


@dataclass(frozen=True)
class Execution:
    """The whole run.

    Attributes:
        name: The plan's.
        grasp: "friction" or "constraint".
        seed: Of the disturbance and of planning anew.
        actions: In order, those of later plans included.
        goal: Its parts.
        reached: Whether the goal holds.
        replans: How often it was planned anew.
        kept: How often the rest of the plan was good enough after a deviation.
        disturbance: What was done to the scene, and when.
        explanation: Why the goal was not reached.
        on_trust: Relations of the goal without a classifier: they hold where the plan put their
            bodies, as it says.
        simulated: Seconds in physics.
        notes: What was not done as the plan says.
        engine: The physics engine's name.
        seconds: Seconds that it took.
    """

    name: str
    grasp: str
    seed: int
    actions: tuple[ActionOutcome, ...]
    goal: tuple[GoalFact, ...]
    reached: bool
    replans: int = 0
    kept: int = 0
    disturbance: str | None = None
    explanation: tuple[str, ...] = ()
    on_trust: tuple[str, ...] = ()
    simulated: float = 0.0
    notes: tuple[str, ...] = ()
    engine: str = ""
    seconds: float = field(default=0.0, compare=False)

    @property
    def kinds(self) -> dict[str, int]:
        """Count how often each kind of deviation occurred."""
        counts = Counter(one.kind for action in self.actions for one in action.deviations)
        return dict(sorted(counts.items()))

    def text(self) -> str:
        """Format the report for people: a line an action, the goal, and a summary."""
        lines = [
            line
            for number, action in enumerate(self.actions, 1)
            for line in _action(number, action)
        ]

        lines.append("")
        lines += [_goal(fact) for fact in self.goal]
        lines += [f"  {line}" for line in self.explanation]
        lines += [f"  note: {line}" for line in self.notes]

        facts = [
            f"{len(self.actions)} actions",
            f"{self.simulated:.1f} s in physics",
            f"{self.grasp} grasp",
        ]
        facts += [f"planned anew {self.replans}x"] if self.replans else []
        facts += [f"went on after {self.kept} deviations"] if self.kept else []
        kinds = ", ".join(f"{count} {kind}" for kind, count in self.kinds.items())
        facts += [kinds] if kinds else []

        verdict = "Goal reached" if self.reached else "Goal not reached"
        if self.reached and self.on_trust:
            verdict += f", on trust: {', '.join(self.on_trust)}"
        lines.append(f"{verdict}: {', '.join(facts)}, in {self.seconds:.1f} s")
        return "\n".join(lines)

    def json(self) -> dict[str, Any]:
        """Return the report for programs: metres, radians, seconds, newtons."""
        return {"format": "tamp-execution", "version": 1, **asdict(self), "kinds": self.kinds}


def _action(number: int, action: ActionOutcome) -> list[str]:
    what = f"{action.name:<6} {' '.join(action.objects)}"
    lag = f"lags {1000 * action.base:.1f} mm, {math.degrees(action.arm):.2f}°"
    lines = [f"  {number:2d}  {what:<34} {action.seconds:5.1f} s   {lag}"]
    lines += [f"        ! {action.event}"] if action.event else []
    lines += [
        f"        touches: {one.first} - {one.second}, {one.force:.0f} N" for one in action.touches
    ]
    lines += [
        f"        moved: {one.body} by {1000 * one.moved:.0f} mm, {math.degrees(one.turned):.0f}°"
        for one in action.displaced
    ]
    lines += [f"        {one.kind}: {one.message}" for one in action.deviations]
    lines += [f"        -> {action.after}"] if action.after else []
    return [printable(line) for line in lines]


def _goal(fact: GoalFact) -> str:
    classified = (
        "" if fact.classifier is None else f"   {fact.classifier} says {fact.probability:.2f}"
    )
    why = f": {fact.why}" if fact.why else ""
    return (
        f"  {printable(fact.fact)} {'holds' if fact.holds else 'does not hold' + why}{classified}"
    )
