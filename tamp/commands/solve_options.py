"""The command line of tamp-solve: options of all problems, of those with a scene, of those in PDDL.

What an option refuses stands beside it, in its annotation; what hangs on several is in
`_check_together`. Reasons, statistics, recordings and pictures stay options here: where there is no
plan there is no plan file that another command could read them from.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from tamp.errors import InputError
from tamp.execution.grasp_modes import GRASPS
from tamp.system.options import Above, Between, OneOf, changed, check_rules, read_options

MOST_JOBS = 256
"""More processes than any machine has use for."""


@dataclass(frozen=True)
class NotWithPddl:
    """A rule: the option is refused for a problem in PDDL, and what is said then."""

    message: str


NO_SCENE = "is for problems with a scene; one in PDDL has none"
NO_STREAMS = "is for problems with a scene and streams"
NO_MOTION = "is for problems with a scene; a plan of PDDL alone has no motion"


@dataclass(frozen=True)
class SceneOptions:
    """For problems with a scene."""

    streams: Annotated[
        Path | None,
        tyro.conf.arg(metavar="FILE", help_behavior_hint="(default: beside the domain)"),
    ] = None
    """The domain's streams, DOMAIN.streams.pddl."""
    sampler: Annotated[
        tyro.conf.UseAppendAction[tuple[str, ...]],
        tyro.conf.arg(metavar="RELATION=NAME", help_behavior_hint="(repeatable)"),
    ] = ()
    """Which sampler serves a relation, such as on=uniform, on=FILE.safetensors (from tamp-learn
    train) or on=FILE.py (which says grounding = ...); the classifier of a relation of your own
    decides at the start, too. NAME:alone or NAME:mixed says whether the hand-made sampler takes
    part; it does unless NAME is hand-made, too."""
    algorithm: Annotated[str, tyro.conf.arg(metavar="NAME")] = "adaptive"
    """adaptive, or incremental (simple, for comparison)."""
    steering: Annotated[
        str | None,
        tyro.conf.arg(metavar="NAME", help_behavior_hint="(default: as the robot drives)"),
    ] = None
    """How the base moves: se2 (in any direction), reeds-shepp (like a car) or differential (turns
    on the spot, drives straight)."""
    robot: Annotated[
        str | None,
        tyro.conf.arg(metavar="ROBOT", help_behavior_hint="(default: the problem's)"),
        NotWithPddl(NO_SCENE),
    ] = None
    """A shipped robot's name, or a folder that tamp-robot made."""
    view: Annotated[bool, NotWithPddl(NO_SCENE)] = False
    """Open the plan, or the scene and what was tried, in the browser until Ctrl-C."""
    html: Annotated[
        Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint=""), NotWithPddl(NO_SCENE)
    ] = None
    """Write the same as one HTML file that plays offline."""
    allow_outside: bool = False
    """Let the page of --html show meshes from outside of the problem's folder, which its readers
    then have."""
    png: Annotated[
        Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint=""), NotWithPddl(NO_SCENE)
    ] = None
    """Write a picture: start, middle and end."""
    video: Annotated[
        Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint=""), NotWithPddl(NO_SCENE)
    ] = None
    """Write a moving picture (.gif or .webp)."""
    record: Annotated[bool, NotWithPddl(NO_SCENE)] = False
    """Keep the samples tried in the plan file, for tamp-view; --view and --html do so too. The plan
    is the same."""
    statistics: Annotated[
        Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint=""), NotWithPddl(NO_STREAMS)
    ] = None
    """Learn from run to run: how often each stream of the domain succeeds is read from this file,
    and added to it. A plan then depends on the file as well as on the seed."""
    why: Annotated[bool, NotWithPddl(NO_STREAMS)] = False
    """When there is no plan, look for small changes that make it solvable (a body gone, movable or
    smaller, a place larger or nearer, a goal less); takes up to --time again."""
    execute: Annotated[bool, NotWithPddl(NO_MOTION)] = False
    """Carry the plan out in physics, as by tamp-execute; then 1 as well when the goal does not hold
    at the end."""
    grasp: Annotated[str, tyro.conf.arg(metavar="NAME"), OneOf("grasp", GRASPS)] = "friction"
    """How the hand holds in physics: friction, or constraint (a fixed joint)."""


@dataclass(frozen=True)
class PddlOptions:
    """For problems in PDDL alone."""

    search: Annotated[
        str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="(default: greedy)")
    ] = None
    """greedy (lazy, preferred operators), eager, wastar, or astar (optimal)."""
    heuristic: Annotated[
        str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="(default: by search)")
    ] = None
    """ff, hadd, landmarks, or several with + (ff+landmarks); lmcut (astar's), hmax, blind."""

    @property
    def named(self) -> bool:
        """Return whether a search or a heuristic was chosen."""
        return bool(self.search or self.heuristic)


@dataclass(frozen=True)
class Arguments:
    """Plan for a mobile manipulator: a goal in PDDL over a scene in YAML becomes a plan of base and
    arm motions.

    Example: tamp-solve domains/cupboard.pddl problems/four_objects.yaml --seed 1 --out plan.json

    A problem in PDDL (tamp-solve domain.pddl problem.pddl) is planned as it stands, without
    scene and robot.

    Exit status: 0 solved, 1 no plan (with the reason), 2 bad input, 130 interrupted.
    """

    files: Annotated[
        tuple[str, ...],
        tyro.conf.Positional,
        tyro.conf.arg(metavar="[DOMAIN] PROBLEM", help_behavior_hint=""),
    ]
    """Files, or names of shipped ones. The domain may be left out when the problem names it."""
    scene: tyro.conf.OmitArgPrefixes[SceneOptions]
    pddl: tyro.conf.OmitArgPrefixes[PddlOptions]
    time: Annotated[
        float,
        tyro.conf.arg(metavar="SECONDS"),
        Above(0.0, "--time: the time must be positive, not {value:g}"),
    ] = 30.0
    """When to give up, counted from the start of the command."""
    seed: Annotated[
        int,
        tyro.conf.arg(metavar="NUMBER"),
        Between(1 - 2**64, 2**64 - 1, "--seed: the number must be below 2**64"),
    ] = 0
    """Of all randomness: the same seed gives the same plan."""
    out: Annotated[Path, tyro.conf.arg(metavar="FILE")] = Path("plan.json")
    """Where the plan is written; folders are made."""
    jobs: Annotated[
        int,
        tyro.conf.arg(aliases=["-j"], metavar="NUMBER"),
        Between(
            1,
            MOST_JOBS,
            f"--jobs: between 1 and {MOST_JOBS} processes, not {{value}}",
        ),
    ] = 1
    """Plan in so many processes at a time, with other seeds or other searches; the first plan
    counts. Which one that is depends on the clock; --seed (--search) as the plan file has it
    makes the plan again."""
    optimize: bool = False
    """Improve the first plan until the time is up or you press Ctrl-C: fewer actions, then shorter
    motions; the best plan is written. For a problem in PDDL: cheaper plans, until one is proven
    to be the cheapest."""
    verify: bool = False
    """Have the plan judged as by tamp-verify, and write it only when it holds."""
    json: bool = False
    """Print one JSON document instead of text."""
    quiet: bool = False
    """Print nothing but errors."""

    @property
    def is_pddl(self) -> bool:
        """Return whether the problem is in PDDL alone, without a scene."""
        return self.files[-1].endswith(".pddl")

    @property
    def outputs(self) -> dict[str, Path | None]:
        """Return what may be written, by option."""
        scene = self.scene
        return {
            "--out": self.out,
            "--html": scene.html,
            "--png": scene.png,
            "--video": scene.video,
            "--statistics": scene.statistics,
        }


@dataclass(frozen=True)
class Budget:
    """The time that the user gives.

    Attributes:
        seconds: How much.
        started: When it began, on the monotonic clock.
    """

    seconds: float
    started: float

    def elapsed(self) -> float:
        """Return seconds since the start."""
        return time.monotonic() - self.started

    def left(self) -> float:
        """Return what remains; at least half, since a first run compiles kernels as it loads."""
        return max(self.seconds - self.elapsed(), 0.5 * self.seconds)


def parsed(arguments: list[str]) -> Arguments:
    """Read the words of a command line.

    Raises:
        InputError: Something that the command does not know, or that does not go together.
    """
    chosen = read_options(Arguments, "tamp-solve", arguments)
    _check_together(chosen)
    check_rules(chosen)
    return chosen


def _check_together(chosen: Arguments) -> None:
    """Refuse options that are of no use to each other, or to this kind of problem."""
    if not 1 <= len(chosen.files) <= 2:
        raise InputError(
            f"expected [DOMAIN] PROBLEM, found {len(chosen.files)} files",
            remedy="For example: tamp-solve domains/cupboard.pddl problems/four_objects.yaml",
        )

    if chosen.is_pddl:
        for option, rule in changed(chosen.scene, NotWithPddl):
            raise InputError(f"{option} {rule.message}")
    elif chosen.pddl.named:
        raise InputError(
            "--search and --heuristic are for problems in PDDL; a scene's is chosen by --algorithm"
        )

    if chosen.optimize and (chosen.pddl.named or chosen.scene.algorithm != "adaptive"):
        raise InputError(
            "--optimize has searches of its own: leave out --search, --heuristic and --algorithm"
        )
    if chosen.optimize and chosen.jobs > 1 and chosen.is_pddl:
        raise InputError("--optimize improves a problem in PDDL in one process: leave out --jobs")
