"""What is said meanwhile: at least every two seconds, and nothing that was shown ever shrinks."""

from __future__ import annotations

import io
import re
import sys
import time

import pytest

from tamp.commands.solve import NO_PLAN, run
from tamp.planner.report import time_shares
from tamp.symbolic.algorithms.result import Outcome, SearchStatistics
from tamp.system.progress import SILENCE_S, Progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def numbers(text: str) -> list[tuple[int, int, float]]:
    """Skeletons, samples and seconds of all lines."""
    found = re.findall(r"(\d+) skeletons · ([\d,]+) samples · ([\d.]+) s", text)
    return [(int(a), int(b.replace(",", "")), float(c)) for a, b, c in found]


def test_counters_never_shrink_whoever_reports(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setattr("tamp.system.progress.REWRITE_INTERVAL_S", 0.0)
    progress = Progress(quiet=False)
    for skeletons, draws in (
        (1, 10),
        (3, 500),
        (0, 7),
        (2, 90),
    ):  # the third has counters of its own
        progress.update(SearchStatistics(skeletons=skeletons, draws=draws))
    progress.begin("trying without lamp")
    for skeletons, draws in ((0, 5), (1, 20), (0, 3)):
        progress.update(SearchStatistics(skeletons=skeletons, draws=draws))
    progress.end()
    shown = numbers(terminal.getvalue())
    assert len(shown) >= 6 and shown == sorted(shown)
    assert shown[-1][:2] == (4, 520) and "trying without lamp" in terminal.getvalue()


def test_a_long_silence_has_its_line(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress(quiet=False)
    progress.begin("searching")
    try:
        time.sleep(2 * SILENCE_S + 1.0)  # no news at all: the main thread is in a long search
    finally:
        progress.end()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) >= 2 and all(line.strip().startswith("searching") for line in lines)
    time.sleep(SILENCE_S + 0.5)
    assert capsys.readouterr().err == ""


def test_quiet_is_quiet(capsys: pytest.CaptureFixture[str]) -> None:
    progress = Progress(quiet=True)
    progress.begin("searching")
    progress.update(SearchStatistics(skeletons=1, draws=5))
    progress.line("news")
    progress.end()
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    "parts",
    [{}, {"search": 0.3}, {"a": 1.0, "b": 1.0, "c": 1.0}, {"a": 2.9996, "b": 0.0001}, {"a": 5.0}],
)
def test_shares_add_up(parts: dict[str, float]) -> None:
    shares = time_shares(parts, 3.0, "other")
    assert sum(share for _, share in shares) == 100 and all(share > 0 for _, share in shares)


SEALED = """
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
  stand: {box: [0.4, 0.4, 0.6], at: [-1.4, 0.3, 0.3], fixed: true}
  monitor: {box: [0.39, 0.39, 0.3], on: stand, at: [0.0, 0.0], fixed: true, surfaces: {}}
  post: {box: [0.07, 0.07, 0.6], at: [-1.4, -0.7, 0.3], fixed: true}
  can: {cylinder: {radius: 0.038, height: 0.1}, on: table, at: [0.0, 0.0]}
  cup: {cylinder: {radius: 0.038, height: 0.1}, on: table, at: [0.0, 0.2]}
  mug: {cylinder: {radius: 0.038, height: 0.1}, on: table, at: [0.0, -0.2]}
goal: GOAL
"""

CROWDED = "(and (on can post) (on cup post) (on mug post))"
"""Each has room there alone and beside another one; what rules out three is not proven."""


@pytest.mark.parametrize(
    ("goal", "outcome"),
    [(CROWDED, Outcome.TIMEOUT), ("(and (on can table) (on can stand))", Outcome.INFEASIBLE)],
)
def test_the_time_line_adds_up_to_what_passed(
    goal: str,
    outcome: Outcome,
    tmp_path_factory: pytest.TempPathFactory,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    path.write_text(SEALED.replace("GOAL", goal), encoding="utf-8")
    began = time.monotonic()
    assert run([str(path), "--time", "3"]) == NO_PLAN
    passed = time.monotonic() - began
    text = capsys.readouterr().out
    assert ("infeasible" in text) == (outcome is Outcome.INFEASIBLE)
    line = re.search(
        r"^  time     ([\d.]+) s after ([\d.]+) s of loading: (.*(?:\n {11}.*)*)",
        text,
        re.MULTILINE,
    )
    assert line is not None, text
    assert float(line[1]) + float(line[2]) == pytest.approx(passed, abs=0.7)
    assert sum(int(share) for share in re.findall(r"(\d+) %", line[3])) == 100
