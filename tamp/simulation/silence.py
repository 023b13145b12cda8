"""Suppression of output: a block in which nothing that C code prints comes out."""

from __future__ import annotations

import contextlib
import ctypes
import os
import sys
from collections.abc import Iterator


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """Silence what C code prints: some releases write to stdout, some to stderr."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(stream) for stream in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in (1, 2):
            os.dup2(nowhere, stream)
        yield
    finally:
        ctypes.CDLL(None).fflush(None)  # what C's stdio still holds would come out at exit
        for stream, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, stream)
        for handle in (*kept, nowhere):
            os.close(handle)
