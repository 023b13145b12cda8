"""The command line of tamp-bench."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from tamp.errors import InputError
from tamp.system.options import read_command

Count = Annotated[int, tyro.conf.arg(metavar="COUNT")]
ResultFile = Annotated[Path, tyro.conf.arg(metavar="FILE")]


@dataclass(frozen=True)
class Runs:
    """The options of all commands that make runs."""

    problems: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME...")] = ("four_objects",)
    """Shipped problems' names, or files."""
    seeds: Count = 10
    """How many seeds each; all samplers get the same ones."""
    time: Annotated[float, tyro.conf.arg(metavar="SECONDS")] = 30.0
    """Of one run."""
    jobs: Annotated[
        int | None, tyro.conf.arg(metavar="COUNT", help_behavior_hint="(default: one a core)")
    ] = None
    """Runs at a time."""
    ray: Annotated[
        str | None, tyro.conf.arg(metavar="ADDRESS", help_behavior_hint="(optional)")
    ] = None
    """Run on a Ray cluster: its address, auto, or local."""
    out: ResultFile = Path("bench.jsonl")
    """Where the results are, one JSON line a run; what is there is not run again."""
    quiet: bool = False
    """No progress, only the tables."""


@dataclass(frozen=True)
class Run(Runs):
    """Run problems x samplers x seeds; the same command goes on where it was interrupted."""

    samplers: Annotated[tuple[str, ...], tyro.conf.arg(metavar="NAME...")] = ("default", "uniform")
    """NAME or NAME:alone for all relations that have it; on=NAME,inside=NAME; or default: the
    problem's own. In on=NAME it may also be a file, as for tamp-solve --sampler:
    on=weights.safetensors, or on=mine.py, which is run."""
    first: Annotated[int, tyro.conf.arg(metavar="SEED")] = 0
    """The first seed."""
    algorithm: Annotated[str, tyro.conf.arg(metavar="NAME")] = "adaptive"
    """adaptive or incremental."""


@dataclass(frozen=True)
class Fig8(Runs):
    """The paper's comparison: every sampler there is, 100 runs of 30 s each, then tables and
    pictures.
    """

    seeds: Count = 100
    """How many runs each."""
    out: ResultFile = Path("fig8.jsonl")
    """Where the results are; the pictures come into a folder of the same name without .jsonl."""


@dataclass(frozen=True)
class Tabulate:
    """Print the tables of results: success with Wilson's interval, times, time by part."""

    log: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """The results."""
    against: Annotated[
        str | None,
        tyro.conf.arg(metavar="SAMPLER", help_behavior_hint="(default: uniform, if it is there)"),
    ] = None
    """Whom the others are compared with, seed by seed."""


@dataclass(frozen=True)
class Draw:
    """Draw results: success bars, success over time (ECDF and cactus), time by part."""

    log: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="LOG")]
    """The results."""
    out: Annotated[
        Path | None,
        tyro.conf.arg(metavar="FOLDER", help_behavior_hint="(default: LOG without .jsonl)"),
    ] = None
    """Where the pictures come."""


COMMANDS = {"run": Run, "fig8": Fig8, "table": Tabulate, "draw": Draw}

Command = Run | Fig8 | Tabulate | Draw


def parsed(arguments: list[str]) -> Command:
    """Read the words of a command line.

    Raises:
        InputError: Something that the command does not know.
    """
    if arguments and not arguments[0].startswith("-") and arguments[0] not in COMMANDS:
        raise InputError(f"unknown command '{arguments[0]}'", found=arguments[0], choices=COMMANDS)
    if not arguments:
        raise InputError("no command", choices=COMMANDS, remedy="See tamp-bench --help")
    chosen = read_command(COMMANDS, "tamp-bench", arguments)
    if isinstance(chosen, Run | Fig8):
        _check(chosen)
    return chosen


def _check(chosen: Runs) -> None:
    if math.isnan(chosen.time) or not 0.0 < chosen.time < math.inf:
        raise InputError(f"--time: the time must be positive and finite, not {chosen.time:g}")
    for name, value in (("seeds", chosen.seeds), ("jobs", chosen.jobs)):
        if value is not None and value < 1:
            raise InputError(f"--{name} must be positive, not {value}")
    for name, words in (
        ("problems", chosen.problems),
        ("samplers", chosen.samplers if isinstance(chosen, Run) else "-"),
    ):
        if not words:
            raise InputError(f"--{name} names none")
    if isinstance(chosen, Run) and (chosen.first < 0 or chosen.first + chosen.seeds > 2**64):
        raise InputError("--first: seeds are from 0 to 2**64 - 1")
