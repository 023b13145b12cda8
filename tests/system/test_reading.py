"""Files of plans and statistics are let in only as what they should be."""

from __future__ import annotations

import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tamp.commands.solve import BAD_INPUT, SOLVED, run
from tamp.commands.verify import main as verify
from tamp.errors import InputError
from tamp.planner.statistics_file import read_statistics
from tamp.system.reading import MOST_BYTES, read_bytes, read_json


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"\xff\xfe", "not UTF-8 text"),
        (b"one\n\xff", ":2: this is no plan file"),
        (b"[" * 100_000, "nested too deeply"),
        (b'{"a":' * 100_000, "nested too deeply"),
        (b'{"a": ' + b"9" * 5_000 + b"}", "an integer of 5000 digits"),
        (b'{"a": NaN}', "NaN"),
        (b'{"a": 1, "a": 2}', "'a' is given twice"),
        (b"{", ":1:2: not JSON"),
        (b"", "not JSON"),
    ],
)
def test_what_is_no_json(content: bytes, says: str, tmp_path: Path) -> None:
    file = tmp_path / "x.json"
    file.write_bytes(content)
    with pytest.raises(InputError) as found:
        read_json(file)
    assert says in str(found.value) and str(file) in str(found.value)


def test_what_is_no_file(tmp_path: Path) -> None:
    pipe, large = tmp_path / "pipe", tmp_path / "large"
    os.mkfifo(pipe)
    with large.open("wb") as stream:
        stream.truncate(MOST_BYTES + 1)
    for path, says in [
        (pipe, "this is a pipe, no plan file"),
        (Path("/dev/zero"), "this is a device, no plan file"),
        (tmp_path, "this is a folder, no plan file"),
        (large, "no plan file is 32.0 MB large"),
        (tmp_path / ("x" * 300), "File name too long"),
        (tmp_path / "a\0b", "such a name"),
        (tmp_path / "a\ud800", "such a name"),
        (tmp_path / "none", "no such file"),
        (Path("/proc/self/mem"), "cannot be read"),
    ]:
        began = time.monotonic()
        with pytest.raises(InputError, match=says):
            read_bytes(path, kind="plan file")
        assert time.monotonic() - began < 2.0


HEAD = '{"format": "tamp-statistics", "version": 1, "domain": "cupboard", "streams": '


@pytest.mark.parametrize(
    "streams",
    [
        '{"x": {"successes": true, "failures": 1, "seconds": 0}}',
        '{"x": {"successes": 0.5, "failures": 1, "seconds": 0}}',
        '{"x": {"successes": 1, "failures": 1, "seconds": 1e999}}',
        '{"x": {"successes": 1e13, "failures": 1, "seconds": 0}}',
        '{"x": {"successes": 1' + "0" * 5000 + ', "failures": 1, "seconds": 0}}',
        '{"x": {"successes": "1", "failures": 1, "seconds": 0}}',
        '{"x": []}',
        "[]",
        "null",
        "[" * 5000,
    ],
)
def test_broken_statistics(streams: str, tmp_path: Path) -> None:
    file = tmp_path / "s.json"
    file.write_text(HEAD + streams + "}", encoding="utf-8")
    with pytest.raises(InputError, match=r"s\.json[:\d]*: .*Name another file"):
        read_statistics(file, "cupboard")


def test_statistics_of_runs_that_end_together_add_up(tmp_path: Path) -> None:
    from tamp.planner.statistics_file import add_statistics
    from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics

    file, children = tmp_path / "s.json", []
    for _ in range(8):
        child = os.fork()
        if child == 0:
            for _ in range(10):
                ran = StreamStatistics()
                ran.calls, ran.successes = 3, 2
                add_statistics(file, "cupboard", {"x": ran})
            os._exit(0)
        children.append(child)
    assert all(os.waitpid(child, 0)[1] == 0 for child in children)
    total = read_statistics(file, "cupboard")["x"]
    assert (total.successes, total.failures) == (160, 80)
    assert [path.name for path in tmp_path.iterdir()] == ["s.json"]


SECRET = "root:$6$kept.to.itself$aZ09:19000:0:99999:7:::"


@pytest.fixture(scope="module")
def plan(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    folder = tmp_path_factory.mktemp("plan")
    assert run(["one_object", "--out", str(folder / "plan.json"), "--quiet"]) == SOLVED
    return json.loads((folder / "plan.json").read_text(encoding="utf-8"))


def secret(plan: dict[str, Any], role: str, file: Path) -> dict[str, Any]:
    return {**plan, "inputs": {**plan["inputs"], role: {**plan["inputs"][role], "path": str(file)}}}


@pytest.mark.parametrize("role", ["problem", "domain"])
def test_what_a_named_file_says_is_not_repeated(
    role: str, plan: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from tamp.commands.execute import main as execute
    from tamp.commands.view import main as view

    file, hidden = tmp_path / "plan.json", tmp_path / "shadow"
    for content in (SECRET, f"({SECRET}", f"{SECRET}: [", f"name: x\n{SECRET}"):
        hidden.write_text(content, encoding="utf-8")
        file.write_text(json.dumps(secret(plan, role, hidden)), encoding="utf-8")
        commands: list[Callable[[], int]] = [
            lambda: verify([str(file)]),
            lambda: view([str(file), "--png", str(tmp_path / "x.png")]),
            lambda: execute([str(file)], dict),
        ]
        for command in commands:
            assert command() == BAD_INPUT
            said = capsys.readouterr()
            assert "kept" not in said.err + said.out and said.err.count("\n") == 1, said


@pytest.mark.parametrize(
    "options",
    [5, [], "x", {"samplers": 5}, {"samplers": {"on": 5}}, {"algorithm": 3}, {"algorithm": "none"}],
)
def test_options_that_are_none(
    options: object, plan: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from tamp.commands.execute import main as execute

    file = tmp_path / "plan.json"
    file.write_text(json.dumps({**plan, "options": options}), encoding="utf-8")
    assert execute([str(file), "--replan"], dict) == BAD_INPUT
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and ("options" in error or "algorithm" in error)


def test_numbers_that_nothing_has(
    plan: dict[str, Any], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "plan.json"
    text = json.dumps({**plan, "duration": 1.25}).replace('"duration": 1.25', '"duration": 1e300')
    file.write_text(text, encoding="utf-8")
    assert verify([str(file)]) == BAD_INPUT
    assert "duration: 1e+300 is larger than anything" in capsys.readouterr().err


def test_weights_may_be_a_link_to_a_file_of_any_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from grounding.registry import SHIPPED

    (tmp_path / "blob").write_bytes((SHIPPED / "on_transfer.safetensors").read_bytes())
    (tmp_path / "mine.json").write_bytes((SHIPPED / "on_transfer.json").read_bytes())
    weights = tmp_path / "mine.safetensors"
    weights.symlink_to("blob")
    words = [
        "one_object",
        "--sampler",
        f"on={weights}",
        "--out",
        str(tmp_path / "plan.json"),
        "--quiet",
    ]
    assert run(words) == SOLVED
    weights.unlink()
    weights.symlink_to(weights.name)
    assert run(words) == BAD_INPUT
    assert str(weights) in capsys.readouterr().err
