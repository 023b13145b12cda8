"""tamp-bench as it is typed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tamp.commands.bench import BAD_INPUT, DONE, run
from tests.benchmark.toys import line, some


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("", "no command. Choices: run, fig8, table, draw"),
        ("rnu", "Did you mean 'run'"),
        ("run --seed 3", "See tamp-bench run --help"),
        ("run --seeds 0", "--seeds must be positive"),
        ("fig8 --jobs -1", "--jobs must be positive"),
        ("run --time nan", "--time"),
        ("run --time inf", "--time"),
        ("run --first -1", "--first"),
        ("run --problems", "--problems names none"),
        ("run --problems pakced", "Did you mean 'packed'"),
        ("run --samplers unifrom", "Did you mean 'uniform'"),
        ("run --algorithm adaptiv", "Did you mean 'adaptive'"),
        ("run --out .", "cannot be written"),
        ("table none.jsonl", "none.jsonl: no such file"),
        ("draw none.jsonl", "none.jsonl: no such file"),
    ],
)
def test_a_wrong_word_is_an_error_that_helps(
    words: str,
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(words.split()) == BAD_INPUT
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_tables_and_pictures_of_a_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "log.jsonl"
    runs = some(3, ("default", "uniform"))
    log.write_text("".join(json.dumps(line(case)) + "\n" for case in runs), encoding="utf-8")
    assert run(["table", str(log)]) == DONE
    assert "faster than uniform" in capsys.readouterr().out
    assert run(["table", str(log), "--against", "default"]) == DONE
    assert "faster than default" in capsys.readouterr().out
    assert run(["table", str(log), "--against", "defualt"]) == BAD_INPUT
    assert "Did you mean 'default'" in capsys.readouterr().err
    assert run(["draw", str(log)]) == DONE
    assert (tmp_path / "log" / "ecdf.png").exists()


@pytest.mark.slow
def test_runs_are_done_written_and_not_done_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "log.jsonl"
    words = [
        "run",
        "--problems",
        "one_object",
        "--samplers",
        "default",
        "--jobs",
        "1",
        "--out",
        str(log),
    ]
    assert run([*words, "--seeds", "1"]) == DONE
    first = log.read_bytes()
    assert run([*words, "--seeds", "2"]) == DONE
    assert log.read_bytes().startswith(first)
    lines = [json.loads(text) for text in log.read_text(encoding="utf-8").splitlines()]
    assert [told["seed"] for told in lines] == [0, 1]
    for told in lines:
        assert told["outcome"] == "SOLVED" and told["verified"] is True
        assert {
            "config",
            "commit",
            "machine",
            "load",
            "parts_s",
            "planning_s",
            "cpu_s",
        } <= told.keys()
        assert {"calls", "successes", "seconds", "reasons"} == told["streams"]["sample-on"].keys()
    shown = capsys.readouterr()
    assert "2/2" in shown.out
    assert "one_object default seed 1: SOLVED" in shown.err
    assert run([*words, "--seeds", "2", "--time", "5"]) == BAD_INPUT
    assert "log.jsonl:1: a run of 30 s" in capsys.readouterr().err
