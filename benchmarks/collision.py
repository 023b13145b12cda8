"""The compiled collision checker against plain FCL on random scenes: is it right, how fast is it.

    python -m benchmarks.collision [--states 100000] [--edges 10000] [--scenes 100] [--seed 0]

False free states: `free`, although FCL finds a pair nearer than 2 mm. False free edges: `edge_free`, although FCL
finds an intersection in one of the states sampled along them, no more than 1 cm apart. False hits: the other way round;
an edge counts as one only when no sampled state comes closer than the clearance + 5 mm. Tolerance 1e-6 m. Appends to
benchmarks/results/collision.jsonl. The full run takes about half an hour, nearly all of it plain FCL.
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
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
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


def samples(start: Array, end: Array) -> Array:
    """States of an edge (n, 10) between which no point of the robot moves more than 1 cm."""
    motion = np.abs(end - start) @ np.array([1.0, 1.0, 2.0, 1.2, 1.2, 1.0, 1.0, 0.6, 0.6, 0.4])
    return np.linspace(start, end, 2 + int(motion / 0.01))


def compare(
    arrangement: Arrangement, plain: PlainFcl, confs: Array, edges: int, rng: np.random.Generator
) -> Counter[str]:
    """Ask both about the configurations (n, 10) and about random edges between the free ones."""
    count: Counter[str] = Counter()
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
            count["false free edges"] += any(plain.collides(conf) is not None for conf in samples(*edge))
        else:
            count["false hit edges"] += all(
                plain.distance(conf) > TRANSIT_CLEARANCE_M + 0.005 for conf in samples(*edge)
            )
    return count


def main(arguments: Sequence[str] | None = None) -> int:
    """Run it, print the table, append one line a scene; 1 when anything was falsely free."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--states", type=int, default=100_000)
    parser.add_argument("--edges", type=int, default=10_000)
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args(arguments)
    robot = ROBOTS["panda_mobile"]()
    kinematics = Kinematics(robot)
    total: Counter[str] = Counter()
    for number in range(options.scenes):
        rng = np.random.default_rng((options.seed, number))
        movable = 3 + number % 10
        scene = random_scene(rng, movable)
        poses = {name: scene.bodies[name].pose for name in scene.movable}
        tool = random_pose(rng, np.full(3, -0.02), np.full(3, 0.02))
        attachment = Attachment("held", tool, 0.04) if number % 2 else None
        arrangement = Collisions(scene, robot, kinematics).arrangement(poses, attachment)
        plain = PlainFcl(scene, robot, kinematics, poses, attachment)
        confs = random_confs(rng, robot, options.states // options.scenes)
        edges = math.ceil((options.edges - total["edges"]) / (options.scenes - number))  # crowded scenes may have none
        count = compare(arrangement, plain, confs, edges, rng)
        stats = arrangement.stats
        count.update(
            {
                "states": len(confs),
                "states decided": stats.states_decided - (stats.states - len(confs)),
                "edges decided": stats.edges_decided,
                "exact pairs": stats.exact,
            }
        )
        record(
            RESULTS, seed=options.seed, config={"scene": number, "movable": movable, "held": bool(attachment)}, **count
        )
        total += count
    rows = [
        {
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
    return int(total["false free states"] + total["false free edges"] > 0)


if __name__ == "__main__":
    sys.exit(main())
