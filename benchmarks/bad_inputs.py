"""Bad inputs at all doors: each must end within seconds, in exit status 0, 1 or 2, and as one error with its file.

python -m benchmarks.bad_inputs --cases 2000 --seed 1      # all of them; prints what fails
python -m benchmarks.bad_inputs --cases 200 --door plan    # of one door
python -m benchmarks.bad_inputs --only 1234 --show         # one of them again, with its output

Good files of every kind (benchmarks/bad_input_files.py) are spoilt (benchmarks/bad_input_faults.py), each case from its
own seed, and a command that reads them is run in a process of its own.
"""

from __future__ import annotations

import os
import random
import re
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NoReturn

import tyro

from benchmarks.bad_input_faults import SPOILERS, WORDS, spoil_place
from benchmarks.bad_input_files import DOORS, OPTIONS, make
from benchmarks.common import record

MOST_CPU = 5.0
"""Seconds that a bad input may take."""

PLANNING = 5.0
"""Seconds more that one may take which is not bad after all: it is planned with."""

MOST_MEMORY = 1_000_000
"""KiB beyond what a process has that has read nothing."""

PATIENCE = 90.0
"""Seconds of waiting for a case, on a busy machine."""

BESIDE_THE_ERROR = r"warning: |  [a-z ]+ +\d+\.\d s$"
"""Warnings, and what is said where a busy machine is silent for two seconds."""

TEXTS = ("json", "lines", "text", "yaml")


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        cases: How many.
        seed: Of all of them.
        door: Only this one's.
        only: Only the case of this number.
        show: Print what each case says.
        record: Add a line to the results.
    """

    cases: int = 2000
    seed: int = 0
    door: str | None = None
    only: int | None = None
    show: bool = False
    record: bool = False


@dataclass
class Ended:
    """How a command ended: its exit status (negative: a signal), output, CPU seconds, KiB of memory at most."""

    code: int
    out: str
    err: str
    cpu: float
    memory: int
    faults: list[str] = field(default_factory=list)


def run_line(words: list[str]) -> int:
    """Run a command line in this process; its exit status."""
    import grounding.cli
    import tamp.commands.bench
    import tamp.commands.execute
    import tamp.commands.export
    import tamp.commands.solve
    import tamp.commands.verify
    import tamp.commands.view
    from tamp.system.terminal import spoken

    commands: dict[str, Callable[[list[str]], int]] = {
        "tamp-solve": spoken(tamp.commands.solve.run),
        "tamp-execute": spoken(lambda rest: tamp.commands.execute.main(rest, tamp.commands.solve.registry)),
        "tamp-verify": lambda rest: tamp.commands.verify.main(rest),
        "tamp-export": lambda rest: tamp.commands.export.main(rest),
        "tamp-view": lambda rest: tamp.commands.view.main(rest),
        "tamp-bench": spoken(tamp.commands.bench.run),
        "tamp-learn": spoken(grounding.cli.run),
    }
    sys.argv = list(words)
    return commands[words[0]](words[1:])


def forked(words: list[str], folder: Path) -> Ended:
    """Run a command line in a process of its own, in a folder, with bounded time and memory."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        child = os.fork()
        if child == 0:
            _become(words, folder, out.fileno(), err.fileno())
        status, usage = _waited(child)
        texts: list[str] = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read(200_000).decode("utf-8", "replace"))
    code = os.waitstatus_to_exitcode(status)
    return Ended(code, texts[0], texts[1], usage.ru_utime + usage.ru_stime, usage.ru_maxrss)


def _become(words: list[str], folder: Path, out: int, err: int) -> NoReturn:
    """Be the process of a command line, from here to its end."""
    os.setsid()
    os.chdir(folder)
    for number, stream in enumerate((os.open(os.devnull, os.O_RDONLY), out, err)):
        os.dup2(stream, number)
    used = int(Path("/proc/self/statm").read_text(encoding="utf-8").split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + 4 * 10**9, used + 4 * 10**9))
    resource.setrlimit(resource.RLIMIT_CPU, (30, 31))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    code = 70
    try:
        code = run_line(words) if words else 0
    except BaseException:
        os.write(2, traceback.format_exc().encode("utf-8", "replace"))
    finally:
        for stream in (sys.stdout, sys.stderr):
            stream.flush()
        os._exit(code)


def _waited(child: int) -> tuple[int, resource.struct_rusage]:
    """The status and the usage of a process at its end, which comes after `PATIENCE` at the latest."""
    began = time.monotonic()
    while True:
        found, status, usage = os.wait4(child, os.WNOHANG)
        if found:
            return status, usage
        if time.monotonic() - began > PATIENCE:
            os.killpg(child, signal.SIGKILL)
            return os.wait4(child, 0)[1:]
        time.sleep(0.005)


def spoilt(folder: Path, draw: random.Random, door_name: str | None) -> tuple[str, str | None, list[str]]:
    """Spoil a file in a folder of good ones, or a word of a command line.

    Returns:
        The door's name, the file, and the command line.
    """
    doors = [door for door in DOORS if door_name in (None, door.name)]
    if door_name == "words" or (door_name is None and draw.random() < 0.12):
        line = draw.choice(sorted(OPTIONS))
        words = [*line.split(), *draw.choice(OPTIONS[line]).split(), draw.choice(WORDS)]
        if words[0] == "tamp-solve" and "--time" not in words:
            words += ["--time", "2"]
        if words[:2] == ["tamp-learn", "generate"]:
            words += ["--count", "2"]
        return "words", None, words
    door = draw.choice(doors)
    path = folder / door.file
    if draw.random() < 0.06:
        spoil_place(path, draw)
    else:
        others = [file.read_bytes() for file in sorted(folder.iterdir()) if file.is_file()]
        content = path.read_bytes()
        given = content.decode() if door.form in TEXTS else content
        path.write_bytes(SPOILERS[door.form](given, draw, others))
    return door.name, door.file, draw.choice(door.lines).split()


def snapshot(folder: Path) -> dict[str, bytes | None]:
    """What is in a folder: contents of files, None for what is none."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        if path.is_file() and not path.is_symlink() and path.stat().st_size < 10**8
        else None
        for path in folder.rglob("*")
    }


def judge(
    ended: Ended, words: list[str], before: dict[str, bytes | None], folder: Path, idle: int, file: str | None
) -> list[str]:
    """What is wrong with how a command ended."""
    faults: list[str] = []
    after = snapshot(folder)
    said = ended.out + ended.err
    if ended.code not in (0, 1, 2):
        faults.append(f"exit status {ended.code}")
    if "Traceback" in said:
        faults.append("traceback")
    if any(ord(sign) < 32 and sign not in "\n\t\r" for sign in said) or "\u202e" in said:
        faults.append("control characters are shown")
    if ended.code == 2:
        lines = [line for line in ended.err.splitlines() if not re.match(BESIDE_THE_ERROR, line)]
        if len(lines) != 1 or not lines[0].startswith("error: "):
            faults.append(f"{len(lines)} lines of error")
        named = (*before, *words, *(word.partition("=")[2] for word in words))
        names = ({Path(name).name for name in named} - {""}) | {"lefty", file or "lefty"}
        if "words" not in ended.faults and not any(name in ended.err for name in names):
            faults.append("the error names no file")
        whole = {"out.json", *(words if "/dev/full" in words else ())}  # one output failed, another is there whole
        if after != before and not after.keys() - before.keys() <= whole:
            faults.append(f"written: {sorted(after.keys() - before.keys())}")
    changed = [name for name, content in before.items() if after.get(name, b"gone") != content]
    kept = {words[at + 1] for at, word in enumerate(words[:-1]) if word in ("--out", "--statistics")}
    kept |= {"plan.json"} if words[0] == "tamp-solve" and "--out" not in words else set()  # where a plan goes
    kept |= {f"{name[:-4]}.json" for name in kept if name.endswith(".npz")}  # the card of a data set
    # the plan that was found is written first, whatever becomes of the other outputs
    if set(changed) - (kept if ended.code != 2 or "/dev/full" in words else set()):
        faults.append(f"changed: {changed}")
    faults += [f"left: {name}" for name in after if "unfinished" in name]
    if ended.cpu > MOST_CPU + (PLANNING if ended.code in (0, 1) else 0.0):
        faults.append(f"{ended.cpu:.1f} s of CPU")
    if ended.memory - idle > MOST_MEMORY:
        faults.append(f"{(ended.memory - idle) / 1e6:.1f} GB")
    return faults


def main(options: Options) -> int:
    """Run all cases; the number of those that fail."""
    failures: list[tuple[int, str, list[str]]] = []
    codes: Counter[tuple[str, int]] = Counter()
    with tempfile.TemporaryDirectory() as home:
        good = Path(home) / "good"
        good.mkdir()
        os.environ["TAMP_CACHE"] = str(Path(home) / "cache")
        here = Path.cwd()
        os.chdir(good)
        make(good, lambda line: run_line([*line.split(), *(["--quiet"] if "solve" in line else [])]))
        os.chdir(here)
        idle = forked([], good).memory
        (good / "folder").mkdir()
        os.mkfifo(good / "pipe")
        (good / "loop").symlink_to("loop")
        for number in range(options.cases) if options.only is None else (options.only,):
            draw = random.Random(f"{options.seed}/{number}")
            folder = Path(home) / f"case{number}"
            shutil.copytree(good, folder, symlinks=True, ignore=shutil.ignore_patterns("pipe"))
            os.mkfifo(folder / "pipe")
            name, file, words = spoilt(folder, draw, options.door)
            before = snapshot(folder)
            ended = forked(words, folder)
            ended.faults += [] if file else ["words"]
            faults = judge(ended, words, before, folder, idle, file)
            codes[name, ended.code] += 1
            if faults:
                failures.append((number, name, faults))
            if faults or options.show:
                print(f"{number} {name}: {' '.join(word[:60] for word in words)}\n  {'; '.join(faults) or 'fine'}")
                print(f"  exit {ended.code}, {ended.cpu:.1f} s, stderr: {ended.err[-1500:]!r}", flush=True)
            if options.only is not None and options.show:
                print(ended.out[-1500:], folder)
                print((folder / file).read_bytes()[:3000] if file and (folder / file).is_file() else "")
            shutil.rmtree(folder)
    kinds = Counter(name for _, name, _ in failures)
    cases = sum(codes.values())
    print(f"{len(failures)} of {cases} fail: {dict(kinds)}")
    print(
        "exit status:", dict(Counter({code: sum(n for (_, c), n in codes.items() if c == code) for _, code in codes}))
    )
    if options.record:
        record("bad_inputs.jsonl", seed=options.seed, cases=cases, failures=len(failures))
    return len(failures)


if __name__ == "__main__":
    sys.exit(min(main(tyro.cli(Options)), 1))
