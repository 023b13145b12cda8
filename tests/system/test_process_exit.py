"""A command that ends at once: with its code, with what was printed, and with what was asked for."""

from __future__ import annotations

import subprocess
import sys

import pytest


def run(code: str, stdout: int = subprocess.PIPE) -> subprocess.CompletedProcess[str]:
    head = (
        "import atexit, os, sys, threading, time\nfrom tamp.system.process_exit import exit_now\n"
    )
    return subprocess.run(
        [sys.executable, "-c", head + code],
        stdout=stdout, stderr=subprocess.PIPE, text=True, timeout=60, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("code", [0, 3])
def test_what_was_printed_is_there_and_nothing_after_it(code: int) -> None:
    done = run(
        f"sys.stdout.write('said')\nsys.stderr.write('warned')\nexit_now({code})\nprint('no')"
    )
    assert (done.returncode, done.stdout, done.stderr) == (code, "said", "warned")


def test_what_others_asked_to_be_done_at_exit_is_done_before() -> None:
    done = run("atexit.register(print, 'tidied')\nprint('said')\nexit_now(0)")
    assert done.stdout == "said\ntidied\n"


def test_a_thread_that_works_on_does_not_hold_it() -> None:
    done = run("threading.Thread(target=time.sleep, args=(600,)).start()\nexit_now(5)")
    assert done.returncode == 5


@pytest.mark.parametrize("gone", ["sys.stdout.close()", "sys.stdout = None", "os.close(1)"])
def test_where_nobody_reads_the_code_stays(gone: str) -> None:
    done = run(f"print('said')\n{gone}\nsys.stderr.write('warned')\nexit_now(4)")
    assert done.returncode == 4 and done.stderr == "warned"
