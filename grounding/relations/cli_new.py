"""tamp-learn new: a relation from a folder of demonstrations, and into a domain."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from grounding.cli_files import check_out
from grounding.folder_files import files_below
from grounding.relations.demonstration_file import Demonstration, demonstrations_of
from grounding.relations.files import weights_of
from grounding.relations.learner import Learned, learn
from grounding.relations.options import New
from grounding.relations.pddl_text import added, diff
from grounding.relations.pddl_words import Words
from grounding.relations.scenes import examples_of
from grounding.relations.situation import joined, situation_of
from grounding.relations.variety import missing, unvaried
from grounding.relations.words import explanations
from grounding.weights import FORMAT, write_weights
from tamp.errors import InputError
from tamp.system.outputs import check_outputs, check_writable, write_whole


def new(chosen: New) -> None:
    """Run the command.

    Raises:
        InputError: Bad demonstrations, labels from which nothing can be learned, an output that
            cannot be written, a domain that has another thing of this name.
    """
    name, out = (
        chosen.relation.lower(),
        chosen.out or Path("weights") / f"{chosen.relation}.safetensors",
    )
    read = [chosen.demos, *files_below(chosen.demos, "*.yaml")]
    if not chosen.demos.exists():
        raise InputError("no demonstrations there", file=chosen.demos, remedy="--demos FOLDER")
    check_out(out, FORMAT, read)

    shown = list(demonstrations_of(name, [chosen.demos]))
    print(f"{len(shown)} demonstrations of {name}: {_counts(shown)}")
    learned = learn(name, shown, np.random.default_rng(chosen.seed))
    for line in said(learned, shown):
        print(line)

    texts: dict[Path, tuple[str, str]] = {}
    if chosen.add_to is not None:
        count = f"{learned.count[0]} + {learned.count[1]}"
        texts = added(
            chosen.add_to,
            Words(name, learned.kinds, learned.generator.level, not learned.cannot_tell),
            f"{name}: learned from {count} demonstrations",
        )
        texts = {path: both for path, both in texts.items() if both[0] != both[1]}
        check_outputs({"--out": out, **{str(path): path for path in texts}}, read)
        for path in texts:
            check_writable(path, "--add-to")
        print(diff(texts) or f"{chosen.add_to} has {name} already")

    if chosen.dry_run:
        print("nothing written (--dry-run)")
        return
    examples = [one.plain() for one in examples_of(shown)]
    card = {"seed": chosen.seed, "examples": examples}
    write_weights(out, weights_of(learned, card))
    for path, (_, text) in texts.items():
        write_whole(path, text.encode())
    _tell(name, out, list(texts), chosen.add_to)


def said(learned: Learned, shown: list[Demonstration]) -> list[str]:
    """Return what was learned, how well, and what is missing, in lines."""
    names = shown[0].arguments
    lines = ["what it is:"]
    first, *others = explanations(learned.committee, names)
    lines.append(f"  {first}")
    lines += [f"  or: {other}" for other in others]

    held_out = learned.held_out
    if held_out is not None:
        yes, no = (round(share * 100) for share in (held_out.positive, held_out.negative))
        lines.append(
            f"held out, scene by scene ({held_out.folds} parts): "
            f"right about {yes} % of what holds, {no} % of what does not"
        )
        lines += [
            f"  it would have been wrong about {shown[row].source}" for row in held_out.wrong[:3]
        ]
    if learned.cannot_tell:
        lines.append(f"it only proposes, and cannot tell yet where it holds: {learned.cannot_tell}")

    if not learned.generator.steady:
        lines.append(
            f"{names[0]} stands on no stable face where it holds: this is told apart and proposed, "
            "and not planned, for the planner puts bodies down on such faces"
        )

    situations = joined([situation_of(one.scene, one.arguments) for one in shown])
    holds = np.array([one.holds for one in shown])
    wanting = [*missing(holds), *(text for _, text in unvaried(situations, holds, names))]
    return [*lines, *(f"missing: {text}" for text in wanting)]


def _counts(shown: list[Demonstration]) -> str:
    yes = sum(one.holds for one in shown)
    return f"it holds in {yes}, and does not in {len(shown) - yes}"


def _tell(name: str, out: Path, changed: list[Path], domain: Path | None) -> None:
    said = [str(out), *map(str, changed)]
    print(f"written: {', '.join(said)}")
    where = f"domain: {domain}" if domain is not None else "--add-to DOMAIN puts it into a domain"
    print(f"in a problem file: samplers: {{{name}: {out}}}; {where}")
