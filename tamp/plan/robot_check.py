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
    hashes = {source.path.name: source.sha256 for source in plan.sources if source.role == "robot"}
    for file in robot.files:
        if file.name in hashes and sha256(file) != hashes[file.name]:
            raise InputError(
                f"the robot's {file} is not the one that the plan was made with",
                file=plan.file,
                remedy="Plan again with tamp-solve",
            )
    count = len(robot.joints)
    for where, rows in _arm_rows(plan):
        if rows.shape[1] != count:
            raise InputError(
                f"{where}: {count} numbers are expected, one for each joint of the robot "
                f"{robot.name}, not {rows.shape[1]}",
                file=plan.file,
            )


def _arm_rows(plan: PlanFile) -> Iterator[tuple[str, Array]]:
    for name, value in plan.values.items():
        if value.type == "reach":
            yield from zip(
                (f"values.{name}.approach", f"values.{name}.lift"), value.data, strict=True
            )
        elif value.type == "motion":
            for part, rows in value.data or ():
                if part == "arm":
                    yield f"values.{name}", rows
    for number, action in enumerate(plan.actions):
        for place, segment in enumerate(action.segments):
            if segment.part == "arm":
                yield f"actions[{number}].segments[{place}].positions", segment.positions
