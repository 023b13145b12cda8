"""How long motions take to plan: arm to shelf goals, base among furniture, timing of the results.

    python -m benchmarks.motion [--problems 50] [--seed 0]

Every path is rechecked by FCL on states whose farthest point moves at most 2 mm from one to the next.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro

from benchmarks.common import record, table, times
from tamp.geometric.collision.arrangement import Arrangement
from tamp.geometric.collision.collisions import Attachment, Collisions
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.motion.arm import plan_arm
from tamp.geometric.motion.base import plan_base
from tamp.geometric.motion.path import length
from tamp.geometric.motion.result import MotionResult
from tamp.geometric.motion.timing import Timed, prefetch, time_path
from tamp.geometric.robot.inverse_kinematics import ArmIK
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Cavity, Scene
from tamp.system.deadline import Deadline

SHELF = """
name: motion_benchmark
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  cupboard: {furniture: cupboard, size: [1.0, 0.42, 1.3], compartments: 3, at: [1.0, 0.0, 0.0], yaw: -90 deg}
  table:    {furniture: table, size: [1.2, 0.7, 0.72], at: [-0.6, 1.6, 0.0]}
  chest:    {furniture: cupboard, size: [0.9, 0.42, 0.75], compartments: 2, at: [-1.8, -0.6, 0.0], yaw: 90 deg}
  pillar:   {box: [0.3, 0.3, 2.0], at: [-0.4, -1.4, 1.0], fixed: true}
  held:     {box: [0.05, 0.05, 0.16], on: table, at: [0.0, 0.0]}
  can:      {cylinder: {radius: 0.033, height: 0.102}, on: cupboard_2, at: [0.2, 0.05]}
  box:      {box: [0.06, 0.16, 0.21], on: cupboard_2, at: [-0.25, 0.08]}
  bottle:   {cylinder: {radius: 0.035, height: 0.19}, on: cupboard_3, at: [0.0, 0.05]}
goal: (and (on held cupboard_top))
"""
GRASP = Pose((0.0, 0.0, 0.0), (0.0, 0.7071067811865476, 0.0, 0.7071067811865476))  # the held box stands across the hand


@dataclass(frozen=True)
class Arguments:
    """What to measure.

    Attributes:
        problems: Arm problems, and as many base problems.
        seed: Of goals and planners.
        effort: Of the planners.
        out: Where the JSON lines go, under benchmarks/results.
    """

    problems: int = 50
    seed: int = 0
    effort: int = 2
    out: str = "motion.jsonl"


@dataclass(frozen=True, eq=False)
class World:
    """The scene with all that plans in it."""

    scene: Scene
    robot: Robot
    collisions: Collisions
    kinematics: Kinematics
    ik: ArmIK

    def arrangement(self, holding: bool) -> Arrangement:
        """The robot, with the box in its hand or without, among everything else where it stands at the start."""
        poses = {name: self.scene.bodies[name].pose for name in self.scene.movable if name != "held"}
        return self.collisions.arrangement(poses, Attachment("held", GRASP, 0.05) if holding else None)


def now() -> Array:
    """Seconds on the clock, and seconds that this process has computed: on a busy machine the two differ."""
    return np.array([time.perf_counter(), time.process_time()])


def load() -> World:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "motion.yaml"
        file.write_text(SHELF, encoding="utf-8")
        scene = load_scene(file).scene
    robot = ROBOTS[scene.robot.model]()
    kinematics = Kinematics(robot)
    return World(scene, robot, Collisions(scene, robot, kinematics), kinematics, ArmIK(robot))


def shelf_goals(world: World, rng: np.random.Generator) -> Iterator[tuple[bool, Array, Array]]:
    """Whether something is held, a base in front of the cupboard, and a free arm reaching into a compartment."""
    cavities = [cavity for cavity in world.scene.cavities.values() if cavity.body == "cupboard"]
    for k in range(10**6):
        holding = bool(k % 2)
        base = np.array([rng.uniform(0.02, 0.12), rng.uniform(-0.15, 0.15), rng.uniform(-0.2, 0.2)])
        T_world_base = Pose.from_xyz_yaw(base[0], base[1], 0.0, base[2]).matrix
        T_world_tool = _into(world.scene, cavities[int(rng.integers(len(cavities)))], rng, holding)
        solutions = world.ik.solve(np.linalg.inv(T_world_base) @ T_world_tool)
        arrangement = world.arrangement(holding)
        free = [arm for arm in solutions if arrangement.free(np.concatenate([base, arm]))]
        start = np.concatenate([base, world.robot.home])
        if free and arrangement.free(start):
            yield holding, base, free[int(rng.integers(len(free)))]


def _into(scene: Scene, cavity: Cavity, rng: np.random.Generator, holding: bool) -> Array:
    """A tool pose in a compartment, fingers pointing into it, tilted a little."""
    width, depth, height = cavity.size
    T_cavity = scene.world_pose(cavity).matrix
    point = [
        rng.uniform(-0.35, 0.35) * width,
        rng.uniform(-0.45, 0.2) * depth,
        rng.uniform(0.1 if holding else 0.05, height - 0.12),
    ]
    tilt = rng.uniform(-0.2, 0.2)
    forward = np.array([np.sin(tilt), np.cos(tilt), 0.0])  # the front faces the cavity's -y
    side = np.array([np.cos(tilt), -np.sin(tilt), 0.0])  # the fingers close sideways
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2], T[:3, 3] = np.cross(side, forward), side, forward, point
    return T_cavity @ T


def bases(world: World, arrangement: Arrangement, rng: np.random.Generator) -> Iterator[Array]:
    """Free bases at random in the room."""
    room = world.scene.room
    while True:
        base = np.array([rng.uniform(*room.x), rng.uniform(*room.y), rng.uniform(-np.pi, np.pi)])
        if arrangement.free(np.concatenate([base, world.robot.home])):
            yield base


def main(arguments: Arguments) -> None:
    world = load()
    rng = np.random.default_rng(arguments.seed)
    prefetch().join()
    rows = [
        _arm(world, arguments, rng),
        *(_base(world, arguments, rng, steering) for steering in ("se2", "reeds-shepp")),
    ]
    table(rows, f"{arguments.problems} motions each, seed {arguments.seed}")


def _arm(world: World, arguments: Arguments, rng: np.random.Generator) -> dict[str, object]:
    robot = world.robot
    limits = np.array(robot.velocity[3:]), np.array(robot.acceleration[3:])
    goals = shelf_goals(world, rng)
    measured = Measured()
    home = np.array(robot.home)
    for k in range(-3, arguments.problems):  # the first three warm the machine up
        holding, base, goal = next(goals)
        arrangement = world.arrangement(holding)
        began = now()
        planned = plan_arm(
            arrangement, base, home, goal, robot, np.random.default_rng([arguments.seed, k + 3]), Deadline(30),
            effort=arguments.effort,
        )  # fmt: skip
        spent = now() - began
        if k < 0:
            continue
        timed = measured.note(arguments, "arm", k, planned, spent, arrangement, (base, None), limits)
        if timed is not None:
            measured.check(arrangement, np.hstack([np.tile(base, (len(timed.positions), 1)), timed.positions]))
    return measured.row("arm to shelf")


def _base(world: World, arguments: Arguments, rng: np.random.Generator, steering: str) -> dict[str, object]:
    robot = world.robot
    limits = np.array(robot.velocity[:3]), np.array(robot.acceleration[:3])
    home = np.array(robot.home)
    measured = Measured()
    for k in range(-1, arguments.problems):
        arrangement = world.arrangement(bool(k % 2))
        start, goal = (next(bases(world, arrangement, rng)) for _ in range(2))
        began = now()
        planned = plan_base(
            arrangement, home, start, goal, world.scene.room, np.random.default_rng([arguments.seed, k + 3]),
            Deadline(30), steering=steering, effort=arguments.effort,
        )  # fmt: skip
        spent = now() - began
        if k < 0:
            continue
        timed = measured.note(arguments, steering, k, planned, spent, arrangement, (None, home), limits)
        if timed is not None:
            measured.check(arrangement, np.hstack([timed.positions, np.tile(home, (len(timed.positions), 1))]))
    return measured.row(f"base {steering}")


class Measured:
    """Collects one kind of motion."""

    def __init__(self) -> None:
        self.planning: list[Array] = []
        self.timing: list[float] = []
        self.found = 0
        self.bad = 0
        self.checks: list[int] = []

    def note(
        self,
        arguments: Arguments,
        kind: str,
        k: int,
        planned: MotionResult,
        spent: Array,
        arrangement: Arrangement,
        rest: tuple[Array | None, Array | None],
        limits: tuple[Array, Array],
    ) -> Timed | None:
        """Record a plan, time it, and give back its trajectory."""
        base, arm = rest
        self.planning.append(spent)
        self.checks.append(planned.checks)

        def whole(row: Array) -> Array:
            return np.concatenate([row if base is None else base, row if arm is None else arm])

        timed = None
        began = now()
        if planned.path is not None:
            self.found += 1
            timed = time_path(planned.path, *limits, lambda a, b: arrangement.edge_free(whole(a), whole(b)))
            self.timing.append(float((now() - began)[0]))
        record(
            arguments.out, seed=arguments.seed, config={"kind": kind, "effort": arguments.effort}, problem=k,
            planning_s=spent[0], planning_cpu_s=spent[1], checks=planned.checks,
            failure=planned.failure and planned.failure.value,
            vertices=0 if planned.path is None else len(planned.path),
            length=0.0 if planned.path is None else length(planned.path),
            timing_s=self.timing[-1] if timed else None, duration_s=timed.duration if timed else None,
        )  # fmt: skip
        return timed

    def check(self, arrangement: Arrangement, confs: Array) -> None:
        """Recheck the timed trajectory exactly."""
        self.bad += arrangement.path_hits(confs, step=0.002) is not None

    def row(self, kind: str) -> dict[str, object]:
        """The summary."""
        wall, processor = np.array(self.planning).T.tolist()
        planning = {f"plan {name}": cell for name, cell in times(wall, "ms").items()}
        cpu = times(processor, "ms")
        return {
            "motion": kind,
            "found": f"{self.found}/{len(self.planning)}",
            "colliding": self.bad,
            **planning,
            "cpu median [ms]": cpu["median [ms]"],
            "cpu mean [ms]": cpu["mean [ms]"],
            "timing median [ms]": times(self.timing, "ms")["median [ms]"],
            "edges median": float(np.median(self.checks)),
        }


if __name__ == "__main__":
    main(tyro.cli(Arguments))
