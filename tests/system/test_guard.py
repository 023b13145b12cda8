"""Commands end when they are asked to, with the right code, without a traceback and with nobody left behind."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.system.test_race import gone

INT, TERM = signal.SIGINT, signal.SIGTERM

SLACK = 30.0
"""Seconds in which a command that would go on for 600 ends; a busy machine takes some of them."""


def start(tmp_path: Path, code: str) -> subprocess.Popen[str]:
    """A guarded command whose module is `code`; it says "ready" when it can be asked."""
    (tmp_path / "stubborn.py").write_text(code)
    words = [sys.executable, "-c", "from tamp.system.guard import guarded; guarded('stubborn')"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *sys.path])}
    pipe = subprocess.PIPE
    return subprocess.Popen(
        words, stdout=pipe, stderr=pipe, text=True, env=environment, start_new_session=True
    )


def ask(process: subprocess.Popen[str], number: int, *, group: bool = False) -> tuple[str, str]:
    """Send a signal when it is ready; its output after that."""
    assert process.stdout is not None
    while process.stdout.readline() != "ready\n":
        assert process.poll() is None, process.communicate()
    (os.killpg if group else os.kill)(process.pid, number)
    return process.communicate(timeout=SLACK)


WORKING = "import time\ndef main():\n    print('ready', flush=True)\n    time.sleep(600)\n"

DROPPING = """
import contextlib, time
def main():
    print("ready", flush=True)
    while True:
        with contextlib.suppress(KeyboardInterrupt):
            time.sleep(600)
"""

KEEPING = """
import time
def main():
    try:
        print("ready", flush=True)
        time.sleep(600)
    except KeyboardInterrupt:
        print("the best plan")
        return 0
"""

DEAF = """
import ctypes
def main():
    print("ready", flush=True)
    ctypes.PyDLL(None).sleep(600)  # with the interpreter's lock: no thread of Python's runs
"""

TURNED = """
import time
def main():
    print("ready", flush=True)
    try:
        time.sleep(600)
    except KeyboardInterrupt:
        raise RuntimeError("a library makes something else of it") from None
"""

IMPORTING = "import time\nprint('ready', flush=True)\ntime.sleep(600)\ndef main(): pass\n"

COLLECTED = """
import time
class Last:
    def __del__(self):
        time.sleep(600)
def main():
    print("ready", flush=True)
    last = Last()
    del last
    time.sleep(600)
"""


@pytest.mark.parametrize("number", [INT, TERM])
@pytest.mark.parametrize("code", [WORKING, DROPPING, DEAF, TURNED, IMPORTING, COLLECTED])
def test_whatever_it_does_it_ends(code: str, number: int, tmp_path: Path) -> None:
    process = start(tmp_path, code)
    out, err = ask(process, number, group=code is WORKING)
    assert process.returncode == 128 + number
    assert (out, err) == ("", "interrupted\n")


def test_what_was_found_is_kept(tmp_path: Path) -> None:
    # It says so within: a signal may come at once.
    process = start(tmp_path, KEEPING)
    assert ask(process, INT) == ("the best plan\n", "") and process.returncode == 0


@pytest.mark.parametrize(
    ("body", "code", "err"),
    [
        ("return 7", 7, ""),
        ("return None", 0, ""),
        ("raise SystemExit(3)", 3, ""),
        ("raise SystemExit('no')", 1, "no\n"),
        ("raise ValueError('mine')", 1, "ValueError: mine\n"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", -signal.SIGKILL, ""),
        ("import os, signal; os.kill(os.getpid(), signal.SIGABRT)", -signal.SIGABRT, ""),
    ],
)
def test_left_alone_it_ends_as_it_would(body: str, code: int, err: str, tmp_path: Path) -> None:
    process = start(tmp_path, f"def main():\n    print('said', flush=True)\n    {body}\n")
    out, said = process.communicate(timeout=SLACK)
    assert (
        process.returncode == code
        and out == "said\n"
        and said.endswith(err)
        and bool(said) == bool(err)
    )


PARENT = """
import os, subprocess, sys, time
def main():
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    print(os.getpid(), child.pid, flush=True)
    print("ready", flush=True)
    time.sleep(600)
"""


def test_what_it_started_ends_with_it(tmp_path: Path) -> None:
    process = start(tmp_path, PARENT)
    assert process.stdout is not None
    pids = [int(word) for word in process.stdout.readline().split()]
    ask(process, TERM)
    assert process.returncode == 128 + TERM and all(map(gone, pids))


@pytest.mark.parametrize("number", [INT, TERM])
def test_so_does_it_when_the_one_who_works_leaves_first(number: int, tmp_path: Path) -> None:
    """As at a terminal, whose Ctrl-C comes to both: who watches is stopped until the other has gone."""
    code = PARENT.replace(
        "import time; time.sleep(600)", "import os, time; os.setpgid(0, 0); time.sleep(600)"
    )
    process = start(tmp_path, code.replace("    print(os", "    time.sleep(1.0)\n    print(os"))
    assert process.stdout is not None
    worker, child = (int(word) for word in process.stdout.readline().split())
    assert process.stdout.readline() == "ready\n"
    os.kill(process.pid, signal.SIGSTOP)
    os.killpg(process.pid, number)
    assert gone(worker, within=SLACK)
    os.kill(process.pid, signal.SIGCONT)
    process.communicate(timeout=SLACK)
    assert process.returncode == 128 + number and gone(child)


def test_killed_it_takes_the_one_who_works_along(tmp_path: Path) -> None:
    process = start(tmp_path, f"import os\nprint(os.getpid(), flush=True)\n{WORKING}")
    assert process.stdout is not None
    worker = int(process.stdout.readline())
    ask(process, signal.SIGKILL)
    assert worker != process.pid and gone(worker, within=SLACK)


COMMANDS = [
    ("solve", "one_object --jobs 2 --optimize"),
    ("verify", "plan.json"),
    ("execute", "plan.json"),
    ("export", "plan.json"),
    ("view", "one_object --no-browser"),
    ("bench", "run --problems one_object --jobs 2"),
    ("learn", "generate on --count 400 --workers 2"),
]


@pytest.mark.parametrize(("command", "words"), COMMANDS)
@pytest.mark.parametrize("moment", [0.1, 0.7])
def test_every_command_ends_early_on(
    command: str, words: str, moment: float, tmp_path: Path
) -> None:
    """While it imports, where a KeyboardInterrupt is a traceback or is lost in somebody's `except`."""
    code = f"import sys, tamp.commands.entry_points; print('ready', flush=True); tamp.commands.entry_points.{command}()"
    number = INT if moment < 0.5 else TERM
    pipe = subprocess.PIPE
    process = subprocess.Popen(
        [sys.executable, "-c", code, *words.split()],
        cwd=tmp_path,
        stdout=pipe,
        stderr=pipe,
        text=True,
    )
    assert process.stdout is not None and process.stdout.readline() == "ready\n"
    time.sleep(moment)
    process.send_signal(number)
    _, err = process.communicate(timeout=SLACK)
    assert "Traceback" not in err and "Exception" not in err
    # a plan file that is not there may have been missed before the signal came
    assert process.returncode == 128 + number or (process.returncode == 2 and "plan.json" in err), (
        err
    )


@pytest.mark.slow
@pytest.mark.parametrize("number", [INT, signal.SIGKILL])
def test_the_workers_of_generate_leave_with_their_leader(number: int, tmp_path: Path) -> None:
    words = [
        "generate",
        "on",
        "--count",
        "5000",
        "--workers",
        "2",
        "--out",
        str(tmp_path / "data.npz"),
    ]
    process = subprocess.Popen(
        [sys.executable, "-c", "from tamp.commands.entry_points import learn; learn()", *words],
        stderr=subprocess.DEVNULL,
    )
    workers: set[int] = set()
    end = time.monotonic() + 120.0
    while len(workers) < 2 and time.monotonic() < end:
        time.sleep(0.1)
        workers = {pid for pid in descendants(process.pid) if "spawn_main" in command_line(pid)}
    assert len(workers) == 2
    process.send_signal(number)
    process.wait(timeout=SLACK)
    assert process.returncode == (130 if number == INT else -number)
    assert all(gone(pid, within=SLACK) for pid in workers)


def descendants(pid: int) -> list[int]:
    """The processes that a process, or one of those, has started."""
    parents: dict[int, int] = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            stat = (folder / "stat").read_text(encoding="utf-8", errors="replace")
        except OSError:
            continue
        parents[int(folder.name)] = int(re.sub(r".*\)", "", stat, flags=re.DOTALL).split()[1])
    found, last = [pid], 0
    while last < len(found):
        found += [child for child, parent in parents.items() if parent == found[last]]
        last += 1
    return found[1:]


def command_line(pid: int) -> str:
    """The words of a process; empty when it is gone."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


def test_an_import_is_left_at_once(tmp_path: Path) -> None:
    """What is raised in the start of a module in C++ is a crash there, and others swallow it."""
    waits = "    try:\n        time.sleep(9)\n    except BaseException:\n        pass\n"
    slow = f"import time\nprint('ready', flush=True)\nwhile True:\n{waits}"
    (tmp_path / "slow.py").write_text(slow)
    (tmp_path / "command.py").write_text("def main():\n    import slow\n")
    code = "from tamp.system.guard import guarded; guarded('command')"
    environment = {**os.environ, "PYTHONPATH": f"{tmp_path}:{Path.cwd()}"}
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None and process.stdout.readline() == "ready\n"
    process.send_signal(INT)
    _, err = process.communicate(timeout=SLACK)
    assert (process.returncode, err) == (130, "interrupted\n")
