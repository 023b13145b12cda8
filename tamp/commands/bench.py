"""tamp-bench: problems x samplers x seeds, a line of results a run, tables and pictures."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from tamp.commands.bench_options import Draw, Fig8, Run, Runs, Tabulate, parsed
from tamp.errors import InputError
from tamp.system.command_line import BAD_INPUT as BAD_INPUT
from tamp.system.command_line import as_command
from tamp.system.outputs import check_outputs
from tamp.system.progress import Progress

if TYPE_CHECKING:
    from tamp.benchmark.worker_pool import WorkerPool
    from tamp.geometric.samplers.choice import Registry

BASELINE = "uniform"
"""The sampler that others are compared with unless another one is named."""

DONE = 0


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run tamp-bench and leave the process with 0, 2 for bad input, 130 interrupted."""
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


@as_command(interrupted="\ninterrupted; the same command goes on where this one was")
def run(shown: Progress, arguments: list[str]) -> int:
    """Run tamp-bench and return its exit code."""
    chosen = parsed(arguments)
    if isinstance(chosen, Tabulate):
        _print_tables(_read(chosen.log), chosen.against)
    elif isinstance(chosen, Draw):
        _draw(_read(chosen.log), chosen.out or chosen.log.with_suffix(""), chosen.log)
    elif isinstance(chosen, Fig8):
        _draw(_fig8(chosen), chosen.out.with_suffix(""), chosen.out)
    else:
        _run(chosen)
    return DONE


def _run(chosen: Run) -> list[dict[str, Any]]:
    from tamp.benchmark.case import labelled, relations

    registry = _samplers()
    samplers: dict[str, Mapping[str, str]] = {}
    sources: dict[str, str] = {}
    for sampler in chosen.samplers:
        served = relations(sampler, registry)
        label, texts = labelled(sampler, served)
        samplers[label] = served
        sources |= texts
    return _run_all(
        chosen,
        samplers,
        range(chosen.first, chosen.first + chosen.seeds),
        chosen.algorithm,
        sources,
    )


def _fig8(chosen: Fig8) -> list[dict[str, Any]]:
    from tamp.benchmark.fig8 import FIG8
    from tamp.benchmark.fig8 import chosen as among

    samplers, skipped = among(FIG8, _samplers())
    for name, why in skipped.items():
        print(f"skipped {name}: {why}", file=sys.stderr)
    return _run_all(chosen, samplers, range(chosen.seeds), "adaptive")


def _run_all(
    chosen: Runs,
    samplers: Mapping[str, Mapping[str, str]],
    seeds: range,
    algorithm: str,
    sources: Mapping[str, str] | None = None,
) -> list[dict[str, Any]]:
    """Check everything, run what is missing, print the tables; all results of the file."""
    from tamp.benchmark.case import cases, named
    from tamp.benchmark.log import RunLog
    from tamp.benchmark.progress import ProgressLine
    from tamp.benchmark.scheduler import run_all
    from tamp.geometric.samplers.choice import sampler_files
    from tamp.geometric.samplers.python_file import given_by_files
    from tamp.planner.problem import load_problem
    from tamp.planner.solve import ALGORITHMS

    if algorithm not in ALGORITHMS:
        raise InputError(f"unknown algorithm '{algorithm}'", found=algorithm, choices=ALGORITHMS)
    problems = [named(problem) for problem in chosen.problems]
    read: list[Path] = []
    for problem in dict.fromkeys(
        problems
    ):  # an error in a file is one now, and not one in each run
        for relation_samplers in samplers.values():
            names, objects = given_by_files(relation_samplers, sources)
            loaded = load_problem(problem, samplers=names, groundings=objects, registry=_registry())
            read += [file for files in loaded.files.values() for file in files]
            read += [*sampler_files(loaded.samplers.values()), *map(Path, sources or {})]
    check_outputs({"--out": chosen.out}, read)
    wanted = cases(problems, samplers, seeds, chosen.time, algorithm, sources)
    with RunLog(chosen.out) as log:
        log.check(chosen.time, algorithm)
        missing = log.missing(wanted)
        if missing:
            pool = _pool(chosen, len(missing))
            try:
                run_all(missing, pool, log, ProgressLine(len(wanted), quiet=chosen.quiet).ended)
            finally:
                pool.close()
        lines = log.lines
    _print_tables(lines)
    return lines


def _pool(chosen: Runs, runs: int) -> WorkerPool:
    from tamp.benchmark.run_case import run_case, warm_up

    work = partial(run_case, registry=_registry)
    if chosen.ray is not None:
        from tamp.benchmark.ray_pool import RayPool

        return RayPool(chosen.ray, work, warm_up, chosen.jobs)
    from tamp.benchmark.process_pool import ProcessPool

    return ProcessPool(min(chosen.jobs or os.cpu_count() or 1, runs), work, warm_up)


def _registry() -> Registry:
    """Return the learned samplers."""
    from tamp.commands.solve import registry

    return registry()


def _samplers() -> Registry:
    """Return all samplers by relation and name."""
    from tamp.geometric.samplers.registry import SAMPLERS

    learned = _registry()
    return {
        relation: {**SAMPLERS.get(relation, {}), **learned.get(relation, {})}
        for relation in dict.fromkeys([*SAMPLERS, *learned])
    }


def _read(path: Path) -> list[dict[str, Any]]:
    from tamp.benchmark.log import read_log

    return read_log(path)


def _print_tables(lines: Sequence[Mapping[str, Any]], against: str | None = None) -> None:
    from tamp.benchmark.table import report

    samplers = dict.fromkeys(line["config"]["sampler"] for line in lines)
    if (
        against is not None and against not in samplers
    ):  # of a file's version, the name alone will do
        alike = [name for name in samplers if re.sub(r"#[0-9a-f]{8}(?=,|:|$)", "", name) == against]
        against = alike[0] if len(alike) == 1 else against
    if against is not None and against not in samplers:
        raise InputError(
            f"no runs with '{against}' among the results", found=against, choices=samplers
        )
    usual = BASELINE if BASELINE in samplers and len(samplers) > 1 else None
    print(report(lines, against or usual))


def _draw(lines: Sequence[Mapping[str, Any]], folder: Path, log: Path) -> None:
    from tamp.benchmark.picture import PICTURES, draw

    check_outputs({f"the picture '{name}'": folder / f"{name}.png" for name in PICTURES}, (log,))

    for path in draw(lines, folder):
        print(f"{path} written")


if __name__ == "__main__":
    main()
