"""tamp-demo as a command."""

from __future__ import annotations

import contextlib
import json
import re
import signal
import socket
import subprocess
import sys
import urllib.request
import webbrowser
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from grounding.demonstrate.command import main
from grounding.demonstrate.server import DemonstrationServer
from grounding.relations.demonstration_file import demonstrations_of

PROGRAM = Path(sys.executable).parent / "tamp-demo"


def interrupted(*_: Any) -> None:
    raise KeyboardInterrupt


def test_the_browser_is_opened_at_the_served_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    opened: list[str] = []
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(webbrowser, "get", lambda *_: None)
    monkeypatch.setattr(webbrowser, "open", opened.append)
    monkeypatch.setattr(DemonstrationServer, "serve_forever", interrupted)
    assert main(["upright(o)"]) == 0
    (address,) = opened
    said = capsys.readouterr().out
    assert f"{address} shows upright(o) until Ctrl-C." in said and "demos/upright" in said
    assert main(["upright(o)", "--no-open"]) == 0 and len(opened) == 1
    assert list(tmp_path.iterdir()) == []  # nothing is made before something is shown


def test_bad_input_is_one_line_and_exit_code_two(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(webbrowser, "get", lambda *_: (_ for _ in ()).throw(webbrowser.Error))
    Path("file").write_text("", encoding="utf-8")
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        cases = [
            (
                ["stack(a, b)", "--no-open", "--port", port],
                f"cannot listen on port {port}: Address already in use",
            ),
            (["stack(a, b)", "--no-open", "--port", "70000"], "cannot listen on port 70000"),
            (["stack(a, b)"], "no browser was found to open. Serve with tamp-demo --no-open"),
            (["stack"], "'stack' is no relation with its arguments. Such as stack(a, b)"),
            (["stack(a, b: bax)"], "unknown kind 'bax'. Choices: object, box"),
            (
                ["stack(a, b)", "--out", "file", "--no-open"],
                "file: demonstrations go into a folder, and this is none",
            ),
            (["stack(a, b)", "--scene", "none.yaml", "--no-open"], "none.yaml"),
            (
                ["near(a, b, c)", "--scene", "one_object", "--no-open"],
                "too few bodies or places for near(a, b, c)",
            ),
            (["stack(a, b)", "--seed", "-1", "--no-open"], "--seed must be between"),
            (["stack(a, b)", "--wrong"], "--wrong"),
        ]
        for words, says in cases:
            assert main(words) == 2, words
            error = capsys.readouterr().err
            assert error.startswith("error: ") and says in error and error.count("\n") == 1, (
                words,
                error,
            )
    assert sorted(file.name for file in tmp_path.iterdir()) == ["file"]


def test_help(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="0"):
        main(["--help"])
    said = capsys.readouterr().out
    for word in (
        "--out",
        "--scene",
        "--port",
        "--no-open",
        "--seed",
        "demonstrating.md",
        "inside(a, b",
    ):
        assert word in said


@contextlib.contextmanager
def served(folder: Path, *words: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    process = subprocess.Popen(
        [PROGRAM, *words, "--no-open", "--out", str(folder)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    address = re.match(r"(http://\S+/) shows", process.stdout.readline())
    assert address is not None, process.stderr.read() if process.stderr else ""
    try:
        yield process, address[1]
    finally:
        process.kill()
        process.communicate()


def post(address: str, action: str, **message: Any) -> dict[str, Any]:
    request = urllib.request.Request(
        address + action, json.dumps(message).encode(), {"Content-Type": "application/json"}
    )
    with urllib.request.urlopen(request, timeout=60) as answer:
        return json.load(answer)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_ending_it_loses_nothing_and_it_goes_on_there(
    number: int, code: int, tmp_path: Path
) -> None:
    folder = tmp_path / "shown"
    with served(folder, "stack(a, b)") as (process, address):
        for holds in (True, False):
            said = post(address, "label", stage=0, poses={}, holds=holds, anyway=True)
            assert said["saved"]
        process.send_signal(number)
        assert process.wait(30) == code
        assert process.stderr is not None and process.stderr.read() == ""
    assert sorted(file.name for file in folder.iterdir()) == ["stack_001.yaml", "stack_002.yaml"]
    assert [one.holds for one in demonstrations_of("stack", [folder])] == [True, False]

    with (
        served(folder) as (process, address),
        urllib.request.urlopen(address + "state", timeout=60) as answer,
    ):
        state = json.load(answer)  # the relation is the folder's
        assert state["relation"]["text"] == "stack(a, b)" and (
            state["holding"],
            state["other"],
        ) == (1, 1)
