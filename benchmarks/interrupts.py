"""Whether Ctrl-C and SIGTERM end every command, wherever in its run they come.

python -m benchmarks.interrupts --moments 100

Each command is measured once from start to end; then signals are sent at random moments of that time, to its process
alone or to all of its group as a terminal does. A run is lost when it goes on for longer than `LATE`, the time not
counted for which it had to wait for a core; "left" counts processes of its session that were still there a second
later. Signals sent while Python itself is starting (`--after`) show its own traceback, which no program can prevent.
"""

from __future__ import annotations

import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import tyro

from benchmarks.common import record, table
from tamp.system.files import shipped

LATE = 1.0
"""Seconds after the signal."""

LONGEST = 12.0
"""Seconds of a command at most, of which the moments are drawn."""

SCRIPTS = Path(sys.executable).parent

PDDL = """(define (problem large) (:domain d) (:objects {objects} - t) (:init (p o1) (p o2))
(:goal (forall (?a ?b ?c ?d ?e ?f ?g ?h - t) (or (q ?a) (p ?b)))))"""

DOMAIN = """(define (domain d) (:requirements :strips :typing) (:types t) (:predicates (p ?x - t) (q ?x - t))
(:action a :parameters (?x - t) :precondition (p ?x) :effect (q ?x)))"""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        moments: Signals in all.
        seed: Of the moments.
        only: Part of the command lines to take; all by default.
        after: The earliest moment, seconds: until then Python starts, and this program is not yet run.
    """

    moments: int = 100
    seed: int = 0
    only: str = ""
    after: float = 0.03


@dataclass(frozen=True)
class Ended:
    """How a command ended after a signal.

    Attributes:
        late: Seconds from the signal to the end, those not counted that it waited for a core.
        code: The exit code.
        said: Its standard error.
        left: Processes of its session that were still there.
        sent: Whether it was still running when the signal came.
    """

    late: float
    code: int
    said: str
    left: int
    sent: bool


def commands(folder: Path) -> list[list[str]]:
    """The command lines, with what they need made in `folder`."""
    domain, problem = folder / "d.pddl", folder / "t.pddl"
    domain.write_text(DOMAIN)
    problem.write_text(PDDL.format(objects=" ".join(f"o{k}" for k in range(1, 40))))
    plan, data = str(folder / "kept.json"), str(folder / "on.npz")
    weights, meshes = str(folder / "w.safetensors"), [str(path) for path in shipped("problems").glob("one_object.yaml")]
    run(["tamp-solve", "one_object", "--out", plan, "--quiet"], folder)
    run(["tamp-learn", "generate", "on", "--count", "400", "--out", data], folder)
    solve = ["tamp-solve", "four_objects", "--out", str(folder / "plan.json")]
    return [
        solve,
        [*solve, "--jobs", "2"],
        [*solve, "--optimize", "--time", "8"],
        [*solve, "--jobs", "2", "--optimize", "--time", "8"],
        [*solve, "--verify", "--execute"],
        [*solve, "--html", str(folder / "page.html")],
        ["tamp-solve", "impossible_size", "--why", "--time", "6", "--out", str(folder / "plan.json")],
        ["tamp-solve", str(domain), str(problem), "--time", "5", "--out", str(folder / "plan.json")],
        ["tamp-solve", str(domain), str(problem), "--time", "5", "--jobs", "2", "--out", str(folder / "plan.json")],
        ["tamp-verify", plan],
        ["tamp-execute", plan],
        ["tamp-export", plan],
        ["tamp-view", plan, "--no-browser"],
        ["tamp-demo", "upright(o)", "--no-open", "--out", str(folder / "shown")],
        ["tamp-view", plan, "--video", str(folder / "film.gif")],
        ["tamp-bench", "run", "--problems", "one_object", "--seeds", "40", "--jobs", "2", "--out", "bench.jsonl"],
        ["tamp-bench", "run", "--problems", "one_object", "--seeds", "9", "--ray", "local", "--out", "ray.jsonl"],
        ["tamp-learn", "generate", "on", "--count", "2000", "--workers", "2", "--out", str(folder / "g.npz")],
        ["tamp-learn", "generate", "on", "--count", "200", "--workers", "1", "--out", str(folder / "h.npz")],
        ["tamp-learn", "explore", "on", "--count", "400", "--workers", "2", "--out", str(folder / "e.npz")],
        ["tamp-learn", "collect", "near", *meshes, "--out", str(folder / "c.npz")],
        ["tamp-learn", "train", "on", "--data", data, "--model", "transfer", "--out", weights],
        ["tamp-learn", "train", "on", "--data", data, "--model", "mlp-bb", "--iterations", "3000", "--out", weights],
        ["tamp-learn", "evaluate", "on=transfer", "--data", data, "--scenes", "100"],
    ]


def run(command: list[str], folder: Path) -> None:
    """Run a command to its end."""
    subprocess.run([SCRIPTS / command[0], *command[1:]], cwd=folder, capture_output=True, check=True)


def interrupted(command: list[str], folder: Path, moment: float, number: int, group: bool) -> Ended:
    """Start a command, send it a signal after `moment` seconds, and see."""
    with tempfile.TemporaryFile() as said:
        process = subprocess.Popen(
            [SCRIPTS / command[0], *command[1:]],
            cwd=folder,
            stdout=subprocess.DEVNULL,
            stderr=said,
            start_new_session=True,
            preexec_fn=hears,
        )
        end = time.monotonic() + moment
        while time.monotonic() < end and process.poll() is None:
            time.sleep(min(0.01, max(0.0, end - time.monotonic())))
        sent = process.poll() is None
        waited, since = queued(process.pid), time.monotonic()
        if sent:
            (os.killpg if group else os.kill)(process.pid, number)
        late, known = 0.0, waited
        while process.poll() is None and late < 6 * LATE:
            time.sleep(0.01)
            known = max(known, queued(process.pid))
            late = time.monotonic() - since - (known - waited)
        code = process.returncode if process.poll() is not None else -signal.SIGKILL
        end = time.monotonic() + 1.0
        while members(process.pid) and time.monotonic() < end:
            time.sleep(0.02)
        left = members(process.pid)
        for pid in left:
            os.kill(pid, signal.SIGKILL)
        process.wait()
        said.seek(0)
        return Ended(late, code, said.read().decode(errors="replace"), len(left), sent)


def hears() -> None:
    """A shell's job in the background would not hear Ctrl-C."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


def members(session: int) -> list[int]:
    """The processes of a session that have not ended."""
    found: list[int] = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text(encoding="utf-8", errors="replace").rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[3]) == session and fields[0] not in "ZX":
            found.append(int(folder.name))
    return found


def queued(session: int) -> float:
    """The longest time, seconds, for which a process of a session has waited for a core."""
    longest = 0.0
    for pid in members(session):
        try:
            longest = max(longest, int(Path(f"/proc/{pid}/schedstat").read_text().split()[1]) * 1e-9)
        except (OSError, IndexError):
            continue
    return longest


def wrong(ended: Ended, number: int) -> bool:
    """Whether an exit code is not one of a command that a signal has ended, or that had ended before it was heard."""
    return ended.sent and ended.code not in (128 + number, 0)


def main(options: Options) -> None:
    rng = random.Random(options.seed)
    rows: list[dict[str, object]] = []
    folder = Path(tempfile.mkdtemp())
    try:
        chosen = [line for line in commands(folder) if options.only in " ".join(line)]
        spans: dict[int, float] = {}
        for k in range(options.moments):
            which = k % len(chosen)
            command = chosen[which]
            if which not in spans:
                spans[which] = span(command, folder)
            moment = options.after + rng.random() * max(0.0, spans[which] - options.after)
            number, group = rng.choice((signal.SIGINT, signal.SIGTERM)), rng.random() < 0.3
            for file in ("bench.jsonl", "ray.jsonl"):
                (folder / file).unlink(missing_ok=True)
            ended = interrupted(command, folder, moment, number, group)
            line = re.sub(rf"{folder}/", "", " ".join(command))
            row = {
                "command": line,
                "at_s": round(moment, 3),
                "signal": number.name,
                "group": group,
                "late_s": round(ended.late, 3),
                "code": ended.code,
                "lost": ended.sent and ended.late > LATE,
                "traceback": "Traceback" in ended.said,
                "wrong": wrong(ended, number),
                "left": ended.left,
                "sent": ended.sent,
            }
            rows.append(row)
            if row["lost"] or row["traceback"] or row["wrong"] or row["left"]:
                print(row, ended.said[-2000:], sep="\n", flush=True)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    counts = {name: sum(bool(row[name]) for row in rows) for name in ("sent", "lost", "traceback", "wrong", "left")}
    latest = max((float(str(row["late_s"])) for row in rows if row["sent"]), default=0.0)
    config = {"moments": options.moments, "after_s": options.after}
    record("interrupts.jsonl", seed=options.seed, config=config, **counts, latest_s=latest)
    table([{"moments": len(rows), **counts, "latest [s]": latest}], "signals at random moments")


def span(command: list[str], folder: Path) -> float:
    """How long a command runs by itself, seconds, at most `LONGEST`."""
    started = time.monotonic()
    ended = interrupted(command, folder, LONGEST, signal.SIGKILL, True)
    return min(LONGEST, time.monotonic() - started) if not ended.sent else LONGEST


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
