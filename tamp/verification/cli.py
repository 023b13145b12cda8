"""The command `tamp-verify`."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence

from tamp.errors import InputError
from tamp.progress import Progress
from tamp.verification.verify import verify


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when the plan holds, 1 when it does not, 2 when it cannot be read, 130 when interrupted."""
    options = _parser().parse_args(arguments)
    shown = Progress(quiet=options.quiet or options.json)
    shown.begin("judging")
    try:
        report = verify(options.plan, options.problem, options.domain)
    except InputError as error:
        shown.end()
        print(error, file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    finally:
        shown.end()
    if options.json:
        print(json.dumps(report.json(), indent=1))
    elif not options.quiet:
        print(report.text())
    return 0 if report.holds else 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="tamp-verify",
        description="Judge a plan file independently of the planner: its facts by PDDL's semantics, its motions by "
        "pybullet's kinematics and collision detection.",
        epilog="Exit status: 0 the plan holds, 1 it does not, 2 bad input.",
    )
    parser.add_argument("plan", help="the plan file that tamp-solve wrote")
    parser.add_argument("--problem", metavar="FILE", help="the problem, instead of the file that the plan names")
    parser.add_argument("--domain", metavar="FILE", help="the domain, instead of the file that the plan names")
    parser.add_argument("--json", action="store_true", help="print the report as JSON")
    parser.add_argument("--quiet", action="store_true", help="print nothing: the exit status says it")
    return parser


if __name__ == "__main__":
    sys.exit(main())
