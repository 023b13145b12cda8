"""The words of tamp-bench: what each command takes, and mistakes in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.commands.bench_options import Draw, Fig8, Run, Tabulate, parsed
from tamp.errors import InputError


def test_defaults_and_what_is_said_counts() -> None:
    plain = parsed(["run"])
    assert isinstance(plain, Run)
    assert (plain.problems, plain.samplers, plain.seeds, plain.time) == (
        ("four_objects",),
        ("default", "uniform"),
        10,
        30.0,
    )
    assert (plain.jobs, plain.out, plain.first, plain.algorithm) == (
        None,
        Path("bench.jsonl"),
        0,
        "adaptive",
    )

    words = "run --problems swap packed --samplers on=uniform --seeds 3 --first 7 --time 2.5 "
    words += "--jobs 2 --out r.jsonl --quiet"
    said = parsed(words.split())
    assert isinstance(said, Run) and said.quiet
    assert (said.problems, said.samplers, said.seeds) == (("swap", "packed"), ("on=uniform",), 3)
    assert (said.first, said.time, said.jobs, said.out) == (7, 2.5, 2, Path("r.jsonl"))


def test_the_papers_comparison_has_its_own_defaults() -> None:
    figure = parsed(["fig8"])
    assert isinstance(figure, Fig8)
    assert (figure.seeds, figure.time, figure.out) == (100, 30.0, Path("fig8.jsonl"))


def test_tables_and_pictures_take_a_log() -> None:
    assert parsed(["table", "a.jsonl", "--against", "uniform"]) == Tabulate(
        Path("a.jsonl"), "uniform"
    )
    assert parsed(["table", "a.jsonl"]) == Tabulate(Path("a.jsonl"), None)
    assert parsed(["draw", "a.jsonl", "--out", "b"]) == Draw(Path("a.jsonl"), Path("b"))


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("", "no command. Choices: run, fig8, table, draw. See tamp-bench --help"),
        ("rn", "unknown command 'rn'.*Did you mean 'run'"),
        ("run --time 0", "--time: the time must be positive and finite, not 0"),
        ("run --time nan", "--time: the time must be positive and finite, not nan"),
        ("run --time inf", "--time: the time must be positive and finite, not inf"),
        ("run --seeds 0", "--seeds must be positive, not 0"),
        ("fig8 --jobs 0", "--jobs must be positive, not 0"),
        ("run --first -1", "--first: seeds are from 0 to"),
        (f"run --first {2**64 - 1} --seeds 2", "--first: seeds are from 0 to"),
        ("run --problems", "--problems"),
        ("run --seds 3", "seds"),
        ("table", "log|LOG"),
        ("run --seeds three", "seeds"),
    ],
)
def test_mistakes_are_said(words: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        parsed(words.split())


def test_the_last_seed_there_is_may_be_asked_for() -> None:
    last = parsed(["run", "--first", str(2**64 - 1), "--seeds", "1"])
    assert isinstance(last, Run) and last.first == 2**64 - 1
