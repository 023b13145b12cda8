"""One verdict from two engines: the first decides, the second has only notes to make."""

from __future__ import annotations

from tamp.plan.violation import Violation
from tamp.verification.report import Report
from tamp.verification.two_engines import compared

HIT = Violation("collision", "cup and box penetrate by 3.1 mm", 1, "move", bodies=("cup", "box"))
FALLS = Violation("support", "the cup does not stand", 2, "place", bodies=("cup",))


def report(engine: str, *violations: Violation, seconds: float = 1.0, note: str = "") -> Report:
    notes = (note,) if note else ()
    return Report("plan", violations, 3, 8.0, 100, None, {}, notes, seconds, engine=engine)


def test_engines_that_agree_make_no_notes() -> None:
    found = compared(report("pybullet", HIT, seconds=1.0), report("mujoco", HIT, seconds=2.5))
    assert found.violations == (HIT,) and found.notes == ()
    assert found.engine == "pybullet, mujoco" and found.seconds == 2.5


def test_the_same_violation_with_another_figure_or_order_of_bodies_is_the_same() -> None:
    deeper = Violation("collision", "by 3.4 mm", 1, "move", bodies=("box", "cup"), depth=0.0034)
    assert compared(report("pybullet", HIT), report("mujoco", deeper)).notes == ()


def test_of_another_action_kind_or_body_it_is_another_one() -> None:
    others = (
        Violation("collision", "later", 2, "move", bodies=("cup", "box")),
        Violation("grasp", "another kind", 1, "move", bodies=("cup", "box")),
        Violation("collision", "another body", 1, "move", bodies=("cup", "can")),
    )
    for other in others:
        notes = compared(report("pybullet", HIT), report("mujoco", other)).notes
        assert notes == (
            f"mujoco does not see this: {HIT}",
            f"mujoco alone sees this, which does not count: {other}",
        )


def test_what_only_the_second_sees_does_not_count() -> None:
    found = compared(report("pybullet", note="odd"), report("mujoco", FALLS))
    assert found.holds
    assert found.notes == (
        "odd",
        "by mujoco alone the plan does not hold",
        f"mujoco alone sees this, which does not count: {FALLS}",
    )


def test_what_the_second_does_not_see_still_counts() -> None:
    found = compared(report("pybullet", FALLS), report("mujoco", note="of the other"))
    assert found.violations == (FALLS,) and not found.holds
    assert found.notes == (
        "by mujoco alone the plan holds",
        f"mujoco does not see this: {FALLS}",
    )
