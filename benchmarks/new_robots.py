"""Arms that do not come with tamp: from a URDF to a verified plan of one_object, by commands alone.

    python -m benchmarks.new_robots                                    # ten arms of two packages
    python -m benchmarks.new_robots iiwa jaco --seeds 3 --execute
    python -m benchmarks.new_robots --urdf mine.urdf --arm base_link tool0

Each arm is made with an empty cache of tables, as by somebody who has just installed tamp; what is compiled, is once.
The URDFs of example-robot-data come from a pinned wheel, into a folder of its own that is made where it is missing.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tyro

from benchmarks.common import record, table

PIN = "example-robot-data==6.0.0"

ARMS = {
    "ur3": ("ur3_robot", "--arm", "base_link", "tool0"),
    "ur5": ("ur5_robot", "--arm", "base_link", "tool0"),
    "ur10": ("ur10_robot", "--arm", "base_link", "tool0"),
    "xarm6": ("pybullet_data/xarm/xarm6_robot.urdf",),
    "xarm7": ("xarm7",),
    "iiwa": ("pybullet_data/kuka_iiwa/model.urdf",),
    "jaco": ("kinova",),
    "pr2": ("pr2", "--arm", "torso_lift_link", "r_wrist_roll_link"),
    "tiago_pro": ("tiago_pro", "--arm", "base_footprint", "arm_right_tool_link"),
    "panda": ("panda",),
}
"""What `tamp-robot make` is told of each arm: the file, and what it asks where that leaves a choice."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        arms: Some of the ten; all by default.
        urdf: A URDF of yours instead of them.
        arm: The links with which the arm of that URDF begins and ends.
        base: The base that each is put on: omnidirectional, differential, fixed.
        problem: What is planned with it.
        seeds: Plans, with seeds 0, 1, ...
        time: Budget of one plan, seconds.
        execute: Carry each plan out in physics, too.
        data: The folder with example-robot-data.
        out: The name of the file under benchmarks/results.
    """

    arms: tyro.conf.Positional[tuple[str, ...]] = ()
    urdf: str | None = None
    arm: tuple[str, str] | None = None
    base: str = "omnidirectional"
    problem: str = "one_object"
    seeds: int = 1
    time: float = 60.0
    execute: bool = False
    data: Path = field(default_factory=lambda: Path(tempfile.gettempdir()) / "tamp-robot-data")
    out: str = "new_robots.jsonl"


@dataclass(frozen=True)
class Said:
    """How a command ended, what it printed, and what it took."""

    code: int
    text: str
    wall_s: float
    cpu_s: float

    @property
    def reason(self) -> str:
        """Its last line, which says why where it failed."""
        lines = [line for line in self.text.splitlines() if line.strip()]
        return lines[-1] if lines else ""


def main() -> None:
    """Make, solve, judge, and carry out; a line of results for each arm."""
    options = tyro.cli(Options, description=__doc__)
    if options.urdf is not None:
        chosen = {Path(options.urdf).stem: (options.urdf, *(("--arm", *options.arm) if options.arm else ()))}
    else:
        chosen = {name: ARMS[name] for name in options.arms or ARMS}

    if not options.data.exists():
        subprocess.run(
            [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", str(options.data), PIN], check=True
        )

    rows = []
    for name, told in chosen.items():
        with tempfile.TemporaryDirectory() as folder:
            row = first_plan(name, told, Path(folder), options)
        config = {"arm": name, "told": list(told), "base": options.base, "problem": options.problem}
        record(options.out, config=config, **row)
        rows.append({"arm": name, **row})
        print(f"{name}: {row}", file=sys.stderr, flush=True)
    table(rows, "From a URDF to a plan")


def first_plan(name: str, told: tuple[str, ...], folder: Path, options: Options) -> dict[str, Any]:
    """Bring one arm in by commands alone.

    Args:
        name: Of the arm, and of its folder.
        told: The file, and what is said of it.
        folder: Empty; where everything is written, the cache included.
        options: What to plan, and how often.

    Returns:
        How many plans were found, judged good and carried out, and what it took until the first.
    """
    environment = {
        **os.environ,
        "TAMP_CACHE": str(folder / "cache"),
        "PYTHONPATH": os.pathsep.join(filter(None, [str(options.data), os.environ.get("PYTHONPATH")])),
    }
    robot, plan = folder / name, folder / "plan.json"

    made = command("tamp-robot", "make", *told, "--base", options.base, "--out", str(robot), environment=environment)
    row: dict[str, Any] = {"made": made.code == 0, "make_s": made.wall_s, "make_cpu_s": made.cpu_s}
    if made.code:
        return {**row, "solved": 0, "verified": 0, "executed": None, "first_plan_s": None, "why": made.reason}

    solved, verified, executed, why = 0, 0, 0, ""
    first_plan_s = None
    for seed in range(options.seeds):
        asked = ("--robot", str(robot), "--seed", str(seed), "--time", str(options.time), "--out", str(plan))
        found = command("tamp-solve", options.problem, *asked, environment=environment)
        if found.code:
            why = why or found.reason
            continue
        solved += 1
        if first_plan_s is None:
            first_plan_s = made.wall_s + found.wall_s

        verdict = command("tamp-verify", str(plan), environment=environment)
        verified += verdict.code == 0
        why = why or (verdict.reason if verdict.code else "")
        if options.execute:
            outcome = command("tamp-execute", str(plan), environment=environment)
            executed += outcome.code == 0
            why = why or (outcome.reason if outcome.code else "")

    return {
        **row,
        "solved": solved, "verified": verified, "executed": executed if options.execute else None,
        "first_plan_s": first_plan_s, "why": why,
    }  # fmt: skip


def command(name: str, *arguments: str, environment: dict[str, str]) -> Said:
    """Run a command of ours to its end, with nobody to answer a question."""
    program = Path(sys.executable).parent / name
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    ended = subprocess.run(
        [str(program), *arguments], env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True
    )
    wall_s = time.monotonic() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return Said(ended.returncode, ended.stdout + ended.stderr, wall_s, cpu_s)


if __name__ == "__main__":
    main()
