"""tamp-learn: make data, train a grounding, evaluate it."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated

import tyro

from tamp.errors import InputError

DONE, BAD_INPUT, INTERRUPTED = 0, 2, 130


@dataclass(frozen=True)
class Generate:
    """Make labelled scenes in physics; an interrupted run goes on where it was."""

    relation: Annotated[str, tyro.conf.Positional]
    """on or inside."""
    split: str = "train"
    """train or test; they share no object and no support."""
    count: int = 20000
    """Scenes; half of them are positive."""
    seed: int = 0
    """Of all randomness: the same seed gives the same bytes."""
    out: Path | None = None
    """The file; by default data/RELATION_SPLIT.npz."""
    meshes: Path | None = None
    """A folder with one mesh a subfolder (as the YCB set comes), to join the objects."""
    workers: int | None = None
    """Processes; by default one a core."""


@dataclass(frozen=True)
class Train:
    """Train a grounding on a data set."""

    relation: Annotated[str, tyro.conf.Positional]
    """on or inside."""
    model: str = "transfer"
    """Which grounding."""
    samples: int | None = None
    """Use only the first so many scenes."""
    seed: int = 0
    """Of initial weights and batches."""
    data: Path | None = None
    """The data set; by default data/RELATION_train.npz."""
    out: Path | None = None
    """The weights; by default weights/RELATION_MODEL.safetensors."""


@dataclass(frozen=True)
class Evaluate:
    """Judge a grounding on scenes that it never saw."""

    weights: Annotated[Path, tyro.conf.Positional]
    """A weight file (.safetensors)."""
    data: Path | None = None
    """The data set; by default data/RELATION_test.npz of the weights' relation."""
    scenes: int | None = None
    """At most so many scenes."""
    seed: int = 0
    """Of the scenes' order and of the draws."""


def main(arguments: list[str] | None = None) -> None:
    """Run tamp-learn and leave the process with 0, 2 for bad input, 130 interrupted."""
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def run(arguments: list[str]) -> int:
    """Run tamp-learn and return its exit code."""
    try:
        chosen = tyro.extras.subcommand_cli_from_dict(
            {"generate": Generate, "train": Train, "evaluate": Evaluate}, prog="tamp-learn", args=arguments
        )
        if isinstance(chosen, Generate):
            _generate(chosen)
        elif isinstance(chosen, Train):
            _train(chosen)
        else:
            _evaluate(chosen)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    return DONE


def _generate(chosen: Generate) -> None:
    from grounding.generate import Job, generate

    out = chosen.out or Path("data") / f"{chosen.relation}_{chosen.split}.npz"
    job = Job(chosen.relation, chosen.split, chosen.count, chosen.seed, chosen.meshes)
    data = generate(
        job, _suffixed(out, ".npz"), chosen.workers, lambda done, total: _show(f"{done:,} of {total:,} scenes")
    )
    _show("", last=True)
    print(f"{out} written: {len(data):,} scenes, {data.card['by type']}")


def _train(chosen: Train) -> None:
    from grounding.dataset import read_dataset
    from grounding.train import TRAINERS, TrainArgs
    from grounding.weights import write_weights

    if chosen.model not in TRAINERS:
        raise InputError(f"unknown model '{chosen.model}'", found=chosen.model, choices=TRAINERS)
    if chosen.samples is not None and chosen.samples < 1:
        raise InputError(f"--samples must be positive, not {chosen.samples}")
    data = read_dataset(chosen.data or Path("data") / f"{chosen.relation}_train.npz")
    if data.relation != chosen.relation:
        raise InputError(f"the data are about '{data.relation}', not '{chosen.relation}'", file=chosen.data)
    args = TrainArgs(samples=chosen.samples, seed=chosen.seed, commit=_commit())
    try:
        weights = TRAINERS[chosen.model](data, args, _show)
    except ImportError as error:
        raise InputError(f"training needs {error.name}", remedy="pip install tamp[learn]") from None
    _show("", last=True)
    out = _suffixed(chosen.out or Path("weights") / f"{chosen.relation}_{chosen.model}.safetensors", ".safetensors")
    write_weights(out, weights)
    print(f"{out} written. Judge it: tamp-learn evaluate {out}")


def _evaluate(chosen: Evaluate) -> None:
    from grounding.dataset import read_dataset
    from grounding.evaluate import evaluate, wilson
    from grounding.registry import load_model
    from grounding.weights import read_weights

    model = load_model(chosen.weights)
    relation = str(read_weights(chosen.weights).card.get("relation"))
    data = read_dataset(chosen.data or Path("data") / f"{relation}_test.npz")
    found = evaluate(model, data, chosen.scenes, chosen.seed, lambda done, total: _show(f"{done} of {total} scenes"))
    _show("", last=True)
    for name, share in (("settled", found.settled), ("MCA", found.mca), ("feasible", found.feasible)):
        low, high = wilson(share, found.scenes)
        print(f"{name:9} {share:.4f}  [{low:.4f}, {high:.4f}]")
    print(f"accuracy  {found.accuracy:.4f}\none pose  {found.milliseconds:.2f} ms")
    print(json.dumps(asdict(found)))


def _suffixed(path: Path, suffix: str) -> Path:
    if path.suffix != suffix:
        raise InputError(f"the file must end in {suffix}", file=path)
    return path


def _commit() -> str:
    """The commit of the checkout that this runs from; empty outside one."""
    folder = Path(__file__).resolve().parent
    try:
        said = subprocess.run(
            ["git", "rev-parse", "--short", "HEAD"], cwd=folder, capture_output=True, text=True, check=False
        )
    except OSError:
        return ""
    return said.stdout.strip()


_WIDTH = 60


def _show(text: str, *, last: bool = False) -> None:
    """A line on a terminal that is rewritten."""
    if sys.stderr.isatty():
        print(f"\r{text:<{_WIDTH}}", end="\r" if last else "", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
