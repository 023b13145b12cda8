"""The command `tamp-export`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from tamp.errors import InputError
from tamp.system.command_line import Parser, as_command
from tamp.system.outputs import check_outputs, check_writable, write_whole
from tamp.system.progress import Progress, say


@as_command(interrupted="")
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when the trajectories are written, 2 for bad input."""
    options = _parser().parse_args(arguments)
    _export(options.plan, options.format, options.out)
    return 0


def _export(file: Path, name: str, out: Path | None) -> None:
    if out is not None and str(out) == "-":
        out = None
    if out is not None:
        check_writable(out)
    from tamp.export.formats import FORMATS
    from tamp.export.trajectory import timed_actions
    from tamp.plan.open import read_motions, robot_of

    if name not in FORMATS:
        raise InputError(f"unknown format '{name}'", found=name, choices=tuple(FORMATS))
    plan = read_motions(file)
    sources = [source.path for source in plan.sources]
    check_outputs({"--out": out}, (file, *sources, *(file.parent / path.name for path in sources)))
    robot = robot_of(plan)
    text = FORMATS[name](plan, robot, timed_actions(plan, robot))
    if out is None:
        say(text.rstrip("\n"))
        return
    try:
        write_whole(out, text.encode())
    except OSError as error:
        raise InputError(f"cannot write the trajectories: {error.strerror}", file=out) from error


def _parser() -> Parser:
    parser = Parser(
        prog="tamp-export",
        description="Write the trajectories of a plan file for another program: joint names, times, positions and "
        "velocities of base, arm and fingers.",
        epilog="Exit status: 0 written, 2 bad input. docs/watch-export-execute.md describes the formats.",
    )
    parser.add_argument("plan", type=Path, help="the plan file that tamp-solve wrote")
    parser.add_argument(
        "--format",
        metavar="NAME",
        default="json",
        help="json (the default), csv (a row a sample, all joints), or ros (JointTrajectory messages as JSON)",
    )
    parser.add_argument("--out", metavar="FILE", type=Path, help="where to write; else to the standard output (-)")
    return parser


if __name__ == "__main__":
    sys.exit(main())
