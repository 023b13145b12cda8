"""Violations as they are found, each with the action in which it happened."""

from __future__ import annotations

from tamp.plan.violation import Violation


class ViolationLog:
    """Collects violations. `action` and `time` say where the plan has come to."""

    def __init__(self) -> None:
        self.violations: list[Violation] = []
        self.action: tuple[int, str] | None = None
        self.time: float | None = None

    def add(
        self,
        kind: str,
        message: str,
        *bodies: str,
        time: float | None = None,
        depth: float | None = None,
    ) -> None:
        """Take down a violation, here and now unless another time is said."""
        index, name = self.action or (None, None)
        when = self.time if time is None else time
        self.violations.append(Violation(kind, message, index, name, when, bodies, depth))
