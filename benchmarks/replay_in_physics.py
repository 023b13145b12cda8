"""Plans played with motors and friction: what is really lifted, carried and put down, and what is knocked over.

The base slides and turns on joints of its own, the arm follows its trajectory with position control at the Panda's
torques, and the fingers close with a force: nothing is attached to anything.

python -m benchmarks.replay_in_physics one_object four_objects shelves --seeds 3
"""

from __future__ import annotations

import math
import re
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import tyro

from benchmarks.common import record, table
from tamp import Solution, load_problem, solve
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box, Scene
from tamp.geometric.values import Grasp
from tamp.planner.timed_trajectories import Segment
from tamp.simulation.physics import BulletWorld

RATE = 240
"""Steps a second of the simulation."""

FAR, TURNED = 0.03, math.radians(15)
"""A body is well placed when it stands this near to the planned pose, metres and radians."""

DISTURBED = 0.01
"""The others may move this far, metres."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        problems: Shipped problems' names or paths.
        seeds: Seeds first, first + 1, ... of each.
        first: The first seed.
        force: With which each finger closes, newtons.
        speed: Factor on the plan's speed.
        pause: Seconds of standing still after each segment.
        time: Budget of planning, seconds.
        verbose: Say everything that happens to a body in the hand.
        out: The name of the file under benchmarks/results.
    """

    problems: tyro.conf.Positional[tuple[str, ...]] = ("one_object", "four_objects", "shelves")
    seeds: int = 1
    first: int = 0
    force: float = 50.0
    speed: float = 1.0
    pause: float = 0.2
    time: float = 30.0
    verbose: Annotated[bool, tyro.conf.arg(aliases=["-v"])] = False
    out: str = "replay_in_physics.jsonl"


class Player(BulletWorld):
    """A scene under gravity with a robot on motors."""

    def __init__(self, scene: Scene, robot: Robot, force: float) -> None:
        super().__init__(scene, None, dynamic=True)
        self._force = force
        bullet, client = self._bullet, self.client
        with tempfile.TemporaryDirectory() as folder:
            urdf = Path(folder) / "mobile.urdf"
            urdf.write_text(_mobile(robot))
            flags = bullet.URDF_USE_SELF_COLLISION_EXCLUDE_PARENT | bullet.URDF_IGNORE_VISUAL_SHAPES
            self._mover = bullet.loadURDF(str(urdf), useFixedBase=True, flags=flags, physicsClientId=client)
        index = {
            bullet.getJointInfo(self._mover, i, physicsClientId=client)[1].decode(): i
            for i in range(bullet.getNumJoints(self._mover, physicsClientId=client))
        }
        self._driven = [index[name] for name in ("base_x", "base_y", "base_yaw")]
        self._driven += [index[f"panda_joint{i}"] for i in range(1, 8)]
        self._fingers = [index["panda_finger_joint1"], index["panda_finger_joint2"]]
        # One motor drives both fingers; without the gear they would wander off to one side, the body between them.
        gear = bullet.createConstraint(
            self._mover, self._fingers[0], self._mover, self._fingers[1], bullet.JOINT_GEAR, [1, 0, 0], [0, 0, 0],
            [0, 0, 0], physicsClientId=client,
        )  # fmt: skip
        bullet.changeConstraint(gear, gearRatio=-1, erp=0.5, maxForce=10 * force, physicsClientId=client)
        self._forces = [2e4, 2e4, 2e4, 87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0]
        for link in range(-1, bullet.getNumJoints(self._mover, physicsClientId=client)):
            bullet.changeDynamics(self._mover, link, linearDamping=0, angularDamping=0, physicsClientId=client)
            for other in range(-1, 8):  # neighbours over a fixed link and the base's own box
                if abs(link - other) <= 2 or {link, other} & {-1, 0, 1, 2}:
                    bullet.setCollisionFilterPair(
                        self._mover, self._mover, link, other, 0, physicsClientId=client
                    )  # fmt: skip
        start = scene.robot
        self.conf = np.array([*start.base, *(start.arm or robot.home)], dtype=float)
        self.opening = robot.opening
        for joint, value in zip(self._driven, self.conf, strict=True):
            bullet.resetJointState(self._mover, joint, float(value), physicsClientId=client)
        for joint in self._fingers:
            bullet.resetJointState(self._mover, joint, self.opening / 2, physicsClientId=client)
        self.held = False

    def step_motors(self, rates: Array | None = None) -> None:
        """One step towards `conf` and `opening`; `rates` (10,) are the trajectory's speeds there."""
        bullet, client = self._bullet, self.client
        bullet.setJointMotorControlArray(
            self._mover, self._driven, bullet.POSITION_CONTROL, targetPositions=self.conf.tolist(),
            targetVelocities=(np.zeros(10) if rates is None else rates).tolist(), forces=self._forces,
            positionGains=[0.3] * 10, velocityGains=[1.0] * 10, physicsClientId=client,
        )  # fmt: skip
        for joint in self._fingers:
            bullet.setJointMotorControl2(
                self._mover, joint, bullet.POSITION_CONTROL, targetPosition=0.0 if self.held else self.opening / 2,
                force=self._force, maxVelocity=0.1, physicsClientId=client,
            )  # fmt: skip
        bullet.stepSimulation(physicsClientId=client)

    def wait(self, seconds: float) -> None:
        for _ in range(round(seconds * RATE)):
            self.step_motors()

    def actual(self) -> Array:
        """The configuration (10,) as it is."""
        states = self._bullet.getJointStates(self._mover, self._driven, physicsClientId=self.client)
        return np.array([state[0] for state in states])

    def width(self) -> float:
        """How far the fingers are apart, metres."""
        states = self._bullet.getJointStates(self._mover, self._fingers, physicsClientId=self.client)
        return float(sum(state[0] for state in states))

    def touched(self) -> set[str]:
        """What the robot touches, with anything but its fingers' pads."""
        points = self._bullet.getContactPoints(bodyA=self._mover, physicsClientId=self.client)
        return {self._owners.get((p[2], p[4]), "itself") for p in points if p[3] not in self._fingers or p[9] > 5.0}


def play(solution: Solution, options: Options) -> Iterator[dict[str, Any]]:
    """Run a plan; one result for each thing put down, and one for each that was moved by accident."""
    context = solution.problem.context
    scene, robot = context.scene, context.robot
    with Player(scene, robot, options.force) as player:
        player.wait(1.0)
        expected = {name: player.pose(name) for name in scene.movable}
        for name, pose in expected.items():
            sunk = _apart(pose, scene.bodies[name].pose.matrix)
            if sunk[0] > DISTURBED or sunk[1] > TURNED:
                yield {"what": "starts unstable", "body": name, "mm": 1000 * sunk[0], "deg": math.degrees(sunk[1])}
        grasp: Grasp | None = None
        conf = player.conf.copy()
        touched: dict[str, set[str]] = {}
        for number, action in enumerate(solution.plan, start=1):
            placed: str | None = None
            for segment in action.trajectory.segments:
                touched.setdefault(f"{number} {action.name}", set()).update(_run(player, segment, options))
                if segment.part == "gripper":
                    if segment.attach is not None:
                        grasp = segment.attach
                        yield from _held(player, context.kinematics.tool(conf), grasp, number, options)
                    elif grasp is not None:
                        placed, T = grasp.body, grasp.T_tool_body
                        expected[placed] = context.kinematics.tool(conf) @ T.matrix
                        grasp = None
                else:
                    conf[slice(0, 3) if segment.part == "base" else slice(3, 10)] = segment.positions[-1]
                    error = np.abs(player.actual() - conf)
                    if options.verbose and error.max() > 0.01:
                        yield {"what": "tracking", "body": str(np.argmax(error)), "mm": 1000 * error.max(), "deg": 0.0}
            if grasp is not None:
                T_tool = context.kinematics.tool(conf)
                off = _apart(player.pose(grasp.body), T_tool @ grasp.T_tool_body.matrix)
                what = "lost" if off[0] > 0.05 else "slipped" if off[0] > FAR or off[1] > TURNED else "carried"
                if what != "carried" or options.verbose:
                    yield _line(what, number, action.name, grasp.body, off, grasp)
            player.wait(0.5)
            for name in scene.movable:
                if grasp is not None and name == grasp.body:
                    continue
                off = _apart(player.pose(name), expected[name])
                if name == placed:
                    good = off[0] <= FAR and off[1] <= TURNED
                    yield _line("placed" if good else "misplaced", number, action.name, name, off, None)
                elif off[0] > DISTURBED or off[1] > TURNED:
                    yield _line("disturbed", number, action.name, name, off, None)
                expected[name] = player.pose(name)
        if options.verbose:
            for where, what in touched.items():
                if what:
                    print(f"    {where}: touches {sorted(what)}")


def _run(player: Player, segment: Segment, options: Options) -> set[str]:
    touched: set[str] = set()
    if segment.part == "gripper":
        player.held = segment.attach is not None
        player.opening = float(segment.positions[-1, 0])
        player.wait(max(float(segment.times[-1]), 0.7))
        return touched
    joints = slice(0, 3) if segment.part == "base" else slice(3, 10)
    times = segment.times / options.speed
    count = max(1, math.ceil(float(times[-1]) * RATE))
    before = player.conf.copy()
    for t in np.linspace(1.0 / count, 1.0, count) * times[-1]:
        for column, joint in enumerate(range(*joints.indices(10))):
            player.conf[joint] = np.interp(t, times, segment.positions[:, column])
        player.step_motors((player.conf - before) * RATE)
        before[:] = player.conf
        touched |= player.touched()
    player.wait(options.pause)
    return touched


def _held(player: Player, T_tool: Array, grasp: Grasp, number: int, options: Options) -> Iterator[dict[str, Any]]:
    if not options.verbose and abs(player.width() - grasp.opening) < 0.01:
        return
    off = _apart(player.pose(grasp.body), T_tool @ grasp.T_tool_body.matrix)
    line = _line("closed", number, "pick", grasp.body, off, grasp)
    line["what"] += f" on {1000 * player.width():.1f} of {1000 * grasp.opening:.1f} mm"
    yield line


def _line(
    what: str, number: int, action: str, body: str, off: tuple[float, float], grasp: Grasp | None
) -> dict[str, Any]:
    line = {
        "what": what, "action": f"{number} {action}", "body": body, "mm": 1000 * off[0], "deg": math.degrees(off[1])
    }  # fmt: skip
    if grasp is not None:
        line["grasp"] = [round(x, 3) for x in (*grasp.T_tool_body.position, *grasp.T_tool_body.rotation.T.ravel())]
    return line


def _apart(first: Array, second: Array) -> tuple[float, float]:
    cosine = (np.trace(first[:3, :3].T @ second[:3, :3]) - 1) / 2
    return float(np.linalg.norm(first[:3, 3] - second[:3, 3])), math.acos(float(np.clip(cosine, -1.0, 1.0)))


def _mobile(robot: Robot) -> str:
    """The arm's URDF on a base that slides along x and y and turns."""
    text = re.sub(r"package://", f"{robot.urdf.parent}/", robot.urdf.read_text())
    foot = robot.T_base_arm
    chassis = robot.link(robot.base).parts[0]
    if not isinstance(chassis.shape, Box):
        raise TypeError(f"the base is a {type(chassis.shape).__name__}, not a box")
    box, at = chassis.shape.size, chassis.pose.position
    inertial = '<inertial><mass value="{}"/><inertia ixx="5" ixy="0" ixz="0" iyy="5" iyz="0" izz="5"/></inertial>'
    limit = '<limit lower="-100" upper="100" effort="100000" velocity="10"/>'
    links = f"""
  <link name="ground"/>
  <link name="slide_x">{inertial.format(20)}</link>
  <link name="slide_y">{inertial.format(20)}</link>
  <link name="base">{inertial.format(100)}
    <collision><origin xyz="{at[0]} {at[1]} {at[2]}"/><geometry><box size="{box[0]} {box[1]} {box[2]}"/></geometry>
    </collision></link>
  <joint name="base_x" type="prismatic"><parent link="ground"/><child link="slide_x"/><axis xyz="1 0 0"/>{limit}</joint>
  <joint name="base_y" type="prismatic"><parent link="slide_x"/><child link="slide_y"/><axis xyz="0 1 0"/>{limit}
  </joint>
  <joint name="base_yaw" type="revolute"><parent link="slide_y"/><child link="base"/><axis xyz="0 0 1"/>{limit}</joint>
  <joint name="mount" type="fixed"><parent link="base"/><child link="panda_link0"/>
    <origin xyz="{foot.position[0]} {foot.position[1]} {foot.position[2]}"/></joint>
"""
    return re.sub(r"(<robot[^>]*>)", lambda match: match[1] + links, text, count=1)


def main(options: Options) -> None:
    rows: list[dict[str, Any]] = []
    for name in options.problems:
        for seed in range(options.first, options.first + options.seeds):
            solution = solve(load_problem(name), max_time=options.time, seed=seed)
            counts: dict[str, int] = {}
            for event in play(solution, options) if solution.solved else ():
                counts[event["what"]] = counts.get(event["what"], 0) + 1
                if options.verbose or event["what"] != "placed":
                    print(f"    {_told(event)}", flush=True)
            kinds = ("placed", "misplaced", "lost", "slipped", "disturbed")
            figures = {kind: counts.get(kind, 0) for kind in kinds}
            rows.append({"problem": Path(name).stem, "seed": seed, "outcome": solution.outcome.name, **figures})
            print(f"{Path(name).stem} seed {seed}: {counts}", flush=True)
            config = {"problem": name, "force_n": options.force, "speed": options.speed}
            record(options.out, seed=seed, config=config, outcome=solution.outcome.name, **figures)
    table(rows, f"replayed in physics, fingers {options.force:g} N")


def _told(event: Mapping[str, Any]) -> str:
    words = " ".join(f"{value:.3g}" if isinstance(value, float) else str(value) for value in event.values())
    return words


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
