"""The command line of tamp-solve."""

from __future__ import annotations

import contextlib
import io
import math
import os
import sys
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated

import tyro

from tamp.errors import InputError
from tamp.execution.grasp_modes import GRASPS

MOST_JOBS = 256
"""More processes than any machine has use for."""


@dataclass(frozen=True)
class Arguments:
    """Plan for a mobile manipulator: a goal in PDDL over a scene in YAML becomes a plan of base and arm motions.

    Example: tamp-solve domains/cupboard.pddl problems/four_objects.yaml --seed 1 --out plan.json

    A problem in PDDL (tamp-solve domain.pddl problem.pddl) is planned as it stands, without scene and robot.

    Exit status: 0 solved, 1 no plan (with the reason), 2 bad input, 130 interrupted.
    """

    files: Annotated[
        tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="[DOMAIN] PROBLEM", help_behavior_hint="")
    ]
    """Files, or names of shipped ones. The domain may be left out when the problem names it."""
    time: Annotated[float, tyro.conf.arg(metavar="SECONDS")] = 30.0
    """When to give up, counted from the start of the command."""
    seed: Annotated[int, tyro.conf.arg(metavar="NUMBER")] = 0
    """Of all randomness: the same seed gives the same plan."""
    out: Annotated[Path, tyro.conf.arg(metavar="FILE")] = Path("plan.json")
    """Where the plan is written; folders are made."""
    streams: Annotated[
        Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="(default: beside the domain)")
    ] = None
    """The domain's streams, DOMAIN.streams.pddl."""
    sampler: Annotated[
        tyro.conf.UseAppendAction[tuple[str, ...]],
        tyro.conf.arg(metavar="RELATION=NAME", help_behavior_hint="(repeatable)"),
    ] = ()
    """Which sampler serves a relation, such as on=uniform, on=FILE.safetensors (from tamp-learn train) or on=FILE.py
    (which says grounding = ...); the classifier of a relation of your own decides at the start, too. NAME:alone or
    NAME:mixed says whether the hand-made sampler takes part; it does unless NAME is hand-made, too."""
    algorithm: Annotated[str, tyro.conf.arg(metavar="NAME")] = "adaptive"
    """adaptive, or incremental (simple, for comparison)."""
    steering: Annotated[str, tyro.conf.arg(metavar="NAME")] = "se2"
    """How the base moves: se2 (in any direction) or reeds-shepp (like a car)."""
    search: Annotated[str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="(default: greedy)")] = None
    """Of a PDDL problem: greedy (lazy, preferred operators), eager, wastar, or astar (optimal)."""
    heuristic: Annotated[str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="(default: by search)")] = None
    """Of a PDDL problem: ff, hadd, landmarks, or several with + (ff+landmarks); lmcut (astar's), hmax, blind."""
    jobs: Annotated[int, tyro.conf.arg(aliases=["-j"], metavar="NUMBER")] = 1
    """Plan in so many processes at a time, with other seeds or other searches; the first plan counts. Which
    one that is depends on the clock; --seed (--search) as the plan file has it makes the plan again."""
    optimize: bool = False
    """Improve the first plan until the time is up or you press Ctrl-C: fewer actions, then shorter motions; the best
    plan is written. For a problem in PDDL: cheaper plans, until one is proven to be the cheapest."""
    verify: bool = False
    """Have the plan judged as by tamp-verify, and write it only when it holds."""
    view: bool = False
    """Open the plan, or the scene and what was tried, in the browser until Ctrl-C."""
    html: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Write the same as one HTML file that plays offline."""
    allow_outside: bool = False
    """Let the page of --html show meshes from outside of the problem's folder, which its readers then have."""
    png: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Write a picture: start, middle and end."""
    video: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Write a moving picture (.gif or .webp)."""
    record: bool = False
    """Keep the samples tried in the plan file, for tamp-view; --view and --html do so too. The plan is the same."""
    execute: bool = False
    """Carry the plan out in physics, as by tamp-execute; then 1 as well when the goal does not hold at the end."""
    grasp: Annotated[str, tyro.conf.arg(metavar="NAME")] = "friction"
    """How the hand holds in physics: friction, or constraint (a fixed joint)."""
    statistics: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Learn from run to run: how often each stream of the domain succeeds is read from this file, and added to it. A
    plan then depends on the file as well as on the seed."""
    why: bool = False
    """When there is no plan, look for small changes that make it solvable (a body gone, movable or smaller, a place
    larger or nearer, a goal less); takes up to --time again."""
    json: bool = False
    """Print one JSON document instead of text."""
    quiet: bool = False
    """Print nothing but errors."""

    @property
    def outputs(self) -> dict[str, Path | None]:
        """What may be written, by option."""
        return {f"--{name}": getattr(self, name) for name in ("out", "html", "png", "video", "statistics")}


def parsed(arguments: list[str]) -> Arguments:
    """What the words of a command line say.

    Raises:
        InputError: Something that the command does not know.
    """
    names = [option.name.replace("_", "-") for option in fields(Arguments) if option.name != "files"]
    options = [f"--{name}" for name in (*names, "help")]
    for word in arguments:
        name = word.partition("=")[0].replace("_", "-")
        if name.startswith("--") and name not in options:
            raise InputError(f"unknown option '{name}'", found=name, choices=options)
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            config = (tyro.conf.FlagCreatePairsOff,)
            chosen = tyro.cli(Arguments, prog="tamp-solve", args=arguments, config=config)
    except SystemExit as end:
        if not end.code:  # --help
            raise
        raise InputError(sentence(complaint.getvalue()), remedy="See tamp-solve --help") from None
    except BrokenPipeError:
        raise unread() from None
    if not 1 <= len(chosen.files) <= 2:
        raise InputError(
            f"expected [DOMAIN] PROBLEM, found {len(chosen.files)} files",
            remedy="For example: tamp-solve domains/cupboard.pddl problems/four_objects.yaml",
        )
    if not chosen.files[-1].endswith(".pddl") and (chosen.search or chosen.heuristic):
        raise InputError("--search and --heuristic are for problems in PDDL; a scene's is chosen by --algorithm")
    shown = [name for name in ("view", "html", "png", "video", "record") if getattr(chosen, name)]
    if chosen.files[-1].endswith(".pddl") and shown:
        raise InputError(f"--{shown[0]} is for problems with a scene; one in PDDL has none")
    if chosen.files[-1].endswith(".pddl") and (chosen.statistics or chosen.why):
        raise InputError(f"--{'statistics' if chosen.statistics else 'why'} is for problems with a scene and streams")
    if chosen.files[-1].endswith(".pddl") and chosen.execute:
        raise InputError("--execute is for problems with a scene; a plan of PDDL alone has no motion")
    if chosen.grasp not in GRASPS:
        raise InputError(f"unknown grasp '{chosen.grasp}'", found=chosen.grasp, choices=GRASPS)
    if math.isnan(chosen.time) or chosen.time <= 0.0:
        raise InputError(f"--time: the time must be positive, not {chosen.time:g}")
    if chosen.optimize and (chosen.search or chosen.heuristic or chosen.algorithm != "adaptive"):
        raise InputError("--optimize has searches of its own: leave out --search, --heuristic and --algorithm")
    if chosen.optimize and chosen.jobs > 1 and chosen.files[-1].endswith(".pddl"):
        raise InputError("--optimize improves a problem in PDDL in one process: leave out --jobs")
    if not 1 <= chosen.jobs <= MOST_JOBS:
        raise InputError(f"--jobs: between 1 and {MOST_JOBS} processes, not {chosen.jobs}")
    if abs(chosen.seed) >= 2**64:
        raise InputError("--seed: the number must be below 2**64")
    return chosen


def unread() -> SystemExit:
    """The end of a command whose help nobody reads to its end (`--help | head`); Python must not flush the rest."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return SystemExit(0)


def sentence(box: str) -> str:
    """What tyro says in the first paragraph of its frame, in words that are no programmer's."""
    lines = [line.strip(" │|╭╮╰╯") for line in box.splitlines()]
    title, *said = [line for line in lines if line] or ["bad arguments"]
    paragraph: list[str] = []
    for line in said:
        if set(line) <= {"─", "-"}:
            if paragraph:
                break
            continue
        paragraph.append(line)
    text = " ".join(paragraph).rstrip(".") or title
    text = text.removeprefix("Error parsing ").replace("invalid literal for int() with base 10:", "no whole number:")
    return text.replace("could not convert string to float:", "no number:")
