"""How often and how fast IK finds reachable poses, and how often the reachability table's base poses are right.

    python -m benchmarks.inverse_kinematics [ROBOT ...] [--poses 3000] [--seed 0]

Robots are shipped ones by name or folders; by default all that come with tamp.

Reachable poses are FK of uniformly random joint angles within the limits. Typical grasps are top grasps at table height
and side grasps into compartments. Appends to benchmarks/results/inverse_kinematics.jsonl.
"""

from __future__ import annotations

import argparse
import math
import time
from typing import Any

import numpy as np

from benchmarks.common import percentile, record, table
from tamp.geometric.loading.robots import ROBOTS, find_robot, load_robot
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics, base_matrix
from tamp.geometric.robot.reachability import Reachability
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose

RESULTS = "inverse_kinematics.jsonl"
SETTINGS: dict[str, int | None] = {"all solutions": None, "first solution": 1, "eight solutions": 8}


def measure_solve(robot: Robot, poses: int, seed: int) -> list[dict[str, Any]]:
    """Success and time of queries on reachable poses."""
    kinematics, ik = Kinematics(robot), ArmIK(robot)
    rng = np.random.default_rng(seed)
    targets = [kinematics.arm_tool(q) for q in rng.uniform(robot.lower, robot.upper, (poses, len(robot.joints)))]
    ik.solve(targets[0])
    rows: list[dict[str, Any]] = []
    for name, enough in SETTINGS.items():
        times, counts, worst = [], [], 0.0
        for target in targets:
            start = time.perf_counter()
            solutions = ik.solve(target, enough)
            times.append(time.perf_counter() - start)
            counts.append(len(solutions))
            worst = max([worst, *(float(np.abs(kinematics.arm_tool(q) - target).max()) for q in solutions[:1])])
        rows.append({
            "figure": "solve", "case": name, "queries": poses, "found": float(np.mean(np.array(counts) > 0)),
            "median_ms": 1000 * percentile(times, 50), "p95_ms": 1000 * percentile(times, 95),
            "solutions": float(np.mean(counts)), "worst_error": worst,
        })  # fmt: skip
    return rows


def measure_unreachable(robot: Robot, seed: int, poses: int = 300) -> list[dict[str, Any]]:
    """Time of queries on poses beyond the farthest of 20,000 that the arm reaches, by 1 to 20 cm."""
    kinematics, ik, rng = Kinematics(robot), ArmIK(robot), np.random.default_rng(seed)
    reached = [kinematics.arm_tool(q) for q in rng.uniform(robot.lower, robot.upper, (20_000, len(robot.joints)))]
    foot = np.array(robot.T_base_arm.position)
    length = max(float(np.linalg.norm(T[:3, 3] - foot)) for T in reached)
    times, found = [], 0
    for T in reached[:poses]:
        way = T[:3, 3] - foot
        T = T.copy()
        T[:3, 3] = foot + way / np.linalg.norm(way) * (length + rng.uniform(0.01, 0.2))
        start = time.perf_counter()
        found += len(ik.solve(T, 1)) > 0
        times.append(time.perf_counter() - start)
    return [{
        "figure": "unreachable", "case": "1 to 20 cm too far", "queries": poses, "found": found / poses,
        "median_ms": 1000 * percentile(times, 50), "p95_ms": 1000 * percentile(times, 95),
    }]  # fmt: skip


def typical_grasps(seed: int, count: int) -> dict[str, list[Array]]:
    """Tool poses in the world: top grasps over a table, slanted ones, and side grasps into compartments."""
    rng = np.random.default_rng(seed)

    def pose(height: tuple[float, float], pitch: float) -> Array:
        """The tool's z tilted by `pitch` from straight down towards horizontal, closing sideways."""
        z, yaw = rng.uniform(*height), rng.uniform(-math.pi, math.pi)
        tilt = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.pi, 0.0, 0.0)).matrix
        turn = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, -pitch, 0.0)).matrix
        x, y = rng.uniform(-2, 2, 2)
        return Pose.from_xyz_yaw(x, y, z, yaw).matrix @ turn @ tilt

    return {
        "top, 0.75-0.95 m": [pose((0.75, 0.95), 0.0) for _ in range(count)],
        "slanted 45 deg, 0.75-0.95 m": [pose((0.75, 0.95), math.pi / 4) for _ in range(count)],
        "side, 0.40-0.75 m": [pose((0.40, 0.75), math.pi / 2) for _ in range(count)],
        "side, 0.75-1.15 m": [pose((0.75, 1.15), math.pi / 2) for _ in range(count)],
    }


def measure_reachability(robot: Robot, seed: int, count: int = 50, bases: int = 40) -> list[dict[str, Any]]:
    """Share of drawn base poses from which IK exists, and the time of a draw."""
    reachability, ik = Reachability(robot), ArmIK(robot)
    rows: list[dict[str, Any]] = []
    for name, grasps in typical_grasps(seed, count).items():
        rng = np.random.default_rng(seed)
        hits, seconds = [], []
        for T_world_tool in grasps:
            start = time.perf_counter()
            drawn = reachability.sample(T_world_tool, rng, bases)
            seconds.append(time.perf_counter() - start)
            hits += [len(ik.solve(np.linalg.inv(base_matrix(base)) @ T_world_tool, enough=1)) > 0 for base in drawn]
        rows.append({
            "figure": "reachability", "case": name, "queries": len(hits), "found": float(np.mean(hits)),
            "draw_median_us": 1e6 * percentile(seconds, 50),
        })  # fmt: skip
    return rows


def main() -> None:
    """Measure, append and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robots", nargs="*", metavar="ROBOT")
    parser.add_argument("--poses", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    for name in options.robots or ROBOTS:
        robot = load_robot(find_robot(name))
        groups = [measure_solve(robot, options.poses, options.seed), measure_unreachable(robot, options.seed)]
        if robot.drive != "fixed":
            groups.append(measure_reachability(robot, options.seed))
        for rows in groups:
            for row in rows:
                config = {"robot": robot.name, "figure": row.pop("figure"), "case": row["case"]}
                record(RESULTS, seed=options.seed, config=config, **{k: v for k, v in row.items() if k != "case"})
            table(rows, title=f"{robot.name}, inverse kinematics: {config['figure']}")


if __name__ == "__main__":
    main()
