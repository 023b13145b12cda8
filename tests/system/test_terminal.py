"""What is printed does no harm, and what cannot be printed is an error of one line."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tamp.errors import InputError, one_line, printable
from tamp.system.terminal import Shown, spoken

COMMANDS = (
    "tamp-solve one_object --out p.json",
    "tamp-solve d.pddl t.pddl --out p.json",
    "tamp-verify plan.json",
    "tamp-verify plan.json --json",
    "tamp-execute plan.json",
    "tamp-export plan.json",
    "tamp-view one_object --png x.png",
    "tamp-view one_object --no-browser",
    "tamp-demo upright(o) --no-open",
    "tamp-bench table log.jsonl",
    "tamp-learn evaluate on=surface --data none.npz",
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("printing")
    (folder / "d.pddl").write_text(
        "(define (domain d) (:predicates (p)) (:action a :parameters () :precondition () :effect (p)))"
    )
    (folder / "t.pddl").write_text("(define (problem t) (:domain d) (:init) (:goal (p)))")
    config = {
        "problem": "p",
        "sampler": "default",
        "seed": 0,
        "time": 1.0,
        "algorithm": "adaptive",
        "samplers": {},
    }
    line = {
        "config": config,
        "seed": 0,
        "outcome": "SOLVED",
        "solved": True,
        "verified": True,
        "planning_s": 0.5,
    }
    (folder / "log.jsonl").write_text(json.dumps(line) + "\n")
    assert (
        subprocess.run(
            [path("tamp-solve"), "one_object", "--quiet"], cwd=folder, check=False
        ).returncode
        == 0
    )
    return folder


def path(name: str) -> str:
    return str(Path(sys.executable).with_name(name))


@pytest.mark.parametrize("where", ["full", "closed", "unread"])
@pytest.mark.parametrize("line", COMMANDS)
def test_a_standard_output_that_takes_nothing(line: str, where: str, folder: Path) -> None:
    name, *words = line.split()
    command = [path(name), *words]
    if where == "closed":
        command = ["sh", "-c", 'exec "$@" >&-', "sh", *command]
    ours, theirs = os.pipe()
    os.close(ours)
    out = os.open("/dev/full", os.O_WRONLY) if where == "full" else theirs
    ended = subprocess.run(
        command, cwd=folder, stdin=subprocess.DEVNULL, stdout=out, stderr=subprocess.PIPE, text=True, timeout=100,
        check=False,
    )  # fmt: skip
    os.close(theirs)
    assert ended.returncode == 2, ended.stderr
    *progress, last = ended.stderr.splitlines()
    assert last.startswith("error: ") and all(line.startswith("  ") for line in progress), (
        ended.stderr
    )
    if "--out p.json" in line:
        assert (folder / "p.json").is_file(), "what was found is written all the same"
        (folder / "p.json").unlink()


def test_names_do_nothing_to_a_terminal() -> None:
    evil = "a\x1b[31m\x07\u202eb\u2028\x9b\ud800"
    assert printable(evil) == r"a\x1b[31m\x07\u202eb\u2028\x9b\ud800"
    assert printable("größe 4 °C, 数 👍\u00a0m") == "größe 4 °C, 数 👍\u00a0m"
    assert printable("a\nb\r", "\n") == "a\nb\\r"
    assert one_line("a\nb\r\nc") == "a b c"
    assert (
        str(InputError(f"no {evil}\nend", file=evil))
        == rf"{printable(evil)}: no {printable(evil)} end"
    )
    assert len(str(InputError("x" * 10**6, found="y" * 10**6, choices=["z" * 1000] * 5000))) < 3000


def test_streams_escape_what_commands_print(capsys: pytest.CaptureFixture[str]) -> None:
    @spoken
    def command() -> int:
        print("\x1b[31mred\u202e\x1b]0;title\x07\r")
        print("\r  searching\x1b[K", end="", file=sys.stderr)
        return 1

    assert command() == 1
    said = capsys.readouterr()
    assert said.out == "\\x1b[31mred\\u202e\\x1b]0;title\\x07\\r\n"
    assert said.err == "\r  searching\x1b[K"  # our own line of progress


def test_a_closed_stream_swallows_and_remembers() -> None:
    shown = Shown(None)
    assert shown.failure is None and not shown.isatty()
    print("lost", file=shown, flush=True)
    assert shown.failure == "it is closed"


def test_the_name_of_a_problem_is_shown_escaped(tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text(
        'name: "a\\e[31mRED\\nSolved\\u202e"\n'
        "domain: cupboard\nrobot: {model: panda_mobile, base: [0, 0, 0]}\nroom: {x: [-2.5, 2.5], y: [-2.5, 2.5]}\n"
        "bodies:\n  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0, 0]}\n"
        "  can: {cylinder: {radius: 0.03, height: 0.1}, on: table}\ngoal: (on can table)\n"
    )
    words = [path("tamp-solve"), "p.yaml"]
    out = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False).stdout
    assert out.startswith(r"a\x1b[31mRED\nSolved\u202e: 1 goal"), out
