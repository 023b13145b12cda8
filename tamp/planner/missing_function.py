"""The error about a stream without a function."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tamp.errors import InputError
from tamp.symbolic.pddl.structs import Stream


def without_function(stream: Stream, file: str | None, functions: Mapping[str, Any]) -> InputError:
    """Return the error of a stream that nothing serves; it says how to serve it."""
    place = stream.place
    return InputError(
        f"stream '{stream.name}' has no function",
        file=file,
        line=place.line if place else None,
        column=place.column if place else None,
        found=stream.name,
        choices=functions,
        remedy=_remedy(stream.name),
    )


def _remedy(stream: str) -> str:
    verb, _, relation = stream.partition("-")
    if verb in ("sample", "test") and relation:
        object_given = f"load_problem(..., groundings={{'{relation}': object}})"
        return (
            f"Give '{relation}' a grounding: --sampler {relation}=FILE, "
            f"or from Python: {object_given}"
        )
    return f"Give it one from Python: load_problem(..., functions={{'{stream}': f}})"
