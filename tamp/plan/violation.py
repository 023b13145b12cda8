"""One violation: what is wrong with a plan file, or with the plan in it."""

from __future__ import annotations

from dataclasses import dataclass

from tamp.errors import one_line

KINDS = {
    "hash": "a file that the plan was made from is another one now",
    "initial": "the plan starts from something that the problem does not say",
    "certified": "a fact that the plan rests on does not hold",
    "precondition": "an action is not applicable",
    "state": "the facts and the geometry disagree",
    "cost": "an action or the plan costs something else than it says",
    "goal": "the goal does not hold at the end",
    "time": "times that do not follow each other",
    "continuity": "the robot or a body jumps",
    "limit": "a joint, the base or the fingers leave their range",
    "velocity": "faster than the limit",
    "acceleration": "harsher than the limit",
    "collision": "two things penetrate",
    "unchecked": "a motion is too long to be looked at to its end",
    "grasp": "the hand does not hold what it should",
    "support": "a body that is not held does not stand on anything, or not still",
}
"""The kinds of violations."""


@dataclass(frozen=True)
class Violation:
    """One thing that is wrong with a plan.

    Attributes:
        kind: One of KINDS.
        message: What it is, as a sentence without its full stop.
        index: Which action, from 0; None when it concerns the plan.
        action: Its name.
        time: Seconds since the plan's start.
        bodies: The bodies and links that it is about.
        depth: Metres of penetration, or of whatever distance was exceeded.
    """

    kind: str
    message: str
    index: int | None = None
    action: str | None = None
    time: float | None = None
    bodies: tuple[str, ...] = ()
    depth: float | None = None

    def __str__(self) -> str:
        place = "" if self.index is None else f"{self.index + 1} {self.action}"
        when = "" if self.time is None else f"{self.time:.2f} s"
        where = ", ".join(part for part in (place, when) if part)
        return one_line(f"{self.kind:<12} {where + ': ' if where else ''}{self.message}")
