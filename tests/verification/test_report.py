"""The judge's report: a verdict in words, and the same for programs."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from tamp.plan.violation import Violation
from tamp.verification.collision_sweep import PairDistance
from tamp.verification.report import Report

GOOD = Report("plan.json", (), 4, 12.34, 12_345, None, {}, (), 0.56, engine="mujoco")
DEEP = Violation("collision", "base and table penetrate", 1, "move", 2.0, ("base", "table"), 0.01)
GOAL = Violation("goal", "(on cup table) does not follow")


def test_a_plan_that_holds_is_one_line() -> None:
    assert GOOD.holds and GOOD.checked
    assert GOOD.text() == "plan.json holds: 4 actions, 12.3 s, 12,345 states checked in 0.6 s"
    still = replace(GOOD, duration=0.0, states=0)
    assert still.text() == "plan.json holds: 4 actions, 0 states checked in 0.6 s"


@pytest.mark.parametrize(
    ("violations", "counted"),
    [
        ((GOAL,), "1 violation (1 goal)"),
        ((DEEP, GOAL, DEEP), "3 violations (2 collision, 1 goal)"),
    ],
)
def test_violations_are_lines_and_counted_by_kind(
    violations: tuple[Violation, ...], counted: str
) -> None:
    report = replace(GOOD, violations=violations)
    *lines, last = report.text().splitlines()
    assert not report.holds and lines == [f"  {one}" for one in violations]
    assert last.startswith(f"plan.json does not hold, {counted}: 4 actions")


def test_the_nearest_miss_and_who_was_asked_are_told() -> None:
    near = PairDistance("base", "table", 0.00456, 3.0)
    asked = replace(GOOD, nearest=near, asked={"near": 7}, states=5)
    assert "5 states checked, least clearance 4.6 mm (base - table), near asked 7 times in" in (
        asked.text()
    )


def test_what_it_rests_on_belongs_to_the_verdict() -> None:
    trusting = replace(GOOD, on_trust=("left_of", "near"))
    assert trusting.holds and not trusting.checked
    assert trusting.text().startswith("plan.json holds, on trust: left_of, near: 4 actions")
    other = replace(GOOD, other_files=("by another domain",))
    assert not other.checked and "plan.json holds, by another domain: " in other.text()
    wrong = replace(GOOD, violations=(GOAL,), on_trust=("near",))
    assert "does not hold, 1 violation (1 goal), on trust: near: " in wrong.text()


def test_a_note_and_a_name_are_one_line_each() -> None:
    noted = replace(GOOD, name="bad\nname.json", notes=("it\nfloats",))
    lines = noted.text().splitlines()
    assert len(lines) == 2 and lines[0].startswith("  note: it") and "floats" in lines[0]


def test_programs_read_the_same() -> None:
    near = PairDistance("base", "table", 0.004, 3.0)
    report = replace(GOOD, violations=(DEEP,), nearest=near, trusted={"kin": 2}, on_trust=("near",))
    told = json.loads(json.dumps(report.json()))
    assert (told["holds"], told["checked"], told["engine"]) == (False, False, "mujoco")
    assert told["violations"][0]["bodies"] == ["base", "table"]
    assert told["violations"][0]["depth"] == 0.01 and told["clearance"]["distance"] == 0.004
    assert told["trusted"] == {"kin": 2} and told["on_trust"] == ["near"]
    assert GOOD.json()["clearance"] is None and GOOD.json()["violations"] == []
