"""The judge's report, for people and for programs."""

from __future__ import annotations

from collections import Counter
from dataclasses import asdict, dataclass, field
from typing import Any

from tamp.errors import one_line, printable
from tamp.plan.violation import Violation
from tamp.verification.collision_sweep import PairDistance


@dataclass(frozen=True)
class Report:
    """The verdict.

    Attributes:
        name: The plan file's name.
        violations: Empty when the plan holds.
        actions: How many.
        duration: Of the motion, seconds.
        states: How many states of the robot were looked at.
        nearest: The nearest miss, if anything was nearer than 2 cm (grasping and resting aside).
        trusted: How many facts of each predicate could only be taken on trust.
        notes: Oddities that are not the plan's fault.
        seconds: That the verification took.
        on_trust: Relations on which the verdict rests, and of which nobody but the plan says where
            they hold.
        other_files: Domain and streams by which was judged, where they are not the problem's.
        asked: How many answers each relation's classifier gave.
        engine: The name of the engine that judged, or of the two.
    """

    name: str
    violations: tuple[Violation, ...]
    actions: int
    duration: float
    states: int
    nearest: PairDistance | None
    trusted: dict[str, int]
    notes: tuple[str, ...]
    seconds: float
    on_trust: tuple[str, ...] = ()
    other_files: tuple[str, ...] = ()
    asked: dict[str, int] = field(default_factory=dict[str, int])
    engine: str = ""

    @property
    def holds(self) -> bool:
        """Tell whether nothing is wrong."""
        return not self.violations

    @property
    def checked(self) -> bool:
        """Tell whether the verdict rests on nothing that could not be checked."""
        return not self.on_trust and not self.other_files

    def text(self) -> str:
        """Report to people: a line a violation and a summary."""
        lines = [f"  {violation}" for violation in self.violations]
        lines += [f"  note: {one_line(note)}" for note in self.notes]
        moving = [f"{self.duration:.1f} s"] if self.duration else []
        facts = [f"{self.actions} actions", *moving, f"{self.states:,} states checked"]
        if self.nearest:
            pair = f"{self.nearest.first} - {self.nearest.second}"
            facts.append(f"least clearance {1000 * self.nearest.distance:.1f} mm ({pair})")
        facts += [f"{name} asked {count} times" for name, count in self.asked.items()]
        verdict = "holds" if self.holds else f"does not hold, {_counted(self.violations)}"
        trust = [f"on trust: {', '.join(self.on_trust)}"] if self.on_trust else []
        verdict = ", ".join([verdict, *trust, *self.other_files])
        lines.append(
            f"{printable(self.name)} {verdict}: {', '.join(facts)} in {self.seconds:.1f} s"
        )
        return "\n".join(lines)

    def json(self) -> dict[str, Any]:
        """Report to programs."""
        return {
            "plan": self.name,
            "holds": self.holds,
            "violations": [asdict(violation) for violation in self.violations],
            "actions": self.actions,
            "duration": self.duration,
            "states": self.states,
            "clearance": asdict(self.nearest) if self.nearest else None,
            "trusted": self.trusted,
            "checked": self.checked,
            "on_trust": list(self.on_trust),
            "other_files": list(self.other_files),
            "asked": self.asked,
            "engine": self.engine,
            "notes": self.notes,
            "seconds": self.seconds,
        }


def _counted(violations: tuple[Violation, ...]) -> str:
    counts = Counter(violation.kind for violation in violations)
    plural = "" if len(violations) == 1 else "s"
    return (
        f"{len(violations)} violation{plural} ("
        + ", ".join(f"{n} {kind}" for kind, n in counts.items())
        + ")"
    )
