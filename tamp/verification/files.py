"""Finding the files that a plan was made from."""

from __future__ import annotations

import hashlib
from pathlib import Path

from tamp.errors import InputError
from tamp.verification.plan_file import PlanFile


def source_file(plan: PlanFile, role: str, override: Path | None) -> Path:
    """The problem's or domain's file: what the user says, else where the plan says, else of that name beside the plan.

    Raises:
        InputError: There is none.
    """
    if override is not None:
        if not override.is_file():
            raise InputError(f"no such file: {override}")
        return override
    source = plan.source(role)
    if source is None:
        raise InputError(f"the plan does not say from which {role} it was made", file=plan.file)
    beside = [plan.file.parent / source.path.name] if plan.file else []
    for file in (source.path, *beside):
        if file.is_file():
            return file
    raise InputError(f"the plan's {role} {source.path} is missing", file=plan.file, remedy=f"Give --{role} FILE")


def sha256(file: Path) -> str:
    """The hash of a file's contents, hexadecimal."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
