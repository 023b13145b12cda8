"""Open a plan file with the scene that it was made for, to show it or to carry it out."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.loading.robots import find_robot, load_robot
from tamp.geometric.robot.robot import Robot
from tamp.plan.read import PlanFile, read_plan
from tamp.plan.robot_check import check_robot
from tamp.plan.sources import check_files, plan_hashes, sha256, source_file, unquoted
from tamp.plan.symbolic import is_symbolic
from tamp.system.reading import is_file, read_json


@dataclass(frozen=True, eq=False)
class PlanBundle:
    """A plan file and what belongs to it.

    Attributes:
        plan: The plan, read.
        document: The file's content, for what only a person reads: statistics, timing, the record
            of what was tried.
        loaded: The problem that it was made for.
        robot: Its robot.
    """

    plan: PlanFile
    document: dict[str, Any]
    loaded: LoadedProblem
    robot: Robot


def open_plan(file: str | Path, problem: str | Path | None = None) -> PlanBundle:
    """Read a plan file and the problem that it was made for.

    Args:
        file: The plan, as tamp-solve wrote it.
        problem: The problem's file, instead of the one that the plan names.

    Raises:
        InputError: The plan is malformed, of another version or without a scene, or its problem, a
            mesh or its domain is missing or not what it was when the plan was made.
    """
    path = Path(file)
    plan = _read(path)
    source = source_file(plan, "problem", None if problem is None else Path(problem))
    with unquoted(path, plan_hashes(plan, problem=None if problem is None else source)):
        loaded = load_scene(source, plan.robot if plan.robot_given else None)
    files = {"problem": source}
    domain = plan.source("domain")
    if domain is not None and is_file(domain.path):
        files["domain"] = domain.path
    for violation in check_files(plan, files, loaded.meshes):
        raise InputError(violation.message, file=path, remedy="Plan again with tamp-solve")
    if plan.robot != loaded.scene.robot.model:
        raise InputError(
            f"its robot is {plan.robot}, the problem's {loaded.scene.robot.model}", file=path
        )
    return PlanBundle(plan, read_json(path), loaded, robot_of(plan))


def read_motions(file: str | Path) -> PlanFile:
    """Read a plan file alone, for those that need no scene.

    A file that it was made from may be missing, but where it is still there, it must be what it
    was.

    Raises:
        InputError: The plan is malformed, of another version, without motions, or a source of it
            has changed.
    """
    path = Path(file)
    plan = _read(path)
    for source in plan.sources:
        if is_file(source.path) and sha256(source.path) != source.sha256:
            what = f"the {source.role} {source.path} is not the one that the plan was made from"
            raise InputError(what, file=path, remedy="Plan again with tamp-solve")
    return plan


def robot_of(plan: PlanFile) -> Robot:
    """Return the robot that a plan is for.

    Raises:
        InputError: Nobody knows it.
    """
    try:
        robot = load_robot(find_robot(plan.robot))
    except InputError as error:
        raise error.at(plan.file) from None
    check_robot(plan, robot)
    return robot


def _read(path: Path) -> PlanFile:
    if is_symbolic(path):
        raise InputError("a plan of a problem in PDDL alone has no scene and no motion", file=path)
    return read_plan(path)
