"""What would make a problem solvable: small changes tried one by one, those that the failure speaks of first."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

from tamp.algorithms.solution import Progress
from tamp.api import solve
from tamp.clock import Deadline
from tamp.errors import InputError
from tamp.problem import Problem
from tamp.relaxation.changes import Change, changes
from tamp.solution import Solution
from tamp.world.scene import Scene

SLICE = 5.0
"""Seconds of planning for one change at most,"""

SHARE = 8
"""and so many changes shall have their turn."""

ENOUGH = 3
"""Changes that work, after which no more are tried."""


@dataclass(frozen=True)
class Relaxation:
    """A change with which a plan was found.

    Attributes:
        text: As the end of "It would be solvable ...".
        actions: Of the plan.
        seconds: Of planning.
    """

    text: str
    actions: int
    seconds: float


@dataclass(frozen=True)
class Why:
    """The changes with which there is a plan, the smallest first, and how many were tried."""

    relaxations: tuple[Relaxation, ...]
    tried: int
    known: int

    def text(self) -> str:
        """A few lines."""
        if not self.relaxations:
            return f"  none of {self.tried} changes that were tried (of {self.known}) makes it solvable by itself"
        return "\n".join(
            f"  It would be solvable {one.text} (a plan of {one.actions} actions, found in {one.seconds:.1f} s)"
            for one in self.relaxations
        )

    def json(self) -> dict[str, object]:
        """For programs."""
        found = [{"change": r.text, "actions": r.actions, "seconds": round(r.seconds, 3)} for r in self.relaxations]
        return {"relaxations": found, "tried": self.tried, "known": self.known}


def why(
    solution: Solution,
    reload: Callable[[Scene], Problem],
    *,
    max_time: float = 30.0,
    progress: Progress | None = None,
) -> Why:
    """Try changes until some work or the time is up; Ctrl-C ends it with those found.

    Args:
        solution: One without a plan.
        reload: Makes the same problem over another scene.
        max_time: Seconds for all changes.
        progress: Called now and then with what the current attempt has done.
    """
    deadline = Deadline(max_time)
    problem = solution.problem
    said = "\n".join(solution.explanation).lower()
    told = set(re.findall(r"[\w-]+", said))
    order = sorted(
        changes(problem), key=lambda change: (not told & {name.lower() for name in change.about}, change.size)
    )
    found: list[tuple[int, Relaxation]] = []
    tried = 0
    try:
        for change in order:
            if deadline.passed or len(found) >= ENOUGH:
                break
            changed = _changed(problem, change, reload)
            if changed is None:
                continue
            attempt = solve(
                changed, max_time=min(SLICE, max_time / SHARE, deadline.left()), seed=solution.seed, progress=progress
            )
            tried += 1
            if attempt.solved and attempt.plan:
                seconds = attempt.seconds["total"]
                found.append((change.size, Relaxation(change.text, len(attempt.plan), seconds)))
    except KeyboardInterrupt:
        pass
    found.sort(key=lambda item: item[0])
    return Why(tuple(relaxation for _, relaxation in found), tried, len(order))


def _changed(problem: Problem, change: Change, reload: Callable[[Scene], Problem]) -> Problem | None:
    """The problem with a change, or None where it makes no sense, such as a goal about what is gone."""
    if change.goal is not None:
        task = replace(problem.stream_task.task, goal=change.goal)
        return replace(problem, stream_task=replace(problem.stream_task, task=task))
    try:
        return None if change.scene is None else reload(change.scene)
    except InputError:
        return None
