"""The command `tamp-execute`."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from pathlib import Path

from tamp.geometric.samplers.choice import Registry
from tamp.system.command_line import Parser, as_command
from tamp.system.progress import Progress, say

REACHED, NOT_REACHED = 0, 1


@as_command()
def main(shown: Progress, arguments: Sequence[str], registry: Callable[[], Registry]) -> int:
    """Exit with 0 when the goal holds at the end, 1 when it does not, 2 for bad input, 130 when interrupted."""
    given = _parser().parse_args(arguments)
    from tamp.execution.command import Options, carry_out  # after --help

    shown.quiet = given.quiet or given.json
    shown.begin("executing")
    options = Options(
        given.grasp, given.replan, given.disturb, given.seed, given.time, given.problem, tuple(given.sampler)
    )
    done = carry_out(given.plan, options, registry())
    shown.end()

    if given.json:
        say(json.dumps(done.json(), indent=1))
    elif not given.quiet:
        say(done.text())
    return REACHED if done.reached else NOT_REACHED


def _parser() -> Parser:
    parser = Parser(
        prog="tamp-execute",
        description="Carry out a plan file in physics (pybullet): motors follow its trajectories, fingers close with "
        "force and friction, bodies have mass. Says for each action how it went, and which parts of the goal hold.",
        epilog="Exit status: 0 the goal holds at the end, 1 it does not, 2 bad input. "
        "docs/watch-export-execute.md says more.",
    )
    parser.add_argument("plan", type=Path, help="the plan file that tamp-solve wrote")
    parser.add_argument(
        "--grasp",
        metavar="NAME",
        default="friction",
        help="friction (the default), or constraint: a fixed joint holds what the fingers close on",
    )
    parser.add_argument(
        "--replan",
        action="store_true",
        help="after an action that came out differently, keep the rest of the plan if it still holds, "
        "else plan anew from what is seen",
    )
    parser.add_argument(
        "--disturb",
        metavar="NAME",
        help="do something to the scene on the way: object-moved, object-dropped, grasp-slips, "
        "object-removed, surface-blocked",
    )
    parser.add_argument(
        "--seed", type=int, default=0, metavar="NUMBER", help="of the disturbance and of planning anew (0)"
    )
    parser.add_argument("--time", type=float, default=30.0, metavar="SECONDS", help="for each new plan (30)")
    parser.add_argument(
        "--sampler",
        action="append",
        default=[],
        metavar="RELATION=NAME",
        help="as for tamp-solve, over the plan's own: what says whether a relation of your own holds, and for planning "
        "anew (repeatable)",
    )
    parser.add_argument("--problem", type=Path, metavar="FILE", help="the problem, instead of the one the plan names")
    parser.add_argument("--json", action="store_true", help="print one JSON document instead of text")
    parser.add_argument("--quiet", action="store_true", help="print nothing: the exit status says it")
    return parser
