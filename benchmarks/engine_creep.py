"""Creep of held bodies by each engine: how far a body moves between the fingers in a minute, at the robot's 50 N.

    python -m benchmarks.engine_creep
    python -m benchmarks.engine_creep --plans eight_objects --seeds 3

Without `--plans` four grasps of a plan of four_objects are held; with it, every grasp of new plans.
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
from tamp.geometric.scene.scene import Body, Scene
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
        plans: Problems instead, whose plans' grasps are held.
        seeds: Seeds 0, 1, ... of each problem.
        engines: Names of engines; those that are installed.
        out: The name of the file under benchmarks/results.
    """

    seconds: float = 60.0
    bodies: tuple[str, ...] = tuple(HELD)
    plans: tuple[str, ...] = ()
    seeds: int = 1
    engines: tuple[str, ...] = tuple(name for name in ENGINES if installed(name))
    out: str = "engine_creep.jsonl"


@dataclass(frozen=True)
class Held:
    """A body in the hand at T_tool_body."""

    label: str
    body: Body
    T_tool_body: Pose


def held(name: str) -> Held:
    """Take a body of four_objects in its grasp out of HELD."""
    return Held(name, load_scene(find_problem("four_objects")).scene.bodies[name], HELD[name])


def planned(problem: str, seed: int) -> list[Held]:
    """Take every grasp of a new plan."""
    import tamp

    loaded = tamp.load_problem(problem)
    solution = tamp.solve(loaded, max_time=30.0, seed=seed)
    bodies = load_scene(find_problem(problem)).scene.bodies
    grasps = [segment.attach for action in solution.plan for segment in action.trajectory.segments if segment.attach]
    return [Held(f"{problem} {seed} {one.body}", bodies[one.body], one.T_tool_body) for one in grasps]


def creep(engine: str, one: Held, seconds: float) -> tuple[float, float]:
    """Hold a body; how far it moved against the hand after the first second: metres, and radians."""
    scene, robot = load_scene(find_problem("four_objects")).scene, ROBOTS["panda_mobile"]()
    body = one.body.name
    alone = Scene("held", MappingProxyType({body: one.body}), scene.robot, scene.room)
    with open_actuated(alone, robot, name=engine) as world:
        T_tool_body = one.T_tool_body.matrix
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
    hands = [held(name) for name in options.bodies]
    if options.plans:
        hands = [one for name in options.plans for seed in range(options.seeds) for one in planned(name, seed)]
    rows: list[dict[str, Any]] = []
    for one in hands:
        row: dict[str, Any] = {"held": one.label}
        for engine in options.engines:
            began = time.process_time()
            moved, turned = creep(engine, one, options.seconds)
            row[f"{engine}_mm"] = 1000 * moved
            record(
                options.out, config={"engine": engine, "body": one.label, "seconds": options.seconds},
                moved_m=moved, turned_rad=turned, cpu_seconds=time.process_time() - began,
            )  # fmt: skip
        rows.append(row)
    table(rows, f"creep in the hand in {options.seconds:g} s")


if __name__ == "__main__":
    main(tyro.cli(Options))
