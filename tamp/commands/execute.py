"""The command `tamp-execute`."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from tamp.geometric.samplers.choice import Registry
from tamp.system.command_line import as_command
from tamp.system.options import read_options
from tamp.system.progress import Progress, say

REACHED, NOT_REACHED = 0, 1


@dataclass(frozen=True)
class Execute:
    """Carry out a plan file in physics and say for each action how it went, and what of
    the goal holds.

    Motors follow the plan's trajectories, fingers close with force and friction, bodies have mass.

    Exit status: 0 the goal holds at the end, 1 it does not, 2 bad input.
    docs/watch-export-execute.md says more.
    """

    plan: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="PLAN")]
    """The plan file that tamp-solve wrote."""
    grasp: Annotated[str, tyro.conf.arg(metavar="NAME")] = "friction"
    """friction, or constraint: a fixed joint holds what the fingers close on."""
    engine: Annotated[str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="")] = None
    """pybullet or mujoco; without it pybullet where it is installed, mujoco elsewhere."""
    replan: bool = False
    """After an action that came out differently, keep the rest of the plan if it still holds, else
    plan anew from what is seen."""
    disturb: Annotated[str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="")] = None
    """Do something to the scene on the way: object-moved, object-dropped, grasp-slips,
    object-removed, surface-blocked."""
    seed: Annotated[int, tyro.conf.arg(metavar="NUMBER")] = 0
    """Of the disturbance and of planning anew."""
    time: Annotated[float, tyro.conf.arg(metavar="SECONDS")] = 30.0
    """For each new plan."""
    sampler: Annotated[
        tyro.conf.UseAppendAction[tuple[str, ...]],
        tyro.conf.arg(metavar="RELATION=NAME", help_behavior_hint="(repeatable)"),
    ] = ()
    """As for tamp-solve, over the plan's own: what says whether a relation of your own holds, and
    for planning anew."""
    problem: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """The problem, or a shipped one's name, instead of the one the plan names."""
    json: bool = False
    """Print one JSON document instead of text."""
    quiet: bool = False
    """Print nothing: the exit status says it."""


@as_command()
def main(shown: Progress, arguments: Sequence[str], registry: Callable[[], Registry]) -> int:
    """Exit with 0 when the goal holds at the end, 1 when it does not, 2 for bad input, 130 when
    interrupted.
    """
    given = read_options(Execute, "tamp-execute", arguments)
    from tamp.execution.command import Options, carry_out  # after --help

    shown.quiet = given.quiet or given.json
    shown.begin("executing")
    options = Options(
        given.grasp,
        given.replan,
        given.disturb,
        given.seed,
        given.time,
        given.problem,
        given.sampler,
        given.engine,
    )
    done = carry_out(given.plan, options, registry())
    shown.end()

    if given.json:
        say(json.dumps(done.json(), indent=1))
    elif not given.quiet:
        say(done.text())
    return REACHED if done.reached else NOT_REACHED
