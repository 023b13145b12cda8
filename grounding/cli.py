"""tamp-learn: make data, train a grounding, evaluate it."""

from __future__ import annotations

import json
import sys
from dataclasses import asdict, replace
from functools import partial
from itertools import islice
from pathlib import Path
from typing import NoReturn, Protocol

from grounding.arguments import (
    Ask,
    Collect,
    Encoder,
    Evaluate,
    Explore,
    Generate,
    New,
    Show,
    Train,
    data_file,
    parsed,
)
from grounding.certainty import cannot_tell
from grounding.cli_files import (
    check_out,
    commit,
    encoder_file,
    mesh_files,
    read_data,
    with_card,
)
from grounding.dataset import FORMAT as DATA
from grounding.dataset import write_dataset
from grounding.folder_files import files_below
from grounding.mesh_folder import MeshFolder, read_folder
from grounding.variety import contradictions, monotony
from grounding.weights import FORMAT as WEIGHTS
from grounding.weights import Weights, write_weights
from tamp.errors import InputError
from tamp.system.command_line import BAD_INPUT as BAD_INPUT
from tamp.system.command_line import INTERRUPTED as INTERRUPTED
from tamp.system.command_line import as_command
from tamp.system.distribution import install_command
from tamp.system.progress import Progress

DONE = 0

SHOWN = 5
"""Contradicting pairs of rows that are named."""


class ReportProgress(Protocol):
    """Says how far the work is; the last time that it is done."""

    def __call__(self, text: str, *, last: bool = False) -> None:
        """Show a text."""
        ...


def main(arguments: list[str] | None = None) -> NoReturn:
    """Run tamp-learn and leave the process with 0, 2 for bad input, 130 interrupted."""
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


@as_command()
def run(shown: Progress, arguments: list[str]) -> int:
    """Run tamp-learn and return its exit code."""
    chosen = parsed(arguments)
    shown.quiet = False
    show = partial(_show, shown=shown)
    if isinstance(chosen, New):
        from grounding.relations.cli_new import new

        new(chosen)
    elif isinstance(chosen, Ask):
        from grounding.relations.cli_ask import ask

        ask(chosen)
    elif isinstance(chosen, Generate):
        _generate(chosen, show)
    elif isinstance(chosen, Explore):
        _explore(chosen, show)
    elif isinstance(chosen, Collect):
        _collect(chosen)
    elif isinstance(chosen, Show):
        from grounding.scene_pictures import show_scenes

        print(f"{chosen.out} written: {show_scenes(chosen)} scenes")
    elif isinstance(chosen, Encoder):
        _encoder(chosen, show)
    elif isinstance(chosen, Train):
        _train(chosen, show)
    else:
        _evaluate(chosen, show)
    return DONE


def _generate(chosen: Generate, show: ReportProgress) -> None:
    from grounding.generate import Job, generate

    out = chosen.out or data_file(chosen.relation, chosen.split, chosen.layout, chosen.edges)
    check_out(out, DATA, mesh_files(chosen))
    job = Job(
        chosen.relation, chosen.split, chosen.count, chosen.seed, _meshes(chosen), chosen.layout,
        chosen.edges,
    )  # fmt: skip
    data = generate(
        job,
        out,
        chosen.workers,
        lambda done, total: show(f"{done:,} of {total:,} scenes"),
        chosen.ray,
    )
    show("", last=True)
    print(f"{out} written: {len(data):,} scenes, {data.card['by type']}")


def _explore(chosen: Explore, show: ReportProgress) -> None:
    if chosen.demos is not None:
        from grounding.relations.cli_ask import explore_own

        explore_own(chosen.relation, chosen.demos, chosen.out, chosen.count, chosen.seed)
        return
    from grounding.exploration import Exploration, explore

    out = chosen.out or data_file(chosen.relation, "explored")
    check_out(out, DATA, [*mesh_files(chosen), *with_card(chosen.model)])
    job = Exploration(chosen.relation, chosen.count, chosen.seed, chosen.model, _meshes(chosen))
    data = explore(
        job, out, chosen.workers, lambda done, total: show(f"{done:,} of {total:,} scenes")
    )
    show("", last=True)
    print(
        f"{out} written: {len(data):,} scenes of {data.card['trials']:,} trials, "
        f"{data.card['by type']}"
    )


def _collect(chosen: Collect) -> None:
    from grounding.collect import collect, read_demonstrations, unstable

    out = chosen.out or data_file(chosen.relation, "train")
    check_out(
        out, DATA, [file for path in chosen.files for file in (path, *files_below(path, "*.yaml"))]
    )
    data = collect(chosen.relation, read_demonstrations(chosen.relation, chosen.files))
    for text in (*unstable(data), *monotony(data)):
        print(f"warning: {text}", file=sys.stderr)
    write_dataset(out, data)
    print(f"{out} written: {len(data):,} scenes, {data.card['by type']}")


def _encoder(chosen: Encoder, show: ReportProgress) -> None:
    out = chosen.out or encoder_file(chosen.relation)
    check_out(out, WEIGHTS, with_card(chosen.data or data_file(chosen.relation, "train")))
    varied = chosen.shapes == "varied"
    data = None if varied else read_data(chosen.data, chosen.relation, "train")
    try:
        from grounding.paper.encoders import EncoderOptions, train_encoder
    except ImportError as error:
        raise _missing(error) from None

    args = EncoderOptions(seed=chosen.seed, shapes=chosen.shapes)
    args = replace(
        args, iterations=chosen.iterations or args.iterations, points=chosen.points or args.points
    )
    arrays, score = train_encoder(data, chosen.kind, chosen.scaling, args, show)
    show("", last=True)
    card = {
        "model": "encoder",
        "kind": chosen.kind,
        "scaling": chosen.scaling,
        "shapes": chosen.shapes,
        "relation": chosen.relation,
        "seed": chosen.seed,
        "iterations": args.iterations,
        "validation Chamfer distance": score,
        "commit": commit(),
    }
    write_weights(out, Weights(arrays, card))
    print(f"{out} written, validation Chamfer distance {score:.3e}")


def _train(chosen: Train, show: ReportProgress) -> None:
    from grounding.train import OPTIONS, TrainArgs, check, train

    out = chosen.out or Path("weights") / f"{chosen.relation}_{chosen.model}.safetensors"
    encoder = chosen.encoder
    if (
        encoder is None
        and chosen.model in OPTIONS["encoder"]
        and encoder_file(chosen.relation).is_file()
    ):
        encoder = encoder_file(chosen.relation)
    args = TrainArgs(
        samples=chosen.samples,
        seed=chosen.seed,
        scheme=chosen.scheme,
        departures=chosen.departures or None,
        iterations=chosen.iterations,
        encoder=encoder,
        state=out.with_suffix(".state"),
        commit=commit(),
    )
    check(chosen.relation, chosen.model, args)
    read = [*with_card(chosen.data or data_file(chosen.relation, "train")), *with_card(encoder)]
    check_out(out, WEIGHTS, read, args.state)
    data = read_data(chosen.data, chosen.relation, "train")
    file = chosen.data or data_file(chosen.relation, "train")
    for text in monotony(data, chosen.samples):
        print(f"warning: {file}: {text}", file=sys.stderr)
    for first, second in islice(contradictions(data), SHOWN):
        what = f"rows {first} and {second} are the same situation, labelled both ways"
        print(f"warning: {file}: array 'holds', {what}", file=sys.stderr)
    try:
        weights = train(data, chosen.model, args, show)
    except ImportError as error:
        raise _missing(error) from None
    show("", last=True)
    write_weights(out, weights)
    out.with_suffix(".state").unlink(missing_ok=True)
    why = cannot_tell(weights.card)
    if why is not None:
        text = f"it only proposes, and cannot tell yet where '{chosen.relation}' holds: {why}"
        print(f"warning: {text}", file=sys.stderr)
    print(f"{out} written. Judge it: tamp-learn evaluate {out}")


def _evaluate(chosen: Evaluate, show: ReportProgress) -> None:
    from grounding.evaluate import evaluate, wilson
    from grounding.registry import is_few_shot, load_model, shipped_model
    from grounding.weights import read_weights

    if is_few_shot(chosen.weights):
        from grounding.relations.cli_evaluate import evaluate_own

        wanted = (chosen.scenes or 50, chosen.seed)
        evaluate_own(Path(chosen.weights), chosen.demos, chosen.pictures, *wanted)
        return
    relation, equals, name = chosen.weights.partition("=")
    if equals and not chosen.weights.endswith(".safetensors"):
        model = shipped_model(relation, chosen.model or name)
    else:
        model = load_model(Path(chosen.weights), chosen.model)
        relation = str(read_weights(Path(chosen.weights)).card.get("relation"))
    data = read_data(chosen.data, relation, "test")
    found = evaluate(
        model,
        data,
        chosen.scenes,
        chosen.seed,
        lambda done, total: show(f"{done} of {total} scenes"),
        chosen.draws,
    )
    show("", last=True)
    for name, share in (
        ("settled", found.settled),
        ("MCA", found.mca),
        ("feasible", found.feasible),
    ):
        low, high = wilson(share, found.scenes)
        print(f"{name:9} {share:.4f}  [{low:.4f}, {high:.4f}]")
    print(f"published {found.published:.4f}  by the published oracle at 3 cm")
    print(f"          {found.published_scaled:.4f}  at 6.3 cm, which it comes to for clouds")
    print(f"ceiling   {found.blind_mca:.4f}  MCA of an ideal generator that sees no surroundings")
    print(f"          {found.blind_published:.4f}  by the published oracle")
    print(f"          {found.blind_corner:.4f}  the same of one that goes to the corners")
    print(f"accuracy  {'-' if found.accuracy is None else f'{found.accuracy:.4f}'}")
    print(f"one pose  {found.milliseconds:.2f} ms")
    print(json.dumps(asdict(found)))


def _meshes(chosen: Generate | Explore) -> MeshFolder | None:
    """Read the folder of one's own meshes, and say what there is to say of them."""
    if chosen.meshes is None:
        return None
    folder = MeshFolder(chosen.meshes, chosen.mesh_scale)
    for text in read_folder(folder).warnings:
        print(f"warning: {text}", file=sys.stderr)
    return folder


def _missing(error: ImportError) -> InputError:
    return InputError(f"training needs {error.name}", remedy=install_command("learn"))


def _show(text: str, *, last: bool = False, shown: Progress) -> None:
    """Show how far it is, on a line that a terminal rewrites; elsewhere printed now and then."""
    if last:
        shown.clear()
    else:
        shown.news(text)  # the first one starts the clock


if __name__ == "__main__":
    main()
