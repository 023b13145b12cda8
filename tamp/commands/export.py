"""The command `tamp-export`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from tamp.errors import InputError
from tamp.system.command_line import as_command
from tamp.system.options import read_options
from tamp.system.outputs import check_outputs, check_writable, write_whole
from tamp.system.progress import Progress, say


@dataclass(frozen=True)
class Export:
    """Write the trajectories of a plan file for another program: names of joints, times, positions
    and velocities.

    They are those of base, arm and fingers.

    Exit status: 0 written, 2 bad input. docs/watch-export-execute.md describes the formats.
    """

    plan: Annotated[Path, tyro.conf.Positional, tyro.conf.arg(metavar="PLAN")]
    """The plan file that tamp-solve wrote."""
    format: Annotated[str, tyro.conf.arg(metavar="NAME")] = "json"
    """json, csv (a row a sample, all joints), or ros (JointTrajectory messages as JSON)."""
    out: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Where to write; else to the standard output (-)."""


@as_command(interrupted="")
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when the trajectories are written, 2 for bad input."""
    options = read_options(Export, "tamp-export", arguments)
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


if __name__ == "__main__":
    sys.exit(main())
