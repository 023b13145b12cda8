"""Memoization of a robot's slow steps on disk: an interrupted run goes on where it was.

Each result lies in the cache folder under a hash of all that it depends on: the robot so far, the
steps' settings and their code. So nothing can be taken for what it is not, and a robot made anew
with another gripper takes over what is the same.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import zipfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from functools import cache
from pathlib import Path
from types import ModuleType

import numpy as np

from tamp.commands.robot_folder import convex, home, reach_table, self_collision, spheres
from tamp.geometric.scene.scene import Hull
from tamp.system.files import cache_folder, write_whole

MODULES = (convex, home, reach_table, self_collision, spheres)
"""Of the steps: their constants in capitals are settings."""

Arrays = Mapping[str, np.ndarray]


def kept(step: str, depends: object, compute: Callable[[], Arrays]) -> Arrays:
    """Return a step's arrays from the cache folder; or compute and keep them.

    Args:
        step: Its name.
        depends: All that the result depends on, besides code and settings: dataclasses, arrays,
            and what has a `repr` of its own.
        compute: The step.
    """
    sha = hashlib.sha256(f"{step} {_code()}".encode())
    for word in (*_settings(), *_words(depends)):
        sha.update(word)
    file = cache_folder() / "robots" / f"{sha.hexdigest()[:32]}.npz"

    with (
        contextlib.suppress(OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile),
        file.open("rb") as stream,
        np.load(stream, allow_pickle=False) as arrays,
    ):
        return {name: arrays[name] for name in arrays.files}

    found = compute()
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **found)  # pyright: ignore[reportArgumentType]
    with contextlib.suppress(OSError):  # a read-only home: computed anew next time
        write_whole(file, buffer.getvalue())
    return found


def kept_hulls(
    step: str, depends: object, compute: Callable[[], tuple[Hull, ...]]
) -> tuple[Hull, ...]:
    """Return a step's hulls as `kept` does."""

    def arrays() -> dict[str, np.ndarray]:
        hulls = compute()
        found: dict[str, np.ndarray] = {}
        for number, hull in enumerate(hulls):
            found[f"{number}/vertices"], found[f"{number}/faces"] = hull.vertices, hull.faces
        return found

    found = kept(step, depends, arrays)
    return tuple(
        Hull(found[f"{number}/vertices"], found[f"{number}/faces"])
        for number in range(len(found) // 2)
    )


def _words(value: object) -> Iterator[bytes]:
    """Spell a value out, field by field; where a file lies is no part of it."""
    if isinstance(value, np.ndarray):
        yield f"{value.dtype} {value.shape}".encode()
        yield np.ascontiguousarray(value).tobytes()
    elif is_dataclass(value) and not isinstance(value, type):
        yield type(value).__name__.encode()
        for field in fields(value):
            yield from _words(getattr(value, field.name))
    elif isinstance(value, Mapping):
        for key in sorted(value):
            yield from _words((key, value[key]))
    elif isinstance(value, tuple | list):
        yield f"{len(value)}:".encode()
        for one in value:
            yield from _words(one)
    elif isinstance(value, frozenset | set):
        yield from _words(sorted(value))
    elif not isinstance(value, Path):
        yield repr(value).encode() + b"\0"


def _settings() -> Iterator[bytes]:
    """Spell out the steps' constants, which a test, or a reader in a hurry, may have changed."""
    for module in MODULES:
        for name, value in sorted(vars(module).items()):
            if name.isupper() and isinstance(value, int | float | tuple | np.ndarray):
                yield name.encode()
                yield from _words(value)


@cache
def _code() -> str:
    """Hash the source of the steps: other code may give other results."""
    sha = hashlib.sha256()
    for module in MODULES:
        sha.update(_source(module))
    return sha.hexdigest()


def _source(module: ModuleType) -> bytes:
    return Path(str(module.__file__)).read_bytes()
