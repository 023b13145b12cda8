"""Creep of held bodies by each engine: how far a body moves between the fingers in a minute, at 50 N and friction 0.5.

python -m benchmarks.engine_creep
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np
import tyro

from benchmarks.common import record, table
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.simulation.actuation import COMMANDS_PER_SECOND
from tamp.simulation.engines import ENGINES, installed, open_actuated
from tamp.system.files import find_problem

HELD = {
    "cracker_box": Pose((0.0, 0.0, 0.075), (-0.707106781187, -0.707106781187, 0.0, 0.0)),
    "soup_can": Pose((0.0, 0.0, 0.021), (-0.896354326273, 0.443338382922, 0.0, 0.0)),
    "mustard": Pose(
        (-0.075105977, 0.00090235, 0.016489504), (-0.057322556013, 0.704779486486, -0.057322556013, 0.704779486486)
    ),
    "mug": Pose((0.0, 0.0, 0.055), (-0.662620048216, -0.748955720789, 0.0, 0.0)),
}
"""Bodies of four_objects, and T_tool_body of its plan of seed 0."""


@dataclass(frozen=True)
class Options:
    """What to hold.

    Attributes:
        seconds: For how long.
        bodies: Names out of HELD.
        engines: Names of engines; those that are installed.
        out: The name of the file under benchmarks/results.
    """

    seconds: float = 60.0
    bodies: tuple[str, ...] = tuple(HELD)
    engines: tuple[str, ...] = tuple(name for name in ENGINES if installed(name))
    out: str = "engine_creep.jsonl"


def creep(engine: str, body: str, seconds: float) -> tuple[float, float]:
    """Hold a body; how far it moved against the hand after the first second: metres, and radians."""
    scene, robot = load_scene(find_problem("four_objects")).scene, ROBOTS["panda_mobile"]()
    bodies = MappingProxyType({body: scene.bodies[body]})
    alone = Scene("held", bodies, scene.robot, scene.room)
    with open_actuated(alone, robot, name=engine) as world:
        T_tool_body = HELD[body].matrix
        world.wake(body)
        world.squeezing = True
        for _ in range(COMMANDS_PER_SECOND):  # until the fingers have closed
            world.set_pose(body, world.tool() @ T_tool_body)
            world.step_motors()
        world.wait(1.0)
        before = np.linalg.inv(world.tool()) @ world.pose(body)
        world.wait(seconds)
        after = np.linalg.inv(world.tool()) @ world.pose(body)
    cosine = (np.trace(before[:3, :3].T @ after[:3, :3]) - 1) / 2
    return float(np.linalg.norm(after[:3, 3] - before[:3, 3])), float(np.arccos(np.clip(cosine, -1.0, 1.0)))


def main(options: Options) -> None:
    """Measure, print, write."""
    rows: list[dict[str, Any]] = []
    for engine in options.engines:
        row: dict[str, Any] = {"engine": engine}
        for body in options.bodies:
            began = time.process_time()
            moved, turned = creep(engine, body, options.seconds)
            row[f"{body}_mm"] = 1000 * moved
            record(
                options.out, config={"engine": engine, "body": body, "seconds": options.seconds},
                moved_m=moved, turned_rad=turned, cpu_seconds=time.process_time() - began,
            )  # fmt: skip
        rows.append(row)
    table(rows, f"creep in the hand in {options.seconds:g} s")


if __name__ == "__main__":
    main(tyro.cli(Options))
