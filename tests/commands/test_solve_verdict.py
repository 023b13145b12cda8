"""The last lines of tamp-solve: what the judge found, and where the plan is."""

from __future__ import annotations

import json
import shlex
from pathlib import Path

from tamp.commands.solve_verdict import closing_lines, judge_text
from tamp.plan.violation import Violation
from tamp.verification.report import Report

OUT = Path("a folder/plan.json")
WRONG = Violation("goal", "(on cup table) does not hold")


def report(*violations: Violation) -> Report:
    return Report("plan.json", violations, 3, 8.0, 100, None, {}, (), 1.0)


def test_where_the_plan_is_and_how_it_is_checked() -> None:
    (line,) = closing_lines(OUT, OUT, None)
    written, _, command = line.partition(" written. Check it: ")
    assert written.strip() == str(OUT)
    assert shlex.split(command) == ["tamp-verify", str(OUT)]


def test_the_verdict_comes_first() -> None:
    said = list(closing_lines(OUT, OUT, report()))
    assert said[0].strip() == report().text() and len(said) == 2 and " written. " in said[1]


def test_a_plan_that_does_not_hold_is_not_written() -> None:
    said = list(closing_lines(OUT, None, report(WRONG)))
    assert "(on cup table) does not hold" in said[0]
    assert said[1].strip() == f"{OUT} not written: the plan does not hold."


def test_without_a_plan_and_a_verdict_there_is_nothing_to_say() -> None:
    assert list(closing_lines(OUT, None, None)) == []


def test_what_would_be_written_is_judged_and_not_what_is_there(stored_plan: Path) -> None:
    text = stored_plan.read_text(encoding="utf-8")
    assert judge_text(text).holds
    document = json.loads(text)
    document["actions"].pop()
    assert not judge_text(json.dumps(document)).holds
