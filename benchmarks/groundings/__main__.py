"""The paper's figures 4 to 7: accuracy of classifiers, success by training scenes, types of failure, times.

python -m benchmarks.groundings all --data data --weights weights/figures
python -m benchmarks.groundings fig5 --quick
python -m benchmarks.groundings all --layout paper
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import tyro

from benchmarks.common import RESULTS, ROOT, table
from benchmarks.groundings.case import FAILING, FIGURES, NAMES, SIZES, Case, Plan, cases
from benchmarks.groundings.journal import Journal
from benchmarks.groundings.library import Library
from benchmarks.groundings.measure import MEASURES
from benchmarks.groundings.pictures import draw
from benchmarks.groundings.summary import rows
from tamp.errors import InputError

QUICK = Path("weights") / "quick"
"""Where --quick has everything, unless told otherwise."""


@dataclass(frozen=True)
class Options:
    """What to measure; what the results have is not measured again.

    Attributes:
        figure: fig4, fig5, fig6, fig7, or all.
        relations: on, inside or both.
        layout: Of the scenes: our own, or as the paper's.
        models: At most these; those that a figure is not about are left out. By default all; departures are of the
            layout paper.
        sizes: Training scenes of figure 5, increasing; the last one is what the other figures are about.
        seeds: Trainings on the last size.
        scenes: Test scenes of a measurement of success; of accuracy twice as many, of times a tenth.
        cloud_scenes: The same of models on clouds.
        draws: Poses a scene, of success.
        train: Train what is missing; --no-train leaves it out.
        quick: The shape in minutes: few scenes, made if need be, little training, all in a folder of its own.
        data: The folder with RELATION_train.npz and RELATION_test.npz, or RELATION_paper_train.npz and its like; data
            by default.
        weights: The folder of trained groundings; weights/figures, or weights/figures_paper, by default.
        out: The results; benchmarks/results/groundings.jsonl, or groundings_paper.jsonl, by default.
        pictures: Their folder; docs/pictures by default.
    """

    figure: tyro.conf.Positional[Literal["fig4", "fig5", "fig6", "fig7", "all"]]
    relations: tuple[Literal["on", "inside"], ...] = ("on", "inside")
    layout: Literal["household", "paper"] = "household"
    models: tuple[str, ...] = ()
    sizes: tuple[int, ...] = SIZES
    seeds: int = 5
    scenes: int = 300
    cloud_scenes: int = 100
    draws: int = 1
    train: bool = True
    quick: bool = False
    data: Path | None = None
    weights: Path | None = None
    out: Path | None = None
    pictures: Path | None = None


def main(options: Options) -> None:
    """Measure what is missing, print the tables, draw.

    Raises:
        InputError: An unknown model, damaged results, no data and no leave to make them.
    """
    plan, library, out, folder = _arranged(options)
    journal = Journal(out, Case)
    for figure in FIGURES if options.figure == "all" else [options.figure]:
        wanted = cases(figure, plan)
        left_out = _measure(journal, wanted, library)
        found = journal.found(wanted)
        if left_out:
            print(f"{figure}: without weights, left out: {', '.join(left_out)}")
        if found:
            table(rows(figure, found), figure)
            print(f"{draw(figure, found, folder, options.layout)} written")


def _arranged(options: Options) -> tuple[Plan, Library, Path, Path]:
    """How much, with what, and where to."""
    known = NAMES if options.layout == "paper" else FAILING
    for model in options.models:
        if model not in known:
            raise InputError(f"unknown model '{model}'", found=model, choices=known)
    models = options.models or known
    paper = "" if options.layout == "household" else f"_{options.layout}"
    quick = Path(f"{QUICK}{paper}")
    data = options.data or (quick if options.quick else Path("data"))
    weights = options.weights or (quick if options.quick else Path(f"weights/figures{paper}"))
    out = options.out or (quick if options.quick else RESULTS) / f"groundings{paper}.jsonl"
    folder = options.pictures or (quick if options.quick else ROOT / "docs/pictures")
    if not options.quick:
        plan = Plan(
            options.relations,
            models,
            options.sizes,
            options.seeds,
            options.scenes,
            options.cloud_scenes,
            options.draws,
        )
        return plan, Library(data, weights, options.train, say=_say, layout=options.layout), out, folder
    sizes = (*(size for size in options.sizes if size in QUICK_SIZES), QUICK_TRAIN)
    plan = Plan(options.relations, models, sizes, 1, QUICK_TEST, QUICK_TEST // 4, options.draws)
    generate = (QUICK_TRAIN, QUICK_TEST)
    return plan, Library(data, weights, options.train, QUICK_ITERATIONS, generate, _say, options.layout), out, folder


QUICK_TRAIN, QUICK_TEST, QUICK_ITERATIONS = 200, 60, 300
"""Scenes of training and test, and iterations of the paper's networks, of --quick."""

QUICK_SIZES = (10, 100)
"""Its smaller training sets."""


def _measure(journal: Journal, wanted: list[Case], library: Library) -> list[str]:
    """Add what is missing; the names of those whose weights are missing and are not trained."""
    left_out: list[str] = []
    missing = journal.missing(wanted)
    library.train_networks(missing)
    for done, case in enumerate(missing, start=1):
        model = library.model(case)
        if model is None:
            left_out.append(f"{case.relation} {case.model} {case.samples} {case.seed}")
            continue
        found = MEASURES[case.measure](model, library, case)
        journal.add(case, **found)
        _say(f"{done} of {len(missing)}: {case.measure} {case.relation} {case.model} {case.samples} {case.seed}")
    return left_out


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


if __name__ == "__main__":
    try:
        main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
    except InputError as error:
        sys.exit(f"error: {error}")
