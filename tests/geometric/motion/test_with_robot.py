"""The planners with the real robot and the real collision layer."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.collision.collisions import Attachment, Collisions
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.motion.arm import plan_arm
from tamp.geometric.motion.base import plan_base
from tamp.geometric.motion.timing import time_path
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.system.deadline import Deadline

PROBLEM = """
name: motions
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  pillar: {box: [0.1, 0.1, 1.6], at: [0.75, 0.0, 0.8], fixed: true}
  table:  {furniture: table, size: [1.2, 0.7, 0.72], at: [-1.2, 0.0, 0.0], yaw: 90 deg}
  can:    {cylinder: {radius: 0.03, height: 0.12}, on: table, at: [0.0, 0.0]}
goal: (and (on can table))
"""


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


@pytest.fixture(scope="module")
def collisions(robot: Robot, tmp_path_factory: pytest.TempPathFactory) -> Collisions:
    file = tmp_path_factory.mktemp("motions") / "motions.yaml"
    file.write_text(PROBLEM, encoding="utf-8")
    return Collisions(load_scene(file).scene, robot, Kinematics(robot))


def _past_the_pillar(collisions: Collisions, robot: Robot, seed: int) -> Array:
    held = Attachment("can", Pose(), 0.06)
    arrangement = collisions.arrangement({}, held)
    start, goal = (np.array([turn, 0.3, 0.0, -1.8, 0.0, 2.1, 0.8]) for turn in (-0.9, 0.9))
    planned = plan_arm(
        arrangement, np.zeros(3), start, goal, robot, np.random.default_rng(seed), Deadline(30)
    )
    assert planned.path is not None, planned.failure
    return planned.path


@pytest.mark.parametrize("seed", range(3))
def test_the_arm_carries_a_can_past_a_pillar(
    collisions: Collisions, robot: Robot, seed: int
) -> None:
    path = _past_the_pillar(collisions, robot, seed)
    assert len(path) > 2  # the pillar is in the straight way
    arrangement = collisions.arrangement({}, Attachment("can", Pose(), 0.06))
    base = np.zeros(3)
    timed = time_path(
        path, np.array(robot.velocity[3:]), np.array(robot.acceleration[3:]),
        lambda a, b: arrangement.edge_free(np.append(base, a), np.append(base, b)),
    )  # fmt: skip
    confs = np.hstack([np.zeros((len(timed.positions), 3)), timed.positions])
    assert arrangement.path_hits(confs) is None
    assert np.all(timed.positions >= robot.lower) and np.all(timed.positions <= robot.upper)


@pytest.mark.parametrize("steering", ["se2", "reeds-shepp"])
def test_the_base_drives_round_furniture(
    collisions: Collisions, robot: Robot, steering: str
) -> None:
    can = collisions.scene.bodies["can"].pose
    arrangement = collisions.arrangement({"can": can})
    arm = np.array(robot.home)
    start, goal = np.array([1.8, 0.3, 0.0]), np.array([-2.0, 0.2, 3.0])
    planned = plan_base(
        arrangement, arm, start, goal, collisions.scene.room, np.random.default_rng(0), Deadline(30), steering=steering
    )  # fmt: skip
    assert planned.path is not None, planned.failure
    timed = time_path(
        planned.path, np.array(robot.velocity[:3]), np.array(robot.acceleration[:3]),
        lambda a, b: arrangement.edge_free(np.append(a, arm), np.append(b, arm)),
    )  # fmt: skip
    confs = np.hstack([timed.positions, np.tile(arm, (len(timed.positions), 1))])
    assert arrangement.path_hits(confs, step=0.005) is None


def test_two_processes_find_the_same_path(root: Path, tmp_path: Path) -> None:
    program = f"""
import hashlib
from pathlib import Path
from tamp.geometric.collision.collisions import Collisions
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tests.geometric.motion.test_with_robot import PROBLEM, _past_the_pillar
file = Path({str(tmp_path)!r}) / "motions.yaml"
file.write_text(PROBLEM)
robot = ROBOTS["panda_mobile"]()
collisions = Collisions(load_scene(file).scene, robot, Kinematics(robot))
print([hashlib.sha256(_past_the_pillar(collisions, robot, seed).tobytes()).hexdigest() for seed in (0, 1, 0)])
"""
    ends = [
        subprocess.run(
            [sys.executable, "-c", program], cwd=root, capture_output=True, text=True, check=True
        )
        for _ in range(2)
    ]
    assert ends[0].stdout == ends[1].stdout
    hashes = ends[0].stdout.split(",")
    assert len(hashes) == 3 and hashes[0].strip(" []\n") == hashes[2].strip(" []\n")
