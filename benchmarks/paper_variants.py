"""The paper's networks by the way they are trained: published figure, ours, and the blind ceiling beside them.

    tamp-learn generate on --layout paper --split train
    tamp-learn generate on --layout paper --split test --count 2000
    python -m benchmarks.paper_variants --relation on --variants mlp-bb gnn-bb
    python -m benchmarks.paper_variants --relation on --layout household

Seeds of one variant train as one ensemble; what the results have is not trained again.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import mean
from typing import Any, Literal

import tyro

from benchmarks.common import RESULTS, table
from benchmarks.groundings.journal import Journal
from benchmarks.paper_ways import CHOICE, CLASSIFIERS, EDGES, PUBLISHED, TURNED, VARIANTS, WHOLE, Variant
from grounding.arguments import data_file
from grounding.dataset import Dataset, read_dataset
from grounding.evaluate import evaluate
from grounding.paper.runtime import CHOICE as TRIES
from grounding.paper.runtime import PaperModel, choosing
from grounding.registry import SHIPPED
from grounding.train import encoder_of
from grounding.weights import Weights, read_weights, write_weights
from tamp.errors import InputError


@dataclass(frozen=True)
class Case:
    """One measurement, one line of the results.

    Attributes:
        relation: "on" or "inside".
        layout: Of the scenes.
        variant: A Variant's name.
        samples: Training scenes.
        iterations: Of the classifier, and then of the generator.
        seed: Of the training.
        scenes, draws: Of the test.
    """

    relation: str
    layout: str
    variant: str
    samples: int
    iterations: int
    seed: int
    scenes: int
    draws: int

    @property
    def config(self) -> dict[str, Any]:
        """All that tells it from another one, for the record."""
        return asdict(self)


@dataclass(frozen=True)
class Options:
    """What to train and judge.

    Attributes:
        relation: on or inside.
        variants: Models, of which all ways are taken, or whole names of rows; all by default.
        seeds: Trainings of each.
        iterations: Of the classifier, and then of the generator.
        samples: Training scenes; all by default.
        scenes: Test scenes at most.
        draws: Poses a scene.
        data: The folder with RELATION_paper_train.npz and RELATION_paper_test.npz, or RELATION_train.npz and
            RELATION_test.npz of the household layout.
        weights: The folder of weights; the encoder is RELATION_encoder.safetensors in it, or else that of the
            RELATION_mlp-pc that ships.
        out: The results.
        ray: Train on a Ray cluster: its address, auto, or local; one variant a core.
        layout: Of the scenes: as the paper's, or our harder ones, which have no edge negatives.
    """

    relation: Literal["on", "inside"] = "on"
    variants: tuple[str, ...] = ()
    seeds: int = 5
    iterations: int = 30_000
    samples: int | None = None
    scenes: int = 2000
    draws: int = 9
    data: Path = Path("data")
    weights: Path = Path("weights/paper")
    out: Path = RESULTS / "paper_variants.jsonl"
    ray: str | None = None
    layout: Literal["paper", "household"] = "paper"


def main(options: Options) -> None:
    """Train and judge what is missing, print the table."""
    journal = Journal(options.out, Case)
    wanted = _wanted(options)
    sets = {name: read_dataset(options.data / name) for name in {_set_name(options, one) for one in wanted}}
    test = read_dataset(options.data / data_file(options.relation, "test", options.layout).name)
    if options.ray is not None:
        for name, data in sets.items():
            some = [one for one in wanted if _set_name(options, one) == name]
            _train_on_ray(options, some, journal, data, test)
    for variant in wanted:
        train_data = sets[_set_name(options, variant)]
        for case in journal.missing(_cases(options, variant, train_data, test)):
            weights = _weights(options, variant, case, train_data)
            started = time.process_time()
            found = evaluate(PaperModel(weights), test, case.scenes, 0, draws=case.draws)
            journal.add(case, **asdict(found), judged_s=time.process_time() - started)
            print(f"{case.variant}, seed {case.seed}: {found.published:.3f}", file=sys.stderr, flush=True)

    lines = [
        line
        for variant in wanted
        for line in journal.found(_cases(options, variant, sets[_set_name(options, variant)], test))
    ]
    if lines:
        table(_rows(options, lines), f"{options.relation}, layout {options.layout}")


def _wanted(options: Options) -> list[Variant]:
    """Choose the rows that are named, all by default, of those that the layout has.

    Raises:
        InputError: A name of none.
    """
    possible = [one for one in VARIANTS if options.layout == "paper" or EDGES not in one.departures]
    known = [*dict.fromkeys(one.model for one in possible), *(one.name for one in possible)]
    for name in options.variants:
        if name not in known:
            raise InputError(f"layout '{options.layout}' has no variant '{name}'", found=name, choices=known)
    named = {*options.variants}
    return [one for one in possible if not named or {one.name, one.model} & named]


def _set_name(options: Options, variant: Variant) -> str:
    return variant.set_name(options.relation, "train", options.layout)


def _cases(options: Options, variant: Variant, train_data: Dataset, test: Dataset) -> list[Case]:
    samples = options.samples or len(train_data)
    scenes = min(options.scenes, len(test))
    layout = str(train_data.card.get("layout"))
    return [
        Case(options.relation, layout, variant.name, samples, options.iterations, seed, scenes, options.draws)
        for seed in range(options.seeds)
    ]


def _weights(options: Options, variant: Variant, case: Case, data: Dataset) -> Weights:
    """Read the weights of a case, or train those of all seeds that have none; of proposals that the own classifier
    chooses those of the same variant without.
    """
    if variant != variant.trained:
        tries = TRIES if CHOICE in variant.departures else 1
        return choosing(_weights(options, variant.trained, case, data), tries, TURNED in variant.departures)
    paths = [_path(options, variant, case.samples, seed) for seed in range(options.seeds)]
    missing = [seed for seed, path in enumerate(paths) if not path.is_file()]
    if missing:
        from grounding.paper.training import train

        trained = train(
            data,
            variant.model,
            variant.scheme,
            sizes=[case.samples] * len(missing),
            seeds=missing,
            iterations=options.iterations,
            departures=variant.departures,
            encoder=_encoder(options, variant),
            classifiers=_trained_already(options, variant, case, missing),
            state=paths[missing[0]].with_suffix(".state"),
            progress=lambda line: print(f"{variant.name}: {line}", file=sys.stderr, flush=True),
        )
        for seed, weights in zip(missing, trained, strict=True):
            write_weights(paths[seed], weights)
        paths[missing[0]].with_suffix(".state").unlink(missing_ok=True)

    return read_weights(paths[case.seed])


def _encoder(options: Options, variant: Variant) -> Weights | None:
    if not variant.model.endswith("pc"):
        return None
    path = options.weights / f"{options.relation}_encoder.safetensors"
    return encoder_of(path if path.is_file() else SHIPPED / f"{options.relation}_mlp-pc.safetensors")


def _train_on_ray(options: Options, wanted: Sequence[Variant], journal: Journal, data: Dataset, test: Dataset) -> None:
    """Train what the results and the folder of weights lack on a cluster."""
    from benchmarks.ray_trainings import Files, Training, train_all

    plain = [one.trained for one in wanted if [*journal.missing(_cases(options, one, data, test))]]
    samples = options.samples or len(data)
    file = options.data / _set_name(options, wanted[0])
    for clouds in (False, True):
        some = [one for one in dict.fromkeys(plain) if one.model.endswith("pc") == clouds]
        trainings = [
            Training(one.model, one.scheme, one.departures, samples, options.iterations, seeds)
            for one in some
            if (seeds := tuple(s for s in range(options.seeds) if not _path(options, one, samples, s).is_file()))
        ]
        encoder = _encoder(options, some[0]) if trainings else None
        files = Files(file.read_bytes(), file.with_suffix(".json").read_bytes(), encoder)
        for training, trained in train_all(trainings, files, options.ray or "local"):
            variant = Variant(training.model, training.scheme, training.departures)
            for seed, weights in zip(training.seeds, trained, strict=True):
                write_weights(_path(options, variant, samples, seed), weights)


def _trained_already(options: Options, variant: Variant, case: Case, seeds: Sequence[int]) -> list[Weights]:
    """Read weights of these seeds with the same classifiers: of the same model shown the same features; else none."""
    for other in VARIANTS:
        same = other.model == variant.model and all(
            (name in other.departures) == (name in variant.departures) for name in CLASSIFIERS
        )
        paths = [_path(options, other, case.samples, seed) for seed in seeds]
        if same and all(path.is_file() for path in paths):
            return [read_weights(path) for path in paths]
    return []


def _path(options: Options, variant: Variant, samples: int, seed: int) -> Path:
    layout = [] if options.layout == "paper" else [options.layout]
    words = [options.relation, *layout, variant.model, variant.scheme, *variant.departures]
    return options.weights / f"{'_'.join(words)}_{samples}_{options.iterations}_{seed}.safetensors"


def _rows(options: Options, lines: Sequence[Mapping[str, Any]]) -> list[dict[str, object]]:
    """One row a variant: means over the seeds, their least and largest beside the first one."""
    rows: list[dict[str, object]] = []
    for name in dict.fromkeys(line["config"]["variant"] for line in lines):
        same = [line for line in lines if line["config"]["variant"] == name]
        here = [line["published"] for line in same]
        figures = PUBLISHED.get((options.relation, name.split()[0]), {}) if "+" not in name else {}
        published = figures.get(WHOLE)
        rows.append(
            {
                "variant": name,
                "seeds": len(same),
                "in the paper": "-" if published is None else f"{published:.2f}",
                "published oracle": f"{mean(here):.3f} ({min(here):.3f}-{max(here):.3f})",
                "at 6.3 cm": f"{mean(line['published_scaled'] for line in same):.3f}",
                "MCA": f"{mean(line['mca'] for line in same):.3f}",
                "settled": f"{mean(line['settled'] for line in same):.3f}",
                "classifier": f"{mean(line['accuracy'] for line in same):.3f}",
                "blind ceiling": f"{same[0]['blind_published']:.3f} / {same[0]['blind_mca']:.3f}",
            }
        )
    return rows


if __name__ == "__main__":
    try:
        main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
    except InputError as error:
        sys.exit(f"error: {error}")
