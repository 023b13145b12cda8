"""What the arm can pick up from the floor: bodies dropped in physics, grasps and places for the base tried densely.

    python -m benchmarks.floor_reach [PROBLEM ...] [--drops N]

A run in which a body falls can be mended only if the body can be picked up from where it lies. For each way in which it
came to lie: how many pairs of a grasp and a place for the base there were, with how many the arm reaches the grasp, and
with how many it touches nothing then; the floor is open, nothing else is near.
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from itertools import islice

import numpy as np

from benchmarks import common
from tamp.geometric.context import Context
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.streams.grasps import sample_grasps
from tamp.geometric.values import Grasp
from tamp.planner.problem import load_problem
from tamp.simulation.engines import open_world

HEIGHT = 0.5
"""From where bodies are dropped, metres above the floor,"""

SECONDS = 3.0
"""and after what time they lie still."""

GRASPS, PLACES = 60, 150
"""Of one body, and of the base for one grasp."""


def measure(context: Context, name: str, pose: Pose, rng: np.random.Generator) -> dict[str, object]:
    """How often the arm reaches a body at a pose, and how often it is free of collisions then."""
    body = replace(context.scene.bodies[name], pose=pose)
    pairs = reached = free = 0
    grasps = (grasp for grasp in sample_grasps(body, context.robot, rng) if isinstance(grasp, Grasp))
    for grasp in islice(grasps, GRASPS):
        T_world_tool = pose.matrix @ grasp.T_tool_body.inverse().matrix
        for base in context.reachability.sample(T_world_tool, rng, PLACES):
            T_base_tool = Pose.from_xyz_yaw(base[0], base[1], 0.0, base[2]).inverse().matrix @ T_world_tool
            solutions = context.ik.solve(T_base_tool)
            pairs += 1
            reached += len(solutions) > 0
            free += any(context.fixed_only(None).free(context.conf(base, arm)) for arm in solutions)
    return {"top_m": float(bounds(body.parts, pose)[1][2]), "pairs": pairs, "reached": reached, "free": free}


def dropped(context: Context, name: str, rng: np.random.Generator) -> Pose:
    """Where the body lies after a fall onto the open floor, turned in any way."""
    x, y, z, w = rng.normal(size=4)
    turned: Array = np.array([x, y, z, w]) / np.linalg.norm([x, y, z, w])
    start = Pose((0.0, 0.0, HEIGHT), (float(turned[0]), float(turned[1]), float(turned[2]), float(turned[3])))
    body = context.scene.bodies[name]
    with open_world(replace(context.scene, bodies={name: body}), dynamic=True) as world:
        world.place(name, start.matrix)
        world.step(SECONDS)
        return Pose.from_matrix(world.pose(name))


def main() -> None:
    """Drop the movable bodies of the problems that the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("problems", nargs="*", default=["four_objects"])
    parser.add_argument("--drops", type=int, default=6, help="of each body")
    arguments = parser.parse_args()
    rows: list[dict[str, object]] = []
    for problem in arguments.problems:
        context = load_problem(problem).context
        for name in (name for name, body in context.scene.bodies.items() if body.movable):
            for seed in range(arguments.drops):
                rng = np.random.default_rng(seed)
                row = measure(context, name, dropped(context, name, rng), rng)
                common.record("floor_reach.jsonl", seed=seed, config={"problem": problem, "body": name}, **row)
                rows.append({"problem": problem, "body": name, "drop": seed, **row})
    common.table(rows, "Picked up from the floor")


if __name__ == "__main__":
    main()
