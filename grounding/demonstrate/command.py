"""The command `tamp-demo`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro

from grounding.demonstrate.relation import DemonstratedRelation, parse_relation
from tamp.errors import InputError
from tamp.system import guard
from tamp.system.command_line import INTERRUPTED, as_command
from tamp.system.options import read_options
from tamp.system.progress import Progress, say

USUAL = "stack(a, b)"
"""The relation to begin with, where none is named."""


@dataclass(frozen=True)
class Demo:
    """Show a relation of your own in the browser: move bodies, say whether it holds, learn it.

    Every labelled scene is written at once, as a problem file with the label as its goal
    (docs/demonstrating.md); an existing folder is continued. Ctrl-C ends it and loses nothing.

    Exit status: 0, 2 bad input, 130 ended by Ctrl-C.
    """

    relation: Annotated[str | None, tyro.conf.Positional, tyro.conf.arg(metavar="RELATION")] = None
    """The relation and its arguments, such as "stack(a, b)", "upright(o)" or "inside(a, b:
    container)"; it can be changed on the page. By default that of the folder, or stack(a, b)."""
    scene: Annotated[Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="")] = None
    """A problem file, or a shipped problem, to demonstrate in; by default scenes are generated."""
    out: Annotated[Path | None, tyro.conf.arg(metavar="DIR", help_behavior_hint="")] = None
    """The folder of the demonstrations; by default demos/RELATION."""
    seed: int = 0
    """Of the generated scenes."""
    port: Annotated[
        int, tyro.conf.arg(metavar="NUMBER", help_behavior_hint="(default: any free one)")
    ] = 0
    """Where to serve the page."""
    no_open: bool = False
    """Serve the page without opening a browser."""


@as_command(interrupted="")
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 2 for bad input, 130 or 143 when a signal ended it, as it ends the server."""
    _demonstrate(read_options(Demo, "tamp-demo", arguments))
    return INTERRUPTED if guard.asked() else 0


def _demonstrate(options: Demo) -> None:
    if not 0 <= options.seed < 2**63:
        raise InputError(f"--seed must be between 0 and 2**63, not {options.seed}")
    named = None if options.relation is None else parse_relation(options.relation)

    from grounding.demonstrate.folder import SceneSource, check_folder
    from grounding.demonstrate.runner import Runner
    from grounding.demonstrate.server import DemonstrationServer
    from grounding.demonstrate.studio import Studio
    from grounding.demonstrate.workbench import Workbench
    from tamp.view.server import check_browser, serve_until_interrupted

    relation = named or _continued(options.out) or parse_relation(USUAL)
    source = SceneSource(options.scene, options.out)
    check_folder(source.folder(relation))
    if not options.no_open:
        check_browser("Serve with tamp-demo --no-open, and open the address that it says")

    with Workbench() as workbench, Runner() as runner:
        studio = Studio(relation, source, workbench, runner, options.seed)
        with DemonstrationServer(studio, options.port) as server:
            say(f"{server.address} shows {relation} until Ctrl-C.")
            say(f"Demonstrations go to {studio.folder.path}.")
            serve_until_interrupted(server, browser=not options.no_open)


def _continued(out: Path | None) -> DemonstratedRelation | None:
    """Return the relation that a folder's demonstrations are about; None where there are none."""
    from grounding.demonstrate.folder import relation_of_folder

    return None if out is None else relation_of_folder(out)


if __name__ == "__main__":
    sys.exit(main())
