"""The files of tamp-learn: what a command reads, and what it may write."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

from grounding.arguments import Explore, Generate, data_file
from grounding.dataset import Dataset, read_dataset
from grounding.folder_files import files_below
from tamp.errors import InputError
from tamp.system.outputs import check_outputs, check_writable


def read_data(path: Path | None, relation: str, split: str) -> Dataset:
    """Read the data set at `path`, or the default one of a split, about this relation.

    Raises:
        InputError: As for `read_dataset`, or the data are about another relation.
    """
    path = path or data_file(relation, split)
    data = read_dataset(path)
    if data.relation != relation:
        raise InputError(f"the data are about '{data.relation}', not '{relation}'", file=path)
    return data


def with_card(path: Path | None) -> list[Path]:
    """Return the path of a file of data or weights, and that of its card."""
    return [] if path is None else [path, path.with_suffix(".json")]


def mesh_files(chosen: Generate | Explore) -> list[Path]:
    """Find the files of the folder of one's own meshes."""
    return [] if chosen.meshes is None else files_below(chosen.meshes)


def check_out(out: Path, form: str, read: list[Path], state: Path | None = None) -> None:
    """Refuse an output that cannot be written, or that (or whose card) would take the place of
    something else.

    Raises:
        InputError: As for `check_writable` and `check_outputs`, or the .json beside it is no card
            of this form.
    """
    card = out.with_suffix(".json")
    for path in (out, card):
        check_writable(path)
    try:
        found = json.loads(card.read_text(encoding="utf-8")) if card.is_file() else {"format": form}
    except (OSError, ValueError, RecursionError):
        found = None  # no card at all
    if not isinstance(found, dict) or found.get("format") != form:
        what = f"the card of {out.name} would overwrite it"
        raise InputError(what, file=card, remedy="Choose another name with --out")
    check_outputs({"--out": out, "the card of --out": card, "what is kept to go on": state}, read)


def encoder_file(relation: str) -> Path:
    """Return the default path of a relation's encoder."""
    return Path("weights") / f"{relation}_encoder.safetensors"


def commit() -> str:
    """Return the commit of the checkout that this runs from; empty outside one."""
    folder = Path(__file__).resolve().parent
    try:
        said = subprocess.run(
            ["git", "rev-parse", "--short", "HEAD"],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
    except OSError:
        return ""
    return said.stdout.strip()
