"""The command `tamp-verify`."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

import tyro

from tamp.system.command_line import as_command
from tamp.system.options import read_options
from tamp.system.progress import Progress
from tamp.verification.classifiers import classifiers_of
from tamp.verification.tolerances import tolerances
from tamp.verification.verify import verify


@dataclass(frozen=True)
class Verify:
    """Judge a plan file independently of the planner.

    Its facts are judged by PDDL's semantics, its limits by the robot's maker.

    Its motions are judged by a physics engine's kinematics and collision detection.
    """

    plan: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="PLAN")]
    """The plan file that tamp-solve wrote."""
    problem: Annotated[str | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """The problem, or a shipped one's name, instead of the file that the plan names."""
    domain: Annotated[str | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """The domain, or a shipped one's name, instead of the file that the plan names."""
    streams: Annotated[str | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """The streams, instead of the file that the plan names."""
    sampler: Annotated[
        tyro.conf.UseAppendAction[tuple[str, ...]],
        tyro.conf.arg(metavar="RELATION=FILE", help_behavior_hint="(repeatable)"),
    ] = ()
    """What says whether a relation of your own holds: FILE.py, which is run, or FILE.safetensors;
    without it the relation is taken on trust, and the verdict says so."""
    engine: Annotated[str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="")] = None
    """pybullet, mujoco, or both: then mujoco decides, and the report says what pybullet sees
    otherwise. Without it pybullet where it is installed, mujoco elsewhere."""
    strict: bool = False
    """Do not accept a verdict that rests on what could not be checked: a relation on trust, another
    domain or other streams than the problem's."""
    json: bool = False
    """Print the report as JSON."""
    quiet: bool = False
    """Print nothing: the exit status says it."""


@as_command(interrupted="")
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when the plan holds, 1 when it does not, 2 when it cannot be read, 130 when
    interrupted.

    With --strict also with 1 when it holds but for what could not be checked.
    """
    options = read_options(Verify, "tamp-verify", arguments, more=_more())
    shown.quiet = options.quiet or options.json

    shown.begin("judging")
    classifiers = classifiers_of(options.sampler)
    report = verify(
        options.plan,
        options.problem,
        options.domain,
        streams=options.streams,
        classifiers=classifiers,
        engine=options.engine,
    )
    shown.end()

    accepted = report.holds and (report.checked or not options.strict)
    if options.json:
        print(json.dumps({**report.json(), "accepted": accepted}, indent=1))
    elif not options.quiet:
        print(report.text())
        if report.holds and not accepted:
            print("not accepted, for --strict: the verdict rests on what could not be checked")
    return 0 if accepted else 1


def _more() -> str:
    """Say below the head of the help what is tolerated, and how the command ends."""
    rows = "\n".join(f"  {what:<48}  {much}" for what, much in tolerances())
    return f"""Tolerances:

{rows}

Exit status: 0 the plan holds, 1 it does not (with --strict: or it rests on what could not be
checked), 2 bad input.

docs/adding-a-predicate.md says more of relations of one's own."""


if __name__ == "__main__":
    sys.exit(main())
