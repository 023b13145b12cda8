"""The robot that the tests of collision checking place."""

from __future__ import annotations

import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Robot


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


@pytest.fixture(scope="module")
def kinematics(robot: Robot) -> Kinematics:
    return Kinematics(robot)
