"""The kinds of a PDDLStream problem's parts, before any of them is read."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.pddlstream.adapters import Adapted

DEBUG_WORDS = ("debug", "shared_debug")
"""Texts that stand for a whole stream map in PDDLStream: there they make placeholder values."""


def check_parts(problem: tuple[Any, ...]) -> None:
    """Say which part is of another kind than PDDLStream's.

    Args:
        problem: domain_pddl, constant_map, stream_pddl, stream_map, init, goal.

    Raises:
        InputError: The first part that is.
    """
    domain, constants, streams, functions, init, goal = problem
    if not isinstance(domain, str | Path):
        raise _wrong("domain_pddl", "the domain's text or a Path to it", domain)
    if not isinstance(constants, Mapping):
        raise _wrong("constant_map", "a dict of values by constant", constants)
    listed = (streams,) if isinstance(streams, str | Path) or streams is None else streams
    if not _listing(listed) or not all(
        one is None or isinstance(one, str | Path) for one in listed
    ):
        raise _wrong(
            "stream_pddl", "the streams' text, a Path to it, several of them, or None", streams
        )

    if not isinstance(functions, Mapping):
        raise _wrong("stream_map", "a dict of functions by stream", functions)
    for name, function in functions.items():
        if not callable(function) and not isinstance(function, Adapted):
            raise _wrong(
                f"stream_map['{name}']", "a function, or one of from_fn, from_gen_fn, ...", function
            )

    if not _listing(init):
        raise _wrong("init", "a list of facts such as ('On', 'mug', 'table')", init)
    if not isinstance(goal, tuple | list):
        raise _wrong("goal", "a condition such as ('On', 'mug', 'table')", goal)


def _listing(item: Any) -> bool:
    return isinstance(item, Iterable) and not isinstance(item, str | bytes | Mapping)


def _wrong(part: str, wanted: str, found: Any) -> InputError:
    shown = repr(found)
    shown = shown if len(shown) <= 60 else f"{shown[:57]}..."
    remedy = ""
    if isinstance(found, str) and found.lower() in DEBUG_WORDS:
        remedy = "tamp has no placeholder streams: give each stream a function"
    return InputError(
        f"{part}: expected {wanted}, found {type(found).__name__} {shown}", remedy=remedy
    )
