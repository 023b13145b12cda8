"""A suction cup of 4 cm across on a robot of 75 N, bodies for it, and its first grasps."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot, Suction
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Part, Shape
from tamp.geometric.streams.suction import sample_suction_grasps
from tamp.geometric.values import Grasp

CUP = Suction(0.02, math.radians(5.0))


def body(*parts: Shape | Part, mass: float = 0.3) -> Body:
    placed = tuple(part if isinstance(part, Part) else Part(part) for part in parts)
    pose = Pose.from_xyz_yaw(0.3, 0.2, 0.8, 0.7)
    return Body("thing", placed, pose, movable=True, mass=mass)


def first(robot: Robot, thing: Body, count: int) -> list[Grasp]:
    drawn = sample_suction_grasps(thing, robot, np.random.default_rng(0))
    return list(itertools.islice((one for one in drawn if isinstance(one, Grasp)), count))


def with_cup() -> Robot:
    return replace(ROBOTS["ur5_suction"](), suction=CUP, force=75.0)
