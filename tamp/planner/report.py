"""A solution in words."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable

from tamp.errors import printable
from tamp.planner.problem import Problem
from tamp.planner.relation_words import relation_words
from tamp.planner.solution import Action, Solution
from tamp.planner.timed_trajectories import Segment
from tamp.stream import StreamKind
from tamp.symbolic.algorithms.result import Outcome
from tamp.symbolic.pddl.structs import And

LINE_COLUMNS = 110
"""Columns of the longest line that is not wrapped."""

MAX_FAILURE_LINES = 8
"""Lines about what failed."""

SUPPORT_PREDICATES = ("supported", "contained")
"""Predicates that say where a body is; one of the user's may speak of a place where it is not."""


NOT_STREAM_PARTS = ("search", "timing", "explaining", "other tries")
"""Parts of the time that are no streams'."""


def headline(problem: Problem) -> str:
    """Describe the problem in one line."""
    goal = problem.stream_task.task.goal
    goals = len(goal.parts) if isinstance(goal, And) else 1
    movable = len(problem.scene.movable)
    return (
        f"{printable(problem.name)}: {_count(goals, 'goal')}, "
        f"{movable} movable of {_count(len(problem.scene.bodies), 'body')}, "
        f"{problem.scene.robot.model}"
    )


def summary(solution: Solution, loading: float = 0.0) -> str:
    """Summarize the planning for the command line, after so many seconds of loading."""
    lines = [f"warning: {warning}" for warning in solution.warnings]
    total = solution.seconds.get("total", 0.0)
    if solution.solved:
        count = _count(len(solution.plan), "action")
        moving = f"{solution.duration:.1f} s of motion"
        lines.append(f"Solved in {total:.2f} s: {count}, {moving}, cost {solution.cost:g}")
        lines += ["", *_rows(solution)] if solution.plan else ["  the goal holds at the start"]
    else:
        lines += _no_plan(solution, total)
    if solution.improvements and solution.bound is not None:
        better = _count(len(solution.improvements) - 1, "improvement")
        lines += [
            "",
            f"  {better}; lower bound of the cost {solution.bound:g}, "
            f"gap {100 * (solution.gap or 0.0):.0f} %",
        ]
    return "\n".join([*lines, *_tried(solution), "", *_effort(solution, loading)])


def improvement(solution: Solution) -> str:
    """Describe the latest improvement in one line."""
    latest = solution.improvements[-1]
    count = _count(latest.actions, "action")
    line = (
        f"{latest.seconds:7.2f} s  {count}, {latest.duration:.1f} s of motion, cost {latest.cost:g}"
    )
    if solution.bound is None or solution.gap is None:
        return line
    return f"{line}, no plan below {solution.bound:g}, gap {100 * solution.gap:.0f} %"


def _no_plan(solution: Solution, total: float) -> list[str]:
    sentence = {
        Outcome.TIMEOUT: f"No plan in {total:.1f} s",
        Outcome.INTERRUPTED: f"Interrupted after {total:.1f} s, no plan yet",
    }.get(solution.outcome, solution.outcome.value)
    if len(solution.explanation) == 1:
        mark = "." if solution.outcome is Outcome.INFEASIBLE else ":"
        return [f"{sentence}{mark} {solution.explanation[0]}"]
    return [
        f"{sentence}{':' if solution.explanation else '.'}",
        *(f"  {line}" for line in solution.explanation),
    ]


def _tried(solution: Solution) -> list[str]:
    """List what failed most, by action and stream, in columns."""
    rows = [tally for tally in solution.tallies if tally.failures][:MAX_FAILURE_LINES]
    if not rows:
        return []
    title = "what was tried for"
    actions = max(len(title), *(len(tally.action) for tally in rows))
    streams = max(len(tally.stream) for tally in rows)
    lines = ["", f"  {title:{actions}}  {'by':{streams}}  {'worked':>15}   why not"]
    for tally in rows:
        worked = f"{tally.successes:,} of {tally.tries:,}"
        reasons = ", ".join(f"{count:,} {reason}" for reason, count in tally.reasons.most_common(3))
        lines.append(
            f"  {tally.action:{actions}}  {tally.stream:{streams}}  {worked:>15}   {reasons}"
        )
    return lines


def _rows(solution: Solution) -> list[str]:
    """List the actions in columns: number, name, bodies, where, how long."""
    places, relations = _places(solution), relation_words(solution)
    rows: list[tuple[str, str, str]] = []
    for action in solution.plan:
        bases = [segment for segment in action.trajectory.segments if segment.part == "base"]
        where = _move(bases, first=not rows) if bases else _manipulated(action, places)
        what = [name for name in action.objects if name not in where.split()]
        if not bases and not where.startswith("from "):
            where = f"{_named(action, relations)} {where}".strip()
        rows.append((action.name, " ".join(what), where))
    widths = [max(len(row[column]) for row in rows) for column in range(3)]
    columns = [
        "  ".join(f"{text:<{width}}" for text, width in zip(row, widths, strict=True))
        for row in rows
    ]
    durations = [f"{action.trajectory.duration:5.1f} s" for action in solution.plan]
    return [
        f"  {number:2d}  {row}  {duration}"
        for number, (row, duration) in enumerate(zip(columns, durations, strict=True), start=1)
    ]


def _places(solution: Solution) -> dict[tuple[str, str], str]:
    """Map body and pose names to the place: what a fact such as (supported mug p1 table) says."""
    problem = solution.problem
    scene = problem.scene
    scene_names = {
        place.lower(): place for place in (*scene.surfaces, *scene.cavities, *scene.bodies)
    }
    places: dict[tuple[str, str], str] = {}
    facts = (*sorted(problem.stream_task.task.initial), *solution.certified)
    for fact in sorted(facts, key=lambda fact: fact[0] not in SUPPORT_PREDICATES):
        if len(fact) == 4 and fact[3] in scene_names and fact[3] not in solution.values:
            name = scene_names[fact[3]]
            places.setdefault(
                (fact[1], fact[2]), f"in {name}" if name in scene.cavities else f"on {name}"
            )
    return places


def _named(action: Action, said: dict[tuple[str, str], str]) -> str:
    """Return what is said of a body and a pose among an action's arguments."""
    names = action.arguments
    return next((said[body, pose] for body in names for pose in names if (body, pose) in said), "")


def _manipulated(action: Action, places: dict[tuple[str, str], str]) -> str:
    """Say where a body is taken from, or put."""
    where = _named(action, places)
    taken = any(segment.attach is not None for segment in action.trajectory.segments)
    return f"from {where.partition(' ')[2]}" if where and taken else where


def _move(segments: list[Segment], first: bool) -> str:
    start = f"{_base(segments[0], 0)} " if first else ""
    return f"{start}-> {_base(segments[-1], -1)}"


def _base(segment: Segment, index: int) -> str:
    x, y, yaw = segment.positions[index]
    degrees = math.degrees(math.remainder(float(yaw), 2 * math.pi))
    return f"({x + 0.0:.2f}, {y + 0.0:.2f}, {degrees + 0.0:.0f}°)"


def _effort(solution: Solution, loading: float) -> list[str]:
    total = max(solution.seconds.get("total", 0.0), 1e-9)
    kinds = {one.name: one.kind for one in solution.problem.stream_task.streams}
    parts: dict[str, float] = {}
    for name, seconds in solution.seconds.items():
        part = name if name in NOT_STREAM_PARTS else kinds.get(name, StreamKind.OTHER).value
        if name != "total":
            parts[part] = parts.get(part, 0.0) + seconds

    unnamed = "improving" if solution.improvements else "other"
    times = [f"{part} {share} %" for part, share in time_shares(parts, total, unnamed)]
    passed = f"{total:.1f} s" + (f" after {loading:.1f} s of loading" if loading else "")

    effort = solution.effort
    searched = [
        _count(effort.skeletons, "skeleton"),
        _count(effort.searches, "search", "searches"),
        f"{_count(effort.expanded, 'state')} expanded",
        *([f"{_count(effort.refuted, 'plan')} dropped in the replay"] if effort.refuted else ()),
    ]

    samples: list[str] = []
    for name, statistics in solution.statistics.items():
        if statistics.calls:
            reasons = ", ".join(
                f"{count} {reason}" for reason, count in statistics.reasons.most_common(3)
            )
            kept = _glued(f"{name} {statistics.successes} of {statistics.calls}")
            samples.append(f"{kept}{f' ({reasons})' if reasons else ''}")

    return [
        *_listed("time", map(_glued, times), passed),
        *_listed("search", map(_glued, searched)),
        *_listed("samples", samples),
    ]


def time_shares(parts: dict[str, float], total: float, unnamed: str) -> list[tuple[str, int]]:
    """Round shares of time to percents of sum 100, largest first; `unnamed` is what no part
    claims.
    """
    told = {part: seconds for part, seconds in parts.items() if seconds > 0.005 * total}
    told[unnamed] = max(0.0, total - sum(told.values()))
    whole = max(total, sum(told.values()))
    exact = {part: 100.0 * seconds / whole for part, seconds in told.items()}
    shares = {part: math.floor(share) for part, share in exact.items()}
    nearest = sorted(exact, key=lambda part: shares[part] - exact[part])
    for part in nearest[: 100 - sum(shares.values())]:
        shares[part] += 1
    order = sorted(shares, key=lambda part: (part == unnamed, -exact[part]))
    return [(part, shares[part]) for part in order if shares[part] > 0]


def _glued(text: str) -> str:
    """Return the same with spaces at which a line is not broken."""
    return text.replace(" ", "\u00a0")


def _listed(label: str, items: Iterable[str], first: str = "") -> list[str]:
    """Wrap items after a label, perhaps with something before a colon."""
    lines = textwrap.wrap(
        "\u00a0· ".join(items),
        LINE_COLUMNS,
        initial_indent=f"  {label:<9}{f'{first}: ' if first else ''}",
        subsequent_indent=" " * 11,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return [line.replace("\u00a0", " ").removesuffix(" ·") for line in lines]


def _count(number: int, one: str, many: str | None = None) -> str:
    plural = many or (one[:-1] + "ies" if one.endswith("y") else one + "s")
    return f"{number:,} {one if number == 1 else plural}"
