"""Results on the disk: what is there is not run again, and what is damaged is named."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tamp.benchmark.log import RunLog, read_log
from tamp.errors import InputError
from tests.benchmark.toys import line, some


def test_what_is_there_is_not_missing(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "log.jsonl"
    runs = some(3)
    with RunLog(path) as log:
        assert log.missing([*runs, runs[0]]) == runs
        log.add(line(runs[1], broken=float("inf")))
    with RunLog(path) as log:
        assert log.missing(runs) == [runs[0], runs[2]]
    assert [found["broken"] for found in read_log(path)] == [None]


@pytest.mark.parametrize("rest", ["", '{"config": {"prob', '{"half": "ü'])
def test_a_half_written_last_line_is_repaired(rest: str, tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    whole = json.dumps(line(some(1)[0])) + "\n"
    path.write_bytes(whole.encode() + rest.encode()[:-1] + b"\xc3" * bool(rest))
    assert len(read_log(path)) == 1
    with RunLog(path) as log:
        assert [case.seed for case in log.missing(some(2))] == [1]
        log.add(line(some(2)[1]))
    assert [found["seed"] for found in read_log(path)] == [0, 1]


def test_a_first_line_that_is_half_written_leaves_nothing(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    path.write_text('{"config"', encoding="utf-8")
    with RunLog(path) as log:
        assert log.lines == []
    assert path.read_bytes() == b""


@pytest.mark.parametrize(
    "damage",
    [
        "",
        "nonsense",
        "[]",
        "{}",
        '{"config": {}}',
        json.dumps({**line(some(1)[0]), "planning_s": "soon"}),
    ],
)
def test_a_damaged_line_is_named(damage: str, tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    good = json.dumps(line(some(1)[0]))
    path.write_text(f"{good}\n{damage}\n{good}\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"log\.jsonl:2: no result of tamp-bench"):
        RunLog(path)
    with pytest.raises(InputError, match=r"log\.jsonl:2: "):
        read_log(path)
    assert damage in path.read_text(encoding="utf-8")  # nothing of the user's is touched


def test_other_settings_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    with RunLog(path) as log:
        log.add(line(some(1)[0]))
        log.check(30.0, "adaptive")
        with pytest.raises(
            InputError, match=r"log\.jsonl:1: a run of 30 s with 'adaptive' among those of 10 s"
        ):
            log.check(10.0, "adaptive")
        with pytest.raises(InputError, match="'incremental'"):
            log.check(30.0, "incremental")
    with path.open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(line(some(1, time=5.0)[0])) + "\n")
    with pytest.raises(InputError, match=r"log\.jsonl:2: a run of 5 s"):
        read_log(path)


def test_two_cannot_add_to_the_same_results(tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    with RunLog(path), pytest.raises(InputError, match="another process"):
        RunLog(path)
    with RunLog(path):
        pass


def test_what_cannot_be_read_or_written_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written"):
        RunLog(tmp_path)
    with pytest.raises(InputError, match="no such file"):
        read_log(tmp_path / "none.jsonl")
    (tmp_path / "empty.jsonl").touch()
    with pytest.raises(InputError, match="no results yet"):
        read_log(tmp_path / "empty.jsonl")


@pytest.mark.parametrize("name", ["/dev/zero", "/dev/null", "."])
def test_no_device_is_read(name: str) -> None:
    with pytest.raises(InputError):
        read_log(Path(name))


def test_the_logs_that_ship_are_read(root: Path) -> None:
    logs = sorted((root / "benchmarks/results").glob("bench_*.jsonl"))
    assert logs
    for log in logs:
        assert len(read_log(log)) > 10
