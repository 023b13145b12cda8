"""Where shipped domains and problems are, and where computed things are kept between runs."""

from __future__ import annotations

import contextlib
import os
import tempfile
import uuid
from pathlib import Path

from tamp.errors import InputError

_PACKAGE = Path(__file__).resolve().parent
_STREAMS = ".streams.pddl"


def shipped(folder: str) -> Path:
    """The folder `domains` or `problems` that came with tamp: inside the wheel, or beside `tamp/` in a checkout."""
    packed = _PACKAGE / "_data" / folder
    return packed if packed.is_dir() else _PACKAGE.parent / folder


def find_problem(name: str | Path) -> Path:
    """The problem file that `name` means: a path, or the name of a shipped problem.

    Raises:
        InputError: Nothing of that name, with the shipped problems as choices.
    """
    return _find(name, "problem", ".yaml", _names("problems", ".yaml"), (Path(), shipped("problems")))


def find_domain(name: str | Path, beside: Path | None = None) -> Path:
    """The PDDL domain that `name` means: a path (also relative to `beside`), or the name of a shipped domain.

    Args:
        name: What the command line or the problem's `domain:` says.
        beside: The folder of the problem file that names the domain.

    Raises:
        InputError: Nothing of that name, with the shipped domains as choices.
    """
    folders = (Path(), shipped("domains")) if beside is None else (beside, Path(), shipped("domains"))
    return _find(name, "domain", ".pddl", _names("domains", ".pddl"), folders)


def cache_folder() -> Path:
    """The folder for what is expensive to compute: `TAMP_CACHE`, or `~/.cache/tamp`. It may not exist yet."""
    return Path(os.path.expanduser(os.environ.get("TAMP_CACHE") or "~/.cache/tamp"))


def write_whole(path: Path, content: bytes) -> None:
    """Write a file so that a reader in another process sees all of it or nothing.

    Raises:
        OSError: The folder cannot be made or written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{uuid.uuid4().hex}")
    try:
        temporary.write_bytes(content)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def check_writable(path: Path) -> None:
    """Refuse an output that cannot be written before time is spent on a plan.

    Raises:
        InputError: A folder, no regular file, or no place where one can write.
    """
    elsewhere = "Choose another place with --out"
    try:
        if path.is_dir():
            raise InputError("the output is a folder", file=path, remedy=f"Name a file: --out {path / 'plan.json'}")
        if path.exists() and not path.is_file():
            raise InputError("the output is not a regular file", file=path, remedy=elsewhere)
        folder = path.parent
        while not folder.exists():
            folder = folder.parent
        with tempfile.TemporaryFile(dir=folder):  # the only test that root, too, can trust
            pass
    except OSError as error:
        raise InputError(f"the output cannot be written: {error.strerror}", file=path, remedy=elsewhere) from None


def _find(name: str | Path, kind: str, suffix: str, names: list[str], folders: tuple[Path, ...]) -> Path:
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
    return sorted(file.name.removesuffix(suffix) for file in files if not file.name.endswith(_STREAMS))
