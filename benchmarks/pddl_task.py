"""A task of a classical planning domain, in PDDL."""

from __future__ import annotations

Task = tuple[str, str]
"""A domain and a problem, in PDDL."""


def problem(domain: str, objects: str, init: list[str], goal: list[str], *, metric: bool = False) -> str:
    """A problem file's text."""
    lines = [f"(define (problem {domain}-task) (:domain {domain})", f"  (:objects {objects})", "  (:init"]
    lines += [f"    {fact}" for fact in init]
    lines += ["  )", f"  (:goal (and {' '.join(goal)}))", "  (:metric minimize (total-cost))" if metric else "", ")"]
    return "\n".join(lines)
