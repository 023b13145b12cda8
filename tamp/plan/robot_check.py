"""A plan against its robot: the robot's files, and the rows of the motions."""

from __future__ import annotations

from collections.abc import Iterator

from tamp.errors import InputError
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.plan.read import PlanFile
from tamp.plan.sources import sha256


def check_robot(plan: PlanFile, robot: Robot) -> None:
    """Refuse a plan whose robot is not what it was when the plan was made, or whose arm has another
    number of joints.

    Raises:
        InputError: Which file has changed; or which rows, and how many positions they have.
    """
    hashes: dict[str, set[str]] = {}
    for source in plan.sources:
        if source.role == "robot":
            hashes.setdefault(source.path.name, set()).add(source.sha256)
    for file in robot.files:
        if file.name in hashes and sha256(file) not in hashes[file.name]:
            raise InputError(
                f"the robot's {file} is not the one that the plan was made with",
                file=plan.file,
                remedy="Plan again with tamp-solve",
            )

    arms = {arm.arm: arm for arm in robot.arms}
    for where, rows, name in _arm_rows(plan):
        if name is not None and name not in arms:
            what = f"{where}: the robot {robot.name} has no arm '{name}'"
            raise InputError(what, file=plan.file, found=name, choices=tuple(arms))
        of = tuple(arms.values()) if name is None else (arms[name],)
        count = len(of[0].joints)
        if rows is not None and all(rows.shape[1] != len(arm.joints) for arm in of):
            raise InputError(
                f"{where}: {count} numbers are expected, one for each joint of the robot "
                f"{robot.name}, not {rows.shape[1]}",
                file=plan.file,
            )


def _arm_rows(plan: PlanFile) -> Iterator[tuple[str, Array | None, str | None]]:
    """Yield where the plan has an arm's rows (None of fingers), and the arm as far as it says."""
    for name, value in plan.values.items():
        if value.type == "reach":
            for rows, which in zip(value.data, ("approach", "lift"), strict=True):
                yield f"values.{name}.{which}", rows, None
        elif value.type == "motion":
            for part, rows, arm in value.data or ():
                yield f"values.{name}", rows if part == "arm" else None, arm
    for number, action in enumerate(plan.actions):
        for place, segment in enumerate(action.segments):
            rows = segment.positions if segment.part == "arm" else None
            yield f"actions[{number}].segments[{place}].positions", rows, segment.arm
