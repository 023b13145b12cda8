"""The compiled collision checker against plain FCL on random scenes: is it right, how fast is it.

    python -m benchmarks.collision [ROBOT ...] [--states 100000] [--edges 10000] [--scenes 100] [--seed 0]

False free states: `free`, although FCL finds a pair nearer than 2 mm. False free edges: `edge_free`, although FCL
finds an intersection in one of the states sampled along them, no more than 1 cm apart. False hits: the other way round;
an edge counts as one only when no sampled state comes closer than the clearance + 5 mm. Tolerance 1e-6 m. Appends to
benchmarks/results/collision.jsonl. The full run takes about half an hour a robot, nearly all of it plain FCL.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections import Counter
from collections.abc import Sequence

import numpy as np

from benchmarks.collision_reference import PlainFcl, random_confs, random_pose, random_scene
from benchmarks.common import record, table
from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M, Arrangement
from tamp.geometric.collision.collisions import Attachment, Collisions
from tamp.geometric.loading.robots import load_robot
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array

RESULTS = "collision.jsonl"
TOLERANCE = 1e-6
Edge = tuple[Array, Array]


def random_edges(rng: np.random.Generator, free: Array, count: int) -> list[Edge]:
    """Edges (start, end) from free states: of the arm, of the base, of both, of all lengths up to the whole way."""
    edges = []
    for number in range(count):
        start = free[rng.integers(len(free))]
        goal = free[rng.integers(len(free))].copy()
        if number % 3 == 0:
            goal[:3] = start[:3]
        elif number % 3 == 1:
            goal[3:] = start[3:]
        edges.append((start, start + (goal - start) * rng.uniform(0.0, 1.0) ** 2))
    return edges


def levers(robot: Robot) -> Array:
    """No point of the robot moves further than this (3 + joints,) for a unit of each coordinate, metres.

    A joint that turns moves what hangs on it by at most its length along the chain, and half a metre of hand and body.
    """
    steps = [math.hypot(*joint.origin.position) for joint in robot.joints[1:]] + [0.5]
    lengths = np.cumsum(steps[::-1])[::-1]
    joints = np.where(robot.prismatic, 1.0, lengths)
    reach = math.hypot(*robot.T_base_arm.position[:2]) + math.hypot(*robot.joints[0].origin.position)
    return np.array([1.0, 1.0, reach + lengths[0], *joints])


def samples(start: Array, end: Array, weights: Array) -> Array:
    """States of an edge (n, 3 + joints) between which no point of the robot moves more than 1 cm."""
    motion = np.abs(end - start) @ weights
    return np.linspace(start, end, 2 + int(motion / 0.01))


def compare(
    arrangement: Arrangement, plain: PlainFcl, confs: Array, edges: int, rng: np.random.Generator
) -> Counter[str]:
    """Ask both about the configurations (n, 3 + joints) and about random edges between the free ones."""
    count: Counter[str] = Counter()
    weights = levers(plain.robot)
    started = time.process_time()
    free = np.array([arrangement.free(conf) for conf in confs])
    count["states_ns"] = int(1e9 * (time.process_time() - started))
    for conf, answer in zip(confs, free, strict=True):
        distance = plain.distance(conf)
        count["free states"] += bool(answer)
        count["false free states"] += bool(answer) and distance < TRANSIT_CLEARANCE_M - TOLERANCE
        count["false hit states"] += not answer and distance > TRANSIT_CLEARANCE_M + TOLERANCE
    if free.sum() < 2:
        return count
    asked = random_edges(rng, confs[free], edges)
    started = time.process_time()
    answers = [arrangement.edge_free(*edge) for edge in asked]
    count["edges_ns"] = int(1e9 * (time.process_time() - started))
    count["edges"] = len(asked)
    for edge, answer in zip(asked, answers, strict=True):
        count["free edges"] += answer
        if answer:
            count["false free edges"] += any(plain.collides(conf) is not None for conf in samples(*edge, weights))
        else:
            count["false hit edges"] += all(
                plain.distance(conf) > TRANSIT_CLEARANCE_M + 0.005 for conf in samples(*edge, weights)
            )
    return count


def main(arguments: Sequence[str] | None = None) -> int:
    """Run it, print the table, append one line a scene; 1 when anything was falsely free."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", default=["panda_mobile"])
    parser.add_argument("--states", type=int, default=100_000)
    parser.add_argument("--edges", type=int, default=10_000)
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)

    rows = []
    for name in options.robots:
        total = of_robot(name, options.states, options.edges, options.scenes, options.seed)
        rows += [
            {
                "robot": name,
                "asked": kind,
                "number": total[kind],
                "free": total[f"free {kind}"],
                "us each": total[f"{kind}_ns"] / 1e3 / max(1, total[kind]),
                "decided by the kernel": total[f"{kind} decided"] / max(1, total[kind]),
                "false free": total[f"false free {kind}"],
                "false hits": total[f"false hit {kind}"],
            }
            for kind in ("states", "edges")
        ]
    table(rows, f"compiled collision checks against plain FCL, {options.scenes} random scenes")
    return int(any(row["false free"] for row in rows))


def of_robot(name: str, states: int, edges: int, scenes: int, seed: int) -> Counter[str]:
    """Compare on all scenes with one robot; every second time with a body in its hand."""
    robot = load_robot(name)
    kinematics = Kinematics(robot)
    total: Counter[str] = Counter()
    for number in range(scenes):
        rng = np.random.default_rng((seed, number))
        movable = 3 + number % 10
        scene = random_scene(rng, movable, name)
        poses = {body: scene.bodies[body].pose for body in scene.movable}

        tool = random_pose(rng, np.full(3, -0.02), np.full(3, 0.02))
        attachment = Attachment("held", tool, min(0.04, robot.opening)) if number % 2 else None
        arrangement = Collisions(scene, robot, kinematics).arrangement(poses, attachment)
        plain = PlainFcl(scene, robot, kinematics, poses, attachment)
        confs = random_confs(rng, robot, states // scenes)

        wanted = math.ceil((edges - total["edges"]) / (scenes - number))  # crowded scenes may have none
        count = compare(arrangement, plain, confs, wanted, rng)
        stats = arrangement.stats
        count.update(
            {
                "states": len(confs),
                "states decided": stats.states_decided - (stats.states - len(confs)),
                "edges decided": stats.edges_decided,
                "exact pairs": stats.exact,
            }
        )
        config = {"robot": name, "scene": number, "movable": movable, "held": bool(attachment)}
        record(RESULTS, seed=seed, config=config, **count)
        total += count
    return total


if __name__ == "__main__":
    sys.exit(main())
