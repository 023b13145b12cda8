"""The use of what was demonstrated: the files that are learned and planned, and the commands."""

from __future__ import annotations

import math
import shlex
from dataclasses import dataclass
from pathlib import Path

from grounding.demonstrate.relation import DemonstratedRelation
from grounding.demonstrate.scene import Stage
from grounding.demonstrate.viewer import depth, stand_of, viewer_yaw
from grounding.relations.demonstration_file import Label
from grounding.relations.demonstration_text import ROBOT, ROOM, demonstration_text
from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.scene import Scene
from tamp.system.files import find_problem
from tamp.system.outputs import write_whole

ROBOT_DISTANCE_M = 0.8
"""Metres between the furniture and the middle of the robot's base at the start."""

ROOM_MARGIN_M = 3.0
"""Metres of room around the furniture."""


@dataclass(frozen=True)
class Uses:
    """The files that belong to a relation's folder, all in it.

    Attributes:
        relation: The relation's name.
        folder: Of its demonstrations.
    """

    relation: str
    folder: Path

    @property
    def weights(self) -> Path:
        """Return where the learned relation is."""
        return self.folder / f"{self.relation}.safetensors"

    @property
    def domain(self) -> Path:
        """Return the domain that has the relation."""
        return self.folder / f"{self.relation}.pddl"

    @property
    def problem(self) -> Path:
        """Return the problem that the page plans; not among the demonstrations, for it is none."""
        return self.folder / "plan" / "problem.yaml"

    @property
    def page(self) -> Path:
        """Return the page on which the plan is watched."""
        return self.folder / "plan" / "plan.html"

    @property
    def learning(self) -> list[str]:
        """Return the arguments of tamp-learn."""
        places = ["--demos", str(self.folder), "--out", str(self.weights)]
        return ["new", self.relation, *places, "--add-to", str(self.domain)]

    @property
    def planning(self) -> list[str]:
        """Return the arguments of tamp-solve."""
        plan = self.folder / "plan" / "plan.json"
        pages = ["--html", str(self.page), "--allow-outside"]  # shipped meshes; it stays here
        return [str(self.problem), "--out", str(plan), *pages, "--verify"]

    @property
    def commands(self) -> dict[str, str]:
        """Return both as a user types them."""
        return {
            "learn": shlex.join(["tamp-learn", *self.learning]),
            "plan": shlex.join(["tamp-solve", *self.planning]),
        }


def write_problem(
    uses: Uses, relation: DemonstratedRelation, stage: Stage, scene: Path | None
) -> None:
    """Write the problem to make the relation true in a scene.

    Args:
        uses: Where it goes.
        relation: What is to hold.
        stage: Where the bodies are.
        scene: The problem file that the scene is of, whose robot and room are taken; else the
            robot stands in front of the furniture.

    Raises:
        InputError: It cannot be written.
    """
    text = demonstration_text(stage.file(Label(relation.name, stage.arguments, True)))
    robot, room = _in_front(stage)
    if scene is not None:
        robot, room = _of(load_scene(find_problem(scene), demonstration=True).scene)
    head = (
        f"domain: ../{uses.domain.name}\n"
        f"samplers: {{{relation.name}: ../{uses.weights.name}}}\nrobot: {robot}"
    )
    text = text.replace(f"robot: {ROBOT}", head, 1).replace(f"room: {ROOM}", f"room: {room}", 1)

    try:
        write_whole(uses.problem, text.encode())
    except OSError as error:
        raise InputError(f"cannot be written: {error.strerror}", file=uses.problem) from None


def _in_front(stage: Stage) -> tuple[str, str]:
    """Place a robot in front of what the arguments stand on, looking at it, in a room around."""
    scene = stage.scene
    yaw = viewer_yaw(scene, stage.arguments)
    stand = stand_of(scene, stage.arguments) or next(iter(scene.bodies.values()))
    x, y = stand.pose.position[:2]
    back = depth(stand) / 2 + ROBOT_DISTANCE_M
    base = f"[{x - back * math.cos(yaw):.3f}, {y - back * math.sin(yaw):.3f}, {yaw:.4f}]"
    room = ", ".join(
        f"{axis}: [{middle - ROOM_MARGIN_M:.3f}, {middle + ROOM_MARGIN_M:.3f}]"
        for axis, middle in (("x", x), ("y", y))
    )
    return f"{{model: panda_mobile, base: {base}}}", f"{{{room}}}"


def _of(scene: Scene) -> tuple[str, str]:
    """Return the robot and the room of a scene, as a problem file has them."""
    start, room = scene.robot, scene.room
    arm = "" if start.arm is None else f", arm: {list(start.arm)}"
    robot = f"{{model: {start.model}, base: {list(start.base)}{arm}}}"
    return robot, f"{{x: {list(room.x)}, y: {list(room.y)}}}"
