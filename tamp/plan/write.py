"""Write a solution as a plan file: JSON with all that `tamp-verify` needs (plan.schema.json)."""

from __future__ import annotations

import json
import platform
import re
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.values import BaseConf, Grasp, Grip, Motion, Reach
from tamp.geometric.values import Path as Polyline
from tamp.plan.inputs import inputs_document
from tamp.plan.sources import DECIMALS
from tamp.planner.recorder import Sample
from tamp.planner.solution import Action, Solution
from tamp.planner.timed_trajectories import Segment
from tamp.planner.wanted_relations import advice
from tamp.system.distribution import distribution_version
from tamp.system.outputs import write_whole

PACKAGES = ("numpy", "numba", "ompl", "python-fcl", "pin", "EAIK")
"""Those whose versions can change a plan."""


def plan_document(solution: Solution) -> dict[str, Any]:
    """Return the plan file's content; only "timing" differs between two runs with one seed."""
    problem = solution.problem
    task = problem.stream_task.task
    samplers = dict(sorted(problem.samplers.items()))
    hidden = problem.complements | advice(task.domain)
    record = record_document(solution)

    return {
        "format": "tamp-plan",
        "version": 1,
        "inputs": inputs_document(problem.files),
        "seed": solution.seed,
        "options": {
            "algorithm": solution.algorithm,
            "samplers": samplers,
            **({"robot": problem.scene.robot.model} if problem.robot_given else {}),
        },
        "versions": {
            "tamp": distribution_version(),
            "python": platform.python_version(),
            **{name: distribution_version(name) for name in PACKAGES},
        },
        "robot": problem.scene.robot.model,
        "objects": {name: list(types) for name, types in sorted(task.objects.items())},
        "initial": [list(fact) for fact in sorted(task.initial) if fact[0] not in hidden],
        "goal": problem.goal,
        "values": {name: _value(value) for name, value in solution.values.items()},
        "certified": [list(fact) for fact in solution.certified if fact[0] not in hidden],
        "actions": [_action(action) for action in solution.plan],
        "cost": solution.cost,
        "duration": rounded(solution.duration),
        "statistics": statistics_document(solution),
        **({} if record is None else {"record": record}),
        "timing": {name: round(seconds, 6) for name, seconds in solution.seconds.items()},
    }


def record_document(solution: Solution) -> dict[str, Any] | None:
    """Return what was tried, samples and skeletons; None when it was not recorded."""
    record = solution.record
    if record is None:
        return None
    chosen = {value for value in solution.values.values() if isinstance(value, Pose | Grasp)}
    return {
        "samples": [_sample(sample, sample.value in chosen) for sample in record.samples],
        "dropped": record.dropped,
        "skeletons": [
            {
                "actions": list(attempt.actions),
                "rounds": attempt.rounds,
                "bound": attempt.bound,
                "failures": list(attempt.failures),
            }
            for attempt in record.attempts
        ],
    }


def _sample(sample: Sample, used: bool) -> dict[str, Any]:
    return {
        "stream": sample.stream,
        "arguments": [_body(name) for name in sample.arguments],
        **_value(sample.value),
        "used": used,
        "refusals": [
            {
                "stream": stream,
                "reason": reason,
                "bodies": list(sample.met.get((stream, reason), ())),
                "count": count,
            }
            for (stream, reason), count in sample.refusals.most_common()
        ],
    }


def plan_text(solution: Solution) -> str:
    """Return the plan file of a solved problem, as it is written.

    Raises:
        InputError: The solution has no plan, or a file that it was made from is gone.
    """
    if not solution.solved:
        raise InputError("there is no plan to write")
    text = json.dumps(plan_document(solution), indent=1, ensure_ascii=False, allow_nan=False)
    return _compact(text) + "\n"


def write_plan(solution: Solution, path: str | Path) -> Path:
    """Write a solved problem's plan file, whole or not at all. Folders are made.

    Raises:
        InputError: The solution has no plan, or the file cannot be written.
    """
    target = Path(path)
    content = plan_text(solution).encode()
    try:
        write_whole(target, content)
    except OSError as error:
        raise InputError(f"cannot write the plan: {error.strerror}", file=target) from error
    return target


def statistics_document(solution: Solution) -> dict[str, Any]:
    """Return how a solution was found."""
    effort = solution.effort
    return {
        "searches": effort.searches,
        "expanded": effort.expanded,
        "skeletons": effort.skeletons,
        **({"refuted": effort.refuted} if effort.refuted else {}),
        "streams": {
            name: {
                "calls": statistics.calls,
                "successes": statistics.successes,
                "rejections": dict(sorted(statistics.reasons.items())),
            }
            for name, statistics in solution.statistics.items()
        },
    }


def _action(action: Action) -> dict[str, Any]:
    return {
        "name": action.name,
        "arguments": list(action.arguments),
        "start": rounded(action.start),
        "duration": rounded(action.trajectory.duration),
        "cost": action.cost,
        "segments": [_segment(segment) for segment in action.trajectory.segments],
    }


def _segment(segment: Segment) -> dict[str, Any]:
    shared = {"part": segment.part, **_arm(segment.arm), "times": _numbers(segment.times)}
    if segment.part != "gripper":
        return {
            **shared,
            "positions": _rows(segment.positions),
            "opening": rounded(segment.opening),
            "holding": _body(segment.holding),
        }
    document: dict[str, Any] = {**shared, "opening": _numbers(segment.positions[:, 0])}
    if segment.attach is not None:
        frame = _pose(segment.attach.T_tool_body)
        document["attach"] = {"body": _body(segment.attach.body), "T_tool_body": frame}
        load = [{"body": _body(one), "T_body_rider": _pose(T)} for one, T in segment.load]
        document["attach"] |= {"load": load} if load else {}
    if segment.detach is not None:
        document["detach"] = _body(segment.detach)
    return document


def _value(value: object) -> dict[str, Any]:
    match value:
        case Pose():
            return {"type": "pose", **_pose(value)}
        case Grasp():
            frame, opening = _pose(value.T_tool_body), rounded(value.opening)
            held = {"body": _body(value.body), "T_tool_body": frame, "opening": opening}
            return {"type": "grasp", **held}
        case BaseConf():
            return {"type": "base-conf", "base": [rounded(number) for number in value.array]}
        case Reach():
            return {"type": "reach", "approach": _rows(value.approach), "lift": _rows(value.lift)}
        case Motion():
            segments = [_motion_segment(item) for item in value.segments]
            return {"type": "motion", "segments": segments}
        case _:
            return {"type": "value", "text": repr(value)}


def _motion_segment(item: Polyline | Grip) -> dict[str, Any]:
    if isinstance(item, Polyline):
        points = _rows(item.points)
        opening, holding = rounded(item.opening), _body(item.holding)
        moved = {"points": points, "opening": opening, "holding": holding}
        return {"part": item.part, **_arm(item.arm), **moved}
    attach = None if item.attach is None else _body(item.attach.body)
    return {
        "part": "gripper",
        **_arm(item.arm),
        "opening": [rounded(width) for width in item.opening],
        "attach": attach,
        "detach": _body(item.detach),
    }


def _arm(name: str | None) -> dict[str, str]:
    return {} if name is None else {"arm": name}


def _body(name: str | None) -> str | None:
    """Name a body as the plan's objects do: PDDL's names are lower case."""
    return None if name is None else name.lower()


def _pose(pose: Pose) -> dict[str, list[float]]:
    return {
        "position": [rounded(number) for number in pose.position],
        "quaternion": [round(number, 12) for number in pose.quaternion],
    }


def rounded(number: float) -> float:
    """Round a number as plan files have it."""
    return round(float(number), DECIMALS) + 0.0


def _numbers(row: Array) -> list[float]:
    return [rounded(number) for number in row]


def _rows(rows: Array) -> list[list[float]]:
    return [_numbers(row) for row in rows]


def _compact(text: str) -> str:
    """Put rows of numbers on one line each."""
    return re.sub(
        r"\[\s+([-\d.,e\s]+?)\s+\]", lambda match: "[" + " ".join(match[1].split()) + "]", text
    )
