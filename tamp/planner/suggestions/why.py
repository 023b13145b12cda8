"""Explain by suggestions why a problem has no plan: small changes tried one by one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from tamp.errors import InputError
from tamp.geometric.scene.scene import Scene
from tamp.planner.problem import Problem
from tamp.planner.solution import Solution
from tamp.planner.solve import solve
from tamp.planner.suggestions.changes import Change, changes
from tamp.symbolic.algorithms.result import Outcome, Progress
from tamp.system.deadline import Deadline, OutOfTime

MAX_SECONDS_PER_TRIAL = 5.0
"""Seconds of planning for one change and one seed at most,"""

TRIALS_IN_THE_TIME = 8
"""and so many changes shall have their turn."""

SEEDS_PER_CHANGE = 3
"""Seeds with each of which a change must help, and without it none of them."""

SEED_STRIDE = 1
"""From one of these seeds to the next."""

ENOUGH_SUGGESTIONS = 3
"""Changes that work, after which no more are tried."""

SHOWN_FAILURES = 8
"""Changes that did not help which are listed in words."""

PROVEN_OUTCOMES = (Outcome.INFEASIBLE,)
"""Outcomes that no other seed changes."""


@dataclass(frozen=True)
class Suggestion:
    """A change with which a plan was found for each seed, and without it for none.

    Attributes:
        text: As the end of "It would be solvable ...".
        actions: Of the first seed's plan.
        seconds: Of its planning.
    """

    text: str
    actions: int
    seconds: float


@dataclass(frozen=True)
class Suggestions:
    """The changes with which there is a plan, the smallest first, and what else was tried.

    Attributes:
        suggestions: Those that helped.
        tried: How many were tried.
        considered: How many were thought of.
        failed: Those that did not help, in the order in which they were tried, each with how many
            seeds it helped.
        untried: Those for which there was no time, or no need.
        unchanged: Seeds with which there is a plan without any change.
        budget: Seconds for each change and seed.
    """

    suggestions: tuple[Suggestion, ...]
    tried: int
    considered: int
    failed: tuple[tuple[str, int], ...] = ()
    untried: tuple[str, ...] = ()
    unchanged: tuple[int, ...] = ()
    budget: float = MAX_SECONDS_PER_TRIAL

    def text(self) -> str:
        """Return a few lines for people."""
        lines = [
            f"  With --seed {seed} a plan is found as it is: no change is needed"
            for seed in self.unchanged
        ]

        for one in self.suggestions:
            plan = f"a plan of {one.actions} actions, found in {one.seconds:.1f} s"
            lines.append(
                f"  It would be solvable {one.text} "
                f"({plan}; with all of {SEEDS_PER_CHANGE} seeds, and without it none)"
            )
        if not lines:
            what = (
                f"none of {self.tried} changes that were tried (of {self.considered}) "
                "makes it solvable by itself"
            )
            lines.append(
                f"  {what}, with {SEEDS_PER_CHANGE} seeds and {self.budget:.1f} s for each"
            )

        lines += self._others(
            "tried as well, and did not help", [_failed(*one) for one in self.failed]
        )
        return "\n".join(lines + self._others("not tried", list(self.untried)))

    @staticmethod
    def _others(label: str, texts: list[str]) -> list[str]:
        more = f", and {len(texts) - SHOWN_FAILURES} more" if len(texts) > SHOWN_FAILURES else ""
        return [f"  {label}: {', '.join(texts[:SHOWN_FAILURES])}{more}"] if texts else []

    def json(self) -> dict[str, object]:
        """Return the same for programs."""
        found = [
            {"change": r.text, "actions": r.actions, "seconds": round(r.seconds, 3)}
            for r in self.suggestions
        ]
        return {
            "relaxations": found,
            "tried": self.tried,
            "known": self.considered,
            "failed": [{"change": text, "seeds": seeds} for text, seeds in self.failed],
            "untried": list(self.untried),
            "unchanged": list(self.unchanged),
            "seeds": SEEDS_PER_CHANGE,
            "budget": round(self.budget, 3),
        }


def suggest_changes(
    solution: Solution,
    reload: Callable[[Scene], Problem],
    *,
    max_time: float = 30.0,
    progress: Progress | None = None,
    trying: Callable[[str], None] | None = None,
) -> Suggestions:
    """Try changes until some work or the time is up; Ctrl-C ends it with those found.

    A change counts when it brings a plan with each of SEEDS_PER_CHANGE seeds, while the problem as
    it is has none with any of them in the same time: what is only luck is told apart from what is a
    cause.

    Args:
        solution: One without a plan.
        reload: Makes the same problem over another scene.
        max_time: Seconds for all changes.
        progress: Called now and then with what the current attempt has done.
        trying: Told what is tried next.
    """
    return _Trial(solution, reload, max_time, progress, trying or _silent).run()


class _Trial:
    """Paired runs of the problem as it is and with changes."""

    def __init__(
        self,
        solution: Solution,
        reload: Callable[[Scene], Problem],
        max_time: float,
        progress: Progress | None,
        trying: Callable[[str], None],
    ) -> None:
        self._solution, self._reload, self._progress, self._trying = (
            solution,
            reload,
            progress,
            trying,
        )
        self._deadline = Deadline(max_time)
        self._budget = min(MAX_SECONDS_PER_TRIAL, max_time / TRIALS_IN_THE_TIME)
        self._seeds = [solution.seed + SEED_STRIDE * number for number in range(SEEDS_PER_CHANGE)]
        # What failed with more time fails with less; what was proven once holds for all seeds.
        enough = (
            solution.outcome is Outcome.EXHAUSTED
            or solution.seconds.get("total", 0.0) >= self._budget
        )
        proven = solution.outcome in PROVEN_OUTCOMES
        self._unsolved = set(self._seeds if proven else self._seeds[:1] if enough else ())
        self._unchanged: list[int] = []
        self._found: list[tuple[int, Suggestion]] = []
        self._failed: list[tuple[str, int]] = []

    def run(self) -> Suggestions:
        """Run all trials, as far as the time goes."""
        told = {name for cause in self._solution.causes for name in cause.objects}
        order = sorted(
            changes(self._solution.problem),
            key=lambda change: (not told & {name.lower() for name in change.about}, change.size),
        )

        ended = 0
        try:
            for number, change in enumerate(order):
                if (
                    self._deadline.passed
                    or self._unchanged
                    or len(self._found) >= ENOUGH_SUGGESTIONS
                ):
                    break
                changed = _changed(self._solution.problem, change, self._reload)
                if changed is not None:
                    self._trying(f"trying {change.text} ({number + 1} of {len(order)})")
                    self._try(change, changed)
                ended = number + 1
        except (KeyboardInterrupt, OutOfTime):
            pass

        self._found.sort(key=lambda item: item[0])
        suggestions = () if self._unchanged else tuple(suggestion for _, suggestion in self._found)
        tried = len(self._found) + len(self._failed)
        untried = tuple(change.text for change in order[ended:])
        return Suggestions(
            suggestions, tried, len(order), tuple(self._failed), untried,
            tuple(self._unchanged), self._budget,
        )  # fmt: skip

    def _try(self, change: Change, changed: Problem) -> None:
        first = None
        for helped, seed in enumerate(self._seeds):
            attempt = self._attempt(changed, seed)
            if not attempt.solved or not attempt.plan:
                self._failed.append((change.text, helped))
                return
            first = first or attempt
        if first is not None and self._needed():
            seconds = first.seconds["total"]
            self._found.append((change.size, Suggestion(change.text, len(first.plan), seconds)))

    def _needed(self) -> bool:
        """Check that the problem as it is has no plan with any of the seeds, in the same time."""
        for seed in self._seeds:
            if seed in self._unsolved:
                continue
            self._trying(f"trying it as it is, with seed {seed}")
            if self._attempt(self._solution.problem, seed).solved:
                self._unchanged.append(seed)
                return False
            self._unsolved.add(seed)
        return True

    def _attempt(self, problem: Problem, seed: int) -> Solution:
        if self._deadline.passed:  # what was not tried with all seeds does not count
            raise OutOfTime
        attempt = solve(problem, max_time=self._budget, seed=seed, progress=self._progress)
        if attempt.outcome is Outcome.INTERRUPTED:
            raise KeyboardInterrupt
        return attempt


def _failed(text: str, seeds: int) -> str:
    return text if not seeds else f"{text} (helps with {seeds} of {SEEDS_PER_CHANGE} seeds)"


def _silent(text: str) -> None:
    pass


def _changed(
    problem: Problem, change: Change, reload: Callable[[Scene], Problem]
) -> Problem | None:
    """Apply a change to the problem; None where it makes no sense, as a goal about what is gone."""
    if change.goal is not None:
        task = replace(problem.stream_task.task, goal=change.goal)
        return replace(problem, stream_task=replace(problem.stream_task, task=task))
    try:
        return None if change.scene is None else reload(change.scene)
    except InputError:
        return None
