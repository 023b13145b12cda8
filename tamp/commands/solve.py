"""tamp-solve: a domain and a problem in, a plan file out."""

from __future__ import annotations

import importlib
import importlib.util
import sys
import time
from typing import TYPE_CHECKING, NoReturn

from tamp.commands.solve_options import Arguments, Budget, parsed
from tamp.geometric.samplers.choice import sampler_choices
from tamp.system import guard
from tamp.system.command_line import BAD_INPUT as BAD_INPUT
from tamp.system.command_line import INTERRUPTED as INTERRUPTED
from tamp.system.command_line import as_command
from tamp.system.deadline import STANDSTILL
from tamp.system.outputs import check_writable
from tamp.system.progress import Progress

if TYPE_CHECKING:
    from tamp.geometric.samplers.choice import Registry

SOLVED, NO_PLAN = 0, 1


def main() -> NoReturn:
    """Run tamp-solve and leave the process with 0 solved, 1 no plan, 2 bad input, 130 or 143
    interrupted.
    """
    if not guard.is_guarded():
        guard.guarded("tamp.commands.solve")
    # The time that the user gives counts from here, less what the interpreter took to come here.
    started = time.monotonic() - time.process_time()
    guard.leave_as(run(sys.argv[1:], started))


def execute(arguments: list[str] | None = None) -> NoReturn:
    """Run tamp-execute."""
    from tamp.commands.execute import main

    sys.exit(main(sys.argv[1:] if arguments is None else arguments, registry))


@as_command()
def run(shown: Progress, arguments: list[str], started: float | None = None) -> int:
    """Run tamp-solve and return its exit code; `started` is when, on the monotonic clock, its time
    began.
    """
    began = time.monotonic() if started is None else started
    options = parsed(arguments)
    shown.quiet = options.quiet or options.json

    _check_outputs_writable(options)
    STANDSTILL.told = shown.compiling  # to import the planner may compile kernels
    budget = Budget(options.time, began)
    solved = (
        _solve_pddl(options, budget, shown)
        if options.is_pddl
        else _solve_scene(options, budget, shown)
    )

    if solved is None:
        return INTERRUPTED
    return SOLVED if solved else NO_PLAN


def _check_outputs_writable(options: Arguments) -> None:
    """Answer a wrong option before the planner is imported, which takes a second."""
    sampler_choices(options.scene.sampler)
    for option, file in options.outputs.items():
        if file is not None:
            check_writable(file, option)


def _solve_pddl(options: Arguments, budget: Budget, shown: Progress) -> bool | None:
    """Plan a domain and a problem in PDDL."""
    from tamp.commands.solve_pddl import solve_pddl

    return solve_pddl(options, budget, shown)


def _solve_scene(options: Arguments, budget: Budget, shown: Progress) -> bool | None:
    """Plan a problem with a scene."""
    from tamp.commands.solve_scene import solve_scene
    from tamp.commands.solve_values import Request

    return solve_scene(Request(options, registry(), budget, shown))


def registry() -> Registry:
    """Return the samplers that package grounding supplies in `grounding.registry.GROUNDINGS`:
    relation to name to a factory.

    This is the one place where the planner meets them.
    """
    if importlib.util.find_spec("grounding.registry") is None:
        return {}
    return importlib.import_module("grounding.registry").GROUNDINGS


if __name__ == "__main__":
    main()
