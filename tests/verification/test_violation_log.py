"""Violations are taken down with the action and the time in which they happen."""

from __future__ import annotations

from tamp.plan.violation import Violation
from tamp.verification.violation_log import ViolationLog


def test_before_the_first_action_it_is_of_none() -> None:
    log = ViolationLog()
    log.add("support", "cup stands on nothing", "cup")
    assert log.violations == [
        Violation("support", "cup stands on nothing", None, None, None, ("cup",), None)
    ]


def test_it_is_here_and_now_unless_another_time_is_said() -> None:
    log = ViolationLog()
    log.action, log.time = (2, "pick"), 7.5
    log.add("grasp", "too wide", "cup", "hand", depth=0.01)
    log.add("collision", "they meet", time=0.0)
    now, then = log.violations
    assert (now.index, now.action, now.time) == (2, "pick", 7.5)
    assert now.bodies == ("cup", "hand") and now.depth == 0.01
    assert (then.index, then.time, then.depth, then.bodies) == (2, 0.0, None, ())
