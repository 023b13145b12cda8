"""Commands run in processes of their own: one at a time, what they say, and how they end."""

from __future__ import annotations

import time
from collections.abc import Callable

import pytest

from grounding.demonstrate import runner as module
from grounding.demonstrate.runner import CommandState, Runner

PROGRAMS = {
    "says": "import sys; print('first\\rsecond', *sys.argv[1:]); sys.exit(3)",
    "waits": "import time; print('here', flush=True); time.sleep(600)",
    "stubborn": (
        "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN);"
        "print('here', flush=True); time.sleep(600)"
    ),
    "much": "print('a' * 90_000 + 'the end')",
    "errs": "import sys; sys.stderr.write('error: no'); sys.exit(2)",
}


@pytest.fixture(autouse=True)
def programs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "PROGRAMS", PROGRAMS)


def until(runner: Runner, ready: Callable[[CommandState], bool]) -> CommandState:
    for _ in range(3000):
        state = runner.state()
        if ready(state):
            return state
        time.sleep(0.01)
    raise AssertionError(state)


def ended(state: CommandState) -> bool:
    return not state.running


def begun(state: CommandState) -> bool:
    return "here" in state.text


def test_where_nothing_was_started_nothing_runs(runner: Runner) -> None:
    assert runner.state() == CommandState("", False, None, "")
    runner.stop()


def test_what_a_command_says_and_how_it_ended(runner: Runner) -> None:
    assert runner.start("says", ["third", "a b"])
    state = until(runner, ended)
    assert (state.command, state.code) == ("says", 3)
    assert (
        state.text == "first\nsecond third a b\n"
    )  # a line that is written over is one of its own


def test_errors_are_among_what_it_says(runner: Runner) -> None:
    runner.start("errs", [])
    state = until(runner, ended)
    assert (state.code, state.text) == (2, "error: no")


def test_one_at_a_time_and_then_the_next(runner: Runner) -> None:
    assert runner.start("waits", [])
    state = until(runner, begun)
    assert state.running and state.code is None
    assert not runner.start("says", [])
    assert runner.state().command == "waits"
    runner.stop()
    assert until(runner, ended).code != 0
    assert runner.start("says", [])
    assert until(runner, ended).text.startswith("first")  # nothing is left of the other's


def test_who_does_not_end_when_asked_is_ended(runner: Runner) -> None:
    runner.start("stubborn", [])
    until(runner, begun)
    runner.stop()
    assert until(runner, ended).code == -9


def test_of_much_the_end_is_kept(runner: Runner) -> None:
    runner.start("much", [])
    text = until(runner, ended).text
    assert len(text) == module.MOST and text.endswith("athe end\n")


def test_leaving_ends_the_command() -> None:
    with Runner() as runner:
        runner.start("waits", [])
        until(runner, begun)
    assert until(runner, ended).code == -15
