"""The command `tamp-view`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from tamp.errors import InputError
from tamp.system import guard
from tamp.system.command_line import INTERRUPTED, Parser, as_command
from tamp.system.outputs import check_outputs
from tamp.system.progress import Progress, say
from tamp.view.outputs import Wishes, fulfil


@as_command(interrupted="")
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when it was written, 2 for bad input, 130 or 143 when a signal ended it, as it ends the server."""
    _view(_parser().parse_args(arguments))
    return INTERRUPTED if guard.asked() else 0


def _view(options: argparse.Namespace) -> None:
    files = (options.html, options.png, options.video)
    wishes = Wishes(
        html=options.html,
        png=options.png,
        video=options.video,
        view=all(file is None for file in files),
        at=tuple(options.at),
        size=_size(options.size),
        speed=options.speed,
        port=options.port,
        browser=not options.no_browser,
    )
    wishes.check()
    from tamp.view.open import open_film
    from tamp.view.outside import check_inside

    def check(files: Sequence[Path], meshes: Sequence[Path]) -> None:
        check_outputs(wishes.outputs, (*files, *meshes))
        if options.html is not None and not options.allow_outside:
            check_inside(meshes, files[0])

    film, story, document = open_film(options.what, options.problem, check)
    fulfil(wishes, film, story, document, Path(options.what), say)


def _size(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    columns, _, rows = text.lower().partition("x")
    if not (columns.isdecimal() and rows.isdecimal()):
        raise InputError(f"--size wants WIDTHxHEIGHT, not '{text}'", remedy="For example: --size 1200x800")
    return int(columns), int(rows)


def _parser() -> Parser:
    parser = Parser(
        prog="tamp-view",
        description="Show a plan, or a scene without one: in the browser (the default), as a page that plays offline, "
        "as a picture, as a moving picture.",
        epilog="Exit status: 0 written, 2 bad input, 130 ended by Ctrl-C. "
        "docs/watch-export-execute.md says what is to be seen.",
    )
    parser.add_argument(
        "what", metavar="PLAN|PROBLEM", help="a plan.json of tamp-solve, a problem.yaml, or a shipped one"
    )
    parser.add_argument("--problem", metavar="FILE", help="the problem, instead of the file that the plan names")
    parser.add_argument("--html", metavar="FILE", type=Path, help="write one HTML file that needs no network")
    parser.add_argument(
        "--allow-outside", action="store_true", help="let the page show meshes from outside of the problem's folder"
    )
    parser.add_argument("--png", metavar="FILE", type=Path, help="write a picture: start, middle and end of a plan")
    parser.add_argument("--video", metavar="FILE", type=Path, help="write a moving picture (.gif or .webp) of a plan")
    parser.add_argument(
        "--at", metavar="SECONDS", type=float, action="append", default=[], help="a time for the picture (repeatable)"
    )
    parser.add_argument("--size", metavar="WxH", help="of a picture, in pixels (800x600; moving ones 480x360)")
    parser.add_argument("--speed", metavar="FACTOR", type=float, default=6.0, help="of a moving picture (6 times)")
    parser.add_argument("--port", metavar="NUMBER", type=int, default=0, help="where to serve the page (any free one)")
    parser.add_argument("--no-browser", action="store_true", help="serve the page without opening a browser")
    return parser


if __name__ == "__main__":
    sys.exit(main())
