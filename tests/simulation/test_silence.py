"""What C code prints is kept back, and only for as long as the block lasts."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys

import pytest

from tamp.simulation.silence import silence

C = ctypes.CDLL(None)


def print_everywhere(word: str) -> None:
    """By C's stdio, which may hold it back, and by the handles themselves."""
    C.printf(f"{word} of stdio\n".encode())
    for stream in (1, 2):
        os.write(stream, f"{word} of handle {stream}\n".encode())


def test_nothing_comes_out_of_the_block_and_all_before_and_after(
    capfd: pytest.CaptureFixture[str],
) -> None:
    print_everywhere("before")
    C.fflush(None)
    with silence():
        print_everywhere("within")
    print_everywhere("after")
    C.fflush(None)
    out, err = capfd.readouterr()
    assert "within" not in out + err
    for word in ("before", "after"):
        assert f"{word} of stdio" in out
        assert f"{word} of handle 1" in out and f"{word} of handle 2" in err


PROGRAM = """
import sys
from tamp.simulation.silence import silence
sys.stdout.write("held ")
with silence():
    print("within", flush=True)
print("after")
"""


def test_what_python_holds_back_comes_out_before() -> None:
    """Else it would be lost with what the block prints."""
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=True
    )
    assert done.stdout.split() == ["held", "after"]


def test_an_error_ends_the_silence_and_no_handle_is_left_open(
    capfd: pytest.CaptureFixture[str],
) -> None:
    def handles() -> int:
        return len(os.listdir("/proc/self/fd"))

    before = handles()
    for _ in range(3):
        with pytest.raises(KeyError), silence():
            raise KeyError("engine")
    assert handles() == before
    os.write(1, b"heard")
    assert capfd.readouterr().out == "heard"
