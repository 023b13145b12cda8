"""Outputs of a command: written atomically, and nowhere that the command reads from."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import re
import stat
import sys
import tempfile
import uuid
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from tamp.errors import InputError
from tamp.system.reading import is_file

STANDARD_STREAMS = {
    "/dev/stdout": 1,
    "/dev/fd/1": 1,
    "/proc/self/fd/1": 1,
    "/dev/stderr": 2,
    "/dev/fd/2": 2,
}
"""Names of what a process has open already: there, text is added to what was printed."""

UNFINISHED_NAME = re.compile(r"^\.tamp-[0-9a-f]{32}\.unfinished$")
"""Names of files that are being written. Their writer holds a lock on them; without one, it has
been killed.
"""

TEXTURE_PATTERN = re.compile(
    rb"^\s*(?:mtllib|map_\w+|bump|disp|decal|norm)\s+(?:-\S+\s+)*(\S.*?)\s*$", re.MULTILINE
)
"""In an OBJ or MTL file: further files that belong to it."""

FILE_PATTERN = re.compile(rb'(?:filename|"uri")\s*[=:]\s*"([^"]{1,500})"')
"""In a URDF or glTF file: likewise."""

MOST_SEARCHED = 20_000_000
"""Bytes of a mesh file in which names of further files are looked for."""


def write_whole(path: Path, content: bytes) -> None:
    """Write a file atomically: a reader in another process sees all of it or nothing, and a kill
    leaves the old one.

    A link is followed, the permissions of a file that is replaced are kept; devices are written as
    they are.

    Raises:
        OSError: The folder cannot be made or written, the disk is full, or the file is not to be
            written.
    """
    if _is_device(path):
        _write_device(path, content)
        return
    path = _followed(path)
    made = _make_folder(path.parent)
    try:
        _replace(path, content)
    except BaseException:
        for folder in made:
            with contextlib.suppress(OSError):
                folder.rmdir()
        raise


def _followed(path: Path) -> Path:
    """Return what a chain of links leads to, which need not exist; OSError where it is a circle."""
    with contextlib.suppress(FileNotFoundError):
        path.stat()
    return Path(os.path.realpath(path))


def check_writable(path: Path, option: str = "--out") -> None:
    """Refuse an output that cannot be written before time is spent on a plan.

    Raises:
        InputError: A folder, no regular file, or no place where one can write.
    """
    elsewhere = f"Choose another place with {option}"

    try:
        if path.is_dir():
            raise InputError(
                "the output is a folder",
                file=path,
                remedy=f"Name a file: {option} {path / 'plan.json'}",
            )
        if _is_device(path):
            return

        if path.exists():
            if not path.is_file():
                raise InputError("the output is not a regular file", file=path, remedy=elsewhere)
            _check_mode(path)

        folder = _followed(path).parent
        while not folder.exists():
            folder = folder.parent
        with tempfile.TemporaryFile(dir=folder):  # the only test that root, too, can trust
            pass
        if len(os.fsencode(path.name)) > os.pathconf(folder, "PC_NAME_MAX"):
            raise OSError(errno.ENAMETOOLONG, os.strerror(errno.ENAMETOOLONG))
    except OSError as error:
        raise InputError(
            f"the output cannot be written: {error.strerror}", file=path, remedy=elsewhere
        ) from None
    except ValueError:
        raise InputError(
            "the output cannot have such a name", file=path, remedy=elsewhere
        ) from None


def check_outputs(outputs: Mapping[str, Path | None], inputs: Iterable[Path] = ()) -> None:
    """Refuse outputs onto what a command reads, or onto each other, before anything is written.

    Two names may mean one file: through links, or where case does not count.

    Args:
        outputs: Option to file; None where the option is not given.
        inputs: All that is read; files that they name in turn (textures, materials) are looked for.

    Raises:
        InputError: Naming both.
    """
    written = {
        option: path
        for option, path in outputs.items()
        if path is not None and not _is_device(path)
    }
    if not written:
        return
    taken = {path: option for option, path in written.items()}
    for option, path in written.items():
        for other, first in taken.items():
            if first != option and _same(path, other):
                what = f"{first} and {option} would be written to the same file"
                raise InputError(what, file=path, remedy="Give each a file of its own")
    for source in dict.fromkeys(inputs):
        for file in (source, *_companions(source)):
            for option, path in written.items():
                if _same(path, file):
                    what = f"{option} would overwrite it, and it is an input"
                    raise InputError(what, file=file, remedy="Choose another file to write to")


@contextlib.contextmanager
def locked_folder(folder: Path) -> Iterator[None]:
    """Keep out other processes of ours that would read and rewrite a file in this folder at the
    same time.

    Where a file system has no locks there is none.
    """
    folder.mkdir(parents=True, exist_ok=True)
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        with contextlib.suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def _same(one: Path, other: Path) -> bool:
    if os.path.realpath(one) == os.path.realpath(other):
        return True
    with contextlib.suppress(OSError, ValueError):
        return os.path.samefile(one, other)
    return False


def _companions(file: Path) -> Iterator[Path]:
    """List the files that a mesh, a material or a robot's description names, as far as they are
    there.
    """
    kind = file.suffix.lower()
    pattern = (
        TEXTURE_PATTERN
        if kind in (".obj", ".mtl")
        else FILE_PATTERN
        if kind in (".urdf", ".gltf")
        else None
    )
    if pattern is None or not is_file(file) or file.stat().st_size > MOST_SEARCHED:
        return
    for name in dict.fromkeys(pattern.findall(file.read_bytes())):
        path = file.parent / os.fsdecode(name).removeprefix("package://")
        if is_file(path):
            yield path
            if path.suffix.lower() in (".mtl", ".obj"):
                yield from _companions(path)


def _is_device(path: Path) -> bool:
    if str(path) in STANDARD_STREAMS:
        return True
    try:
        return stat.S_ISCHR(path.stat().st_mode)
    except (OSError, ValueError):
        return False


def _write_device(path: Path, content: bytes) -> None:
    standard = STANDARD_STREAMS.get(str(path))
    if standard is not None:
        (sys.stdout if standard == 1 else sys.stderr).flush()
    descriptor = os.open(path, os.O_WRONLY | os.O_NOCTTY) if standard is None else os.dup(standard)
    with os.fdopen(descriptor, "wb") as stream:
        stream.write(content)


def _make_folder(folder: Path) -> list[Path]:
    """Make a folder with those above it; return those that were not there, innermost first."""
    missing = [one for one in (folder, *folder.parents) if not one.exists()]
    folder.mkdir(parents=True, exist_ok=True)
    return missing


def _check_mode(path: Path) -> None:
    """Refuse to replace a file that its owner has protected, though the folder would allow it."""
    if not os.access(path, os.W_OK):
        raise OSError(errno.EACCES, os.strerror(errno.EACCES))


def _replace(path: Path, content: bytes) -> None:
    mode = None
    if path.exists():
        if path.is_dir():
            raise OSError(errno.EISDIR, os.strerror(errno.EISDIR))
        _check_mode(path)
        mode = stat.S_IMODE(path.stat().st_mode)

    _remove_unfinished(path.parent)
    temporary, descriptor = _unfinished(path.parent)

    try:
        with os.fdopen(descriptor, "wb") as stream:
            stream.write(content)
            stream.flush()
            if mode is not None:
                os.fchmod(stream.fileno(), mode)
            temporary.replace(path)
    except BaseException as error:
        temporary.unlink(missing_ok=True)
        if isinstance(error, OSError) and error.filename is None:
            error.filename = str(path)
        raise


def _unfinished(folder: Path) -> tuple[Path, int]:
    """Create a file that only this process writes, locked as long as it is open."""
    while True:
        path = folder / f".tamp-{uuid.uuid4().hex}.unfinished"
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
        with contextlib.suppress(OSError):  # no locks here
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        if os.fstat(descriptor).st_nlink:
            return path, descriptor
        os.close(descriptor)  # taken for one of a killed process in the moment before the lock


def _remove_unfinished(folder: Path) -> None:
    """Remove what killed processes have left."""
    with contextlib.suppress(OSError):
        for entry in os.scandir(folder):
            if UNFINISHED_NAME.match(entry.name):
                descriptor = os.open(entry.path, os.O_WRONLY)
                try:
                    fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
                    os.unlink(entry.path)
                except OSError:
                    continue
                finally:
                    os.close(descriptor)
