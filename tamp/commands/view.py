"""The command `tamp-view`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from tamp.errors import InputError
from tamp.system import guard
from tamp.system.command_line import INTERRUPTED, as_command
from tamp.system.options import read_options
from tamp.system.outputs import check_outputs
from tamp.system.progress import Progress, say
from tamp.view.outputs import OutputRequest, check_page, write_outputs


@dataclass(frozen=True)
class View:
    """Show a plan, or a scene without one.

    In the browser (the default), as a page that plays offline, as a picture, as a moving picture.

    Exit status: 0 written, 2 bad input, 130 ended by Ctrl-C.
    docs/watch-export-execute.md says what is to be seen.
    """

    what: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="PLAN|PROBLEM")]
    """A plan.json of tamp-solve, a problem.yaml, or a shipped one."""
    problem: Annotated[str | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """The problem, or a shipped one's name, instead of the file that the plan names."""
    html: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Write one HTML file that needs no network."""
    allow_outside: bool = False
    """Let the page show meshes from outside of the problem's folder."""
    png: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Write a picture: start, middle and end of a plan."""
    video: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """Write a moving picture (.gif or .webp) of a plan."""
    at: Annotated[
        tyro.conf.UseAppendAction[tuple[float, ...]],
        tyro.conf.arg(metavar="SECONDS", help_behavior_hint="(repeatable)"),
    ] = ()
    """A time for the picture."""
    size: Annotated[str | None, tyro.conf.arg(metavar="WxH", help_behavior_hint="")] = None
    """Of a picture, in pixels (800x600; moving ones 480x360)."""
    speed: Annotated[float, tyro.conf.arg(metavar="FACTOR")] = 6.0
    """Of a moving picture, times the robot's."""
    port: Annotated[
        int, tyro.conf.arg(metavar="NUMBER", help_behavior_hint="(default: any free one)")
    ] = 0
    """Where to serve the page."""
    no_browser: bool = False
    """Serve the page without opening a browser."""


@as_command(interrupted="")
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when it was written, 2 for bad input, 130 or 143 when a signal ended it, as it
    ends the server.
    """
    _view(read_options(View, "tamp-view", arguments))
    return INTERRUPTED if guard.asked() else 0


def _view(options: View) -> None:
    files = (options.html, options.png, options.video)
    request = OutputRequest(
        html=options.html,
        png=options.png,
        video=options.video,
        view=all(file is None for file in files),
        at=options.at,
        size=_size(options.size),
        speed=options.speed,
        port=options.port,
        browser=not options.no_browser,
    )
    request.check()
    from tamp.view.external_meshes import check_inside
    from tamp.view.open import open_timeline

    def check(files: Sequence[Path], meshes: Sequence[Path]) -> None:
        check_outputs(request.outputs, (*files, *meshes))
        if options.html is not None:
            check_page(options.html)
            if not options.allow_outside:
                check_inside(meshes, files[0])

    timeline, story, document = open_timeline(options.what, options.problem, check)
    write_outputs(request, timeline, story, document, Path(options.what), say)


def _size(text: str | None) -> tuple[int, int] | None:
    if text is None:
        return None
    columns, _, rows = text.lower().partition("x")
    if not (columns.isdecimal() and rows.isdecimal()):
        raise InputError(
            f"--size wants WIDTHxHEIGHT, not '{text}'", remedy="For example: --size 1200x800"
        )
    return int(columns), int(rows)


if __name__ == "__main__":
    sys.exit(main())
