"""tamp-verify: what it asks the judge for, how it ends and what it prints of a verdict."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import pytest

from tamp.commands import verify as module
from tamp.commands.verify import main
from tamp.errors import InputError
from tamp.plan.violation import Violation
from tamp.verification.report import Report

HOLDS = Report("plan.json", (), 2, 4.0, 100, None, {}, (), 0.1)
ON_TRUST = replace(HOLDS, on_trust=("upright",))
FAILS = replace(HOLDS, violations=(Violation("goal", "(on cup table) does not hold"),))


@pytest.fixture
def verdict(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The verdict to come stands in front; what the judge was asked with comes behind it."""
    found: list[Any] = [HOLDS]

    def verify(*names: object, **options: object) -> Report:
        found.append((names, options))
        return found[0]

    monkeypatch.setattr(module, "verify", verify)
    monkeypatch.setattr(module, "classifiers_of", lambda texts: {"read from": texts})
    return found


def test_what_is_said_reaches_the_judge(verdict: list[Any]) -> None:
    words = "--problem p.yaml --domain d.pddl --streams s.pddl --engine both --sampler a=b.py"
    assert main(["plan.json", *words.split(), "--quiet"]) == 0
    assert main(["plan.json", "--quiet"]) == 0
    said, usual = verdict[1:]
    assert said[0] == ("plan.json", "p.yaml", "d.pddl")
    assert said[1] == {
        "streams": "s.pddl",
        "classifiers": {"read from": ("a=b.py",)},
        "engine": "both",
    }
    assert usual[0] == ("plan.json", None, None)
    assert usual[1] == {"streams": None, "classifiers": {"read from": ()}, "engine": None}


@pytest.mark.parametrize(
    ("report", "words", "code"),
    [
        (HOLDS, [], 0),
        (HOLDS, ["--strict"], 0),
        (ON_TRUST, [], 0),
        (ON_TRUST, ["--strict"], 1),
        (FAILS, [], 1),
        (FAILS, ["--strict"], 1),
    ],
)
def test_strict_accepts_nothing_on_trust(
    report: Report,
    words: list[str],
    code: int,
    verdict: list[Any],
    capsys: pytest.CaptureFixture[str],
) -> None:
    verdict[0] = report
    assert main(["plan.json", *words]) == code
    said = capsys.readouterr().out
    assert said.startswith(report.text())
    assert ("not accepted, for --strict" in said) == (report is ON_TRUST and code == 1)
    assert main(["plan.json", *words, "--json"]) == code
    document = json.loads(capsys.readouterr().out)
    assert document["accepted"] is (code == 0) and document["holds"] is (report is not FAILS)
    assert main(["plan.json", *words, "--quiet"]) == code
    assert capsys.readouterr().out == ""


def test_what_cannot_be_read_ends_with_2(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def verify(*_: object, **__: object) -> Report:
        raise InputError("no such file: plan.json")

    monkeypatch.setattr(module, "verify", verify)
    assert main(["plan.json", "--quiet"]) == 2
    assert "no such file: plan.json" in capsys.readouterr().err
