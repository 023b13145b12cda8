"""Find the files that a plan was made from."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from tamp.errors import InputError
from tamp.plan.read import PlanFile
from tamp.plan.violation import Violation
from tamp.system.files import find_domain, find_problem
from tamp.system.reading import is_file

DECIMALS = 9
"""Of the numbers in a plan file: nanometres."""

MOST_HASHED = 1_000_000_000
"""Bytes of the largest file that a plan may have been made from."""


def source_file(plan: PlanFile, role: str, override: Path | None) -> Path:
    """Find the problem's or domain's file: the user's, who may give a shipped one's name, else
    where the plan says, else beside it.

    Raises:
        InputError: There is none.
    """
    if override is not None:
        return find_problem(override) if role == "problem" else find_domain(override)
    source = plan.source(role)
    if source is None:
        raise InputError(f"the plan does not say from which {role} it was made", file=plan.file)
    beside = [plan.file.parent / source.path.name] if plan.file else []
    for file in (source.path, *beside):
        if is_file(file):
            return file
    raise InputError(
        f"the plan's {role} {source.path} is missing", file=plan.file, remedy=f"Give --{role} FILE"
    )


def sha256(file: Path) -> str:
    """Compute the SHA-256 of a file's contents, hexadecimal; a file too large to be ours has none.

    Raises:
        InputError: It cannot be read.
    """
    try:
        if file.stat().st_size > MOST_HASHED:
            return ""
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError as error:
        raise InputError(f"it cannot be read: {error.strerror}", file=file) from None


def plan_hashes(plan: PlanFile, **given: Path | None) -> dict[Path, str | None]:
    """Return the plan's hashes of its files, by place, for `unquoted`; None of the user's own."""
    hashes: dict[Path, str | None] = {}
    for source in plan.sources:
        beside = [plan.file.parent / source.path.name] if plan.file else []
        hashes |= dict.fromkeys((source.path, *beside), source.sha256)
    return {**hashes, **{path: None for path in given.values() if path is not None}}


@contextmanager
def unquoted(plan: Path | None, hashes: Mapping[Path, str | None]) -> Iterator[None]:
    """Keep a file's text out of errors when only a plan names it: that may be a secret file.

    Of a file with the contents that the plan tells the hash of, and of one that the user has named,
    errors say all.

    Args:
        plan: The plan's file.
        hashes: The hash that the plan tells of each file; None for those that the user has named.

    Raises:
        InputError: For one that is raised inside.
    """
    try:
        yield
    except InputError as error:
        if error.file is None or _may_be_quoted(Path(error.file), plan, hashes):
            raise
        what = (
            "the plan names this file, but was made from another one, "
            "and it cannot be read in its place"
        )
        raise InputError(what, file=error.file, line=error.line) from None


def _may_be_quoted(file: Path, plan: Path | None, hashes: Mapping[Path, str | None]) -> bool:
    if file == plan:
        return True
    for path, digest in hashes.items():
        if path.absolute() == file.absolute():
            return digest is None or (is_file(file) and sha256(file) == digest)
    return False


def check_files(
    plan: PlanFile, files: Mapping[str, Path], meshes: tuple[Path, ...]
) -> Iterator[Violation]:
    """Check that the files that the plan was made from are what they were."""
    for role, file in files.items():
        source = plan.source(role)
        if source is not None and sha256(file) != source.sha256:
            yield Violation("hash", f"the {role} {file} is not the one that the plan was made from")
    recorded = {source.sha256 for source in plan.sources if source.role == "mesh"}
    hashes = {sha256(file): file for file in meshes}
    for missing in sorted(hashes.keys() - recorded):
        yield Violation(
            "hash", f"the mesh {hashes[missing]} is not one that the plan was made from"
        )
    for gone in sorted(recorded - hashes.keys()):
        path = next(source.path for source in plan.sources if source.sha256 == gone)
        yield Violation(
            "hash", f"the plan was made from a mesh {path.name} that the problem does not have"
        )
