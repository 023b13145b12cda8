"""The way from what a user names, or has just planned, to a timeline and its story."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.loading.robot_folder import ROBOT_FILE
from tamp.geometric.loading.robots import ROBOTS, find_robot, load_robot
from tamp.plan.named_files import named_files
from tamp.plan.open import open_plan
from tamp.plan.read import read_plan
from tamp.plan.summary import summary_document
from tamp.plan.write import plan_document, record_document
from tamp.planner.solution import Solution
from tamp.view.robot_timeline import described, robot_timeline
from tamp.view.story import PlanningSummary, planning_summary
from tamp.view.timeline import Timeline, timeline_of

Opened = tuple[Timeline, PlanningSummary, dict[str, Any]]
"""A timeline, its story, and the plan file's content (empty without a plan)."""


def _read(files: Sequence[Path], meshes: Sequence[Path]) -> None:
    pass


def open_timeline(
    what: str,
    problem: str | None = None,
    read: Callable[[Sequence[Path], Sequence[Path]], None] = _read,
) -> Opened:
    """Open a plan file (.json), a robot by its folder or name, or a problem by file or name.

    Args:
        what: The file or the name.
        problem: The problem's file, instead of the one that the plan names.
        read: Told of the files that it was read from or that it names, the problem first, and of
            the meshes.

    Raises:
        InputError: Neither, or something is wrong with it.
    """
    if what.endswith(".json"):
        stored = open_plan(what, problem)
        sources = [source.path for source in stored.plan.sources]
        beside = [Path(what).parent / path.name for path in sources]
        named = named_files(stored.loaded)
        read((stored.loaded.path, Path(what), *sources, *beside, *named), _shown(stored.loaded))
        timeline = timeline_of(stored.loaded.scene, stored.robot, stored.plan)
        return timeline, planning_summary(stored.document, Path(what)), stored.document

    if what in ROBOTS or (Path(what) / ROBOT_FILE).is_file():
        model = find_robot(what)
        robot = load_robot(model)
        read(robot.files, ())
        return robot_timeline(robot, model), PlanningSummary(described(robot)), {}

    if problem is not None:
        raise InputError("--problem goes with a plan", remedy="Name a plan file before it")
    loaded = load_scene(what)
    read((loaded.path, *named_files(loaded)), _shown(loaded))
    scene = loaded.scene
    goal = " ".join(loaded.goal.text.split())
    head = f"{len(scene.bodies)} bodies, {len(scene.movable)} movable · goal {goal}"
    return timeline_of(scene, load_robot(scene.robot.model)), PlanningSummary(head), {}


def _shown(loaded: LoadedProblem) -> tuple[Path, ...]:
    """List the mesh files that may be shown: those a plan depends on, and those only drawn."""
    return (*loaded.meshes, *loaded.drawn)


def timeline_of_solution(solution: Solution) -> Opened:
    """Make the timeline of what `solve` returned: of the plan, or of the scene without one."""
    problem = solution.problem
    robot = problem.context.robot
    if solution.solved:
        document = plan_document(solution)
        return (
            timeline_of(problem.scene, robot, read_plan(document)),
            planning_summary(document),
            document,
        )
    document = {**summary_document(solution), "record": record_document(solution)}
    return timeline_of(problem.scene, robot), planning_summary(document), document
