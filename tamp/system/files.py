"""Folders of shipped domains and problems, and of the cache of what is computed between runs."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from tamp.errors import InputError
from tamp.system.outputs import check_writable as check_writable
from tamp.system.outputs import write_whole as write_whole

_PACKAGE = Path(__file__).resolve().parent.parent
STREAMS_SUFFIX = ".streams.pddl"
"""What a domain's streams file ends with, beside the domain."""


def shipped(folder: str) -> Path:
    """Return the folder `domains` or `problems` that came with tamp: in the wheel, or beside
    `tamp/` in a checkout.
    """
    packed = _PACKAGE / "_data" / folder
    return packed if packed.is_dir() else _PACKAGE.parent / folder


def find_problem(name: str | Path) -> Path:
    """Find the problem file that `name` means: a path, or the name of a shipped problem.

    Raises:
        InputError: Nothing of that name, with the shipped problems as choices.
    """
    return _find(
        name, "problem", ".yaml", _names("problems", ".yaml"), (Path(), shipped("problems"))
    )


def find_domain(name: str | Path, beside: Path | None = None) -> Path:
    """Find the PDDL domain that `name` means: a path (also relative to `beside`), or the name of a
    shipped domain.

    Args:
        name: What the command line or the problem's `domain:` says.
        beside: The folder of the problem file that names the domain.

    Raises:
        InputError: Nothing of that name, with the shipped domains as choices.
    """
    folders = (
        (Path(), shipped("domains")) if beside is None else (beside, Path(), shipped("domains"))
    )
    return _find(name, "domain", ".pddl", _names("domains", ".pddl"), folders)


def cache_folder() -> Path:
    """Return the cache folder, for what is expensive to compute: `TAMP_CACHE`, or `~/.cache/tamp`.
    It may not exist yet.
    """
    return Path(os.path.expanduser(os.environ.get("TAMP_CACHE") or "~/.cache/tamp"))


def _find(
    name: str | Path, kind: str, suffix: str, names: list[str], folders: tuple[Path, ...]
) -> Path:
    text = str(name)
    if not text:
        raise InputError(f"no {kind} given", choices=names)
    tried = [text] if text.endswith(suffix) else [text, text + suffix]
    for folder in folders:
        for candidate in tried:
            path = folder / os.path.expanduser(candidate)
            with contextlib.suppress(OSError):  # a name too long to be one
                if path.is_file():
                    return path
    looks_like_path = text.endswith(suffix) or "/" in text or os.sep in text
    what = f"no such file: {text}" if looks_like_path else f"unknown {kind} '{text}'"
    raise InputError(what, found=Path(text).name.removesuffix(suffix), choices=names)


def _names(folder: str, suffix: str) -> list[str]:
    files = shipped(folder).glob(f"*{suffix}")
    return sorted(
        file.name.removesuffix(suffix) for file in files if not file.name.endswith(STREAMS_SUFFIX)
    )
