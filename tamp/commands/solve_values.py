"""The values that the steps of `tamp.commands.solve_scene` hand on to each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from tamp.commands.solve_options import Arguments, Budget
    from tamp.errors import InputError
    from tamp.execution.report import Execution
    from tamp.geometric.samplers.choice import Registry
    from tamp.planner.problem import Problem
    from tamp.planner.solution import Solution
    from tamp.planner.suggestions.why import Suggestions
    from tamp.system.progress import Progress
    from tamp.verification.report import Report


@dataclass(frozen=True)
class Request:
    """A request: what is asked for.

    Attributes:
        options: Of the command line, checked.
        registry: The learned samplers.
        budget: The time that planning may take.
        shown: Says how far the command is.
    """

    options: Arguments
    registry: Registry
    budget: Budget
    shown: Progress


@dataclass(frozen=True)
class ReadyProblem:
    """A problem that is ready to be planned.

    Attributes:
        problem: As it was loaded, with the statistics of runs before.
        load: Loads it again, with another scene.
        seconds: From the start of the command until it was loaded.
    """

    problem: Problem
    load: Callable[..., Problem]
    seconds: float

    @property
    def domain_name(self) -> str:
        """Return the name as the domain's file has it."""
        return self.problem.stream_task.task.domain.name


@dataclass(frozen=True)
class Planned:
    """The end of planning.

    Attributes:
        solution: With a plan, or without.
        stopped: Whether the user ended it: what was found is kept, and nothing begun.
    """

    solution: Solution
    stopped: bool


@dataclass(frozen=True)
class Judged:
    """The verdict: what the judge said of the plan, and whether it may be written.

    Attributes:
        verdict: The judge's, if it was asked.
        holds: Whether there is a plan that the judge does not refuse.
    """

    verdict: Report | None
    holds: bool


@dataclass(frozen=True)
class Written:
    """The files that are on disk.

    Attributes:
        plan: The plan file.
        error: Why the statistics could not be added to their file: said when all else is done.
    """

    plan: Path | None
    error: InputError | None


@dataclass(frozen=True)
class FollowUp:
    """The steps after the plan: why there is none, or how it went in physics."""

    why: Suggestions | None
    execution: Execution | None
