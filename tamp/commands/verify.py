"""The command `tamp-verify`."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence

from tamp.system.command_line import Parser, as_command
from tamp.system.progress import Progress
from tamp.verification.classifiers import classifiers_of
from tamp.verification.tolerances import tolerances
from tamp.verification.verify import verify


@as_command(interrupted="")
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when the plan holds, 1 when it does not, 2 when it cannot be read, 130 when interrupted.

    With --strict also with 1 when it holds but for what could not be checked.
    """
    options = _parser().parse_args(arguments)
    shown.quiet = options.quiet or options.json

    shown.begin("judging")
    classifiers = classifiers_of(options.sampler)
    report = verify(options.plan, options.problem, options.domain, streams=options.streams, classifiers=classifiers)
    shown.end()

    accepted = report.holds and (report.checked or not options.strict)
    if options.json:
        print(json.dumps({**report.json(), "accepted": accepted}, indent=1))
    elif not options.quiet:
        print(report.text())
        if report.holds and not accepted:
            print("not accepted, for --strict: the verdict rests on what could not be checked")
    return 0 if accepted else 1


def _parser() -> Parser:
    parser = Parser(
        prog="tamp-verify",
        description="Judge a plan file independently of the planner: its facts by PDDL's semantics, its motions by\n"
        "pybullet's kinematics and collision detection, its limits by the robot's maker.",
        epilog="tolerances:\n"
        + "".join(f"  {what:<48}  {much}\n" for what, much in tolerances())
        + "\nExit status: 0 the plan holds, 1 it does not (with --strict: or it rests on what could not be checked),\n"
        "2 bad input. docs/adding-a-predicate.md says more of relations of one's own.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("plan", help="the plan file that tamp-solve wrote")
    parser.add_argument("--problem", metavar="FILE", help="the problem, instead of the file that the plan names")
    parser.add_argument("--domain", metavar="FILE", help="the domain, instead of the file that the plan names")
    parser.add_argument("--streams", metavar="FILE", help="the streams, instead of the file that the plan names")
    parser.add_argument(
        "--sampler",
        action="append",
        default=[],
        metavar="RELATION=FILE",
        help="what says whether a relation of your own holds: FILE.py, which is run, or FILE.safetensors; without "
        "it the relation is taken on trust, and the verdict says so (repeatable)",
    )
    parser.add_argument(
        "--strict",
        action="store_true",
        help="do not accept a verdict that rests on what could not be checked: a relation on trust, another domain or "
        "other streams than the problem's",
    )
    parser.add_argument("--json", action="store_true", help="print the report as JSON")
    parser.add_argument("--quiet", action="store_true", help="print nothing: the exit status says it")
    return parser


if __name__ == "__main__":
    sys.exit(main())
