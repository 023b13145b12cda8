"""The judge's own idea of what a suction cup holds, in both engines."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.simulation.engines import open_world
from tamp.verification.holding import why_not_held
from tests.needs import INSTALLED

SCENE = """
name: cup
robot: {model: ur5_suction, base: [0.0, 0.0, 0.0]}
room: {x: [-3.0, 3.0], y: [-3.0, 3.0]}
bodies:
  box: {box: [0.2, 0.3, 0.1], at: [1.5, 0.0, 0.052], mass: 0.5}
  rod: {box: [0.03, 0.3, 0.03], at: [-1.5, 0.0, 0.017]}
  can: {cylinder: {radius: 0.033, height: 0.1}, at: [0.0, 1.5, 0.052]}
  iron: {box: [0.2, 0.2, 0.1], at: [0.0, -1.5, 0.052], mass: 40.0}
goal: (and)
"""

UNDER = Pose((0.0, 0.0, 0.0505))
"""A body 0.1 m high whose top is half a millimetre off the rim; its own z looks into the cup."""


def leaning(degrees: float) -> Pose:
    turn = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.radians(degrees), 0.0, 0.0))
    return Pose((0.0, 0.0, 0.0005)) @ turn @ Pose((0.0, 0.0, 0.05))


CASES = {
    "over the middle": ("box", UNDER, None),
    "near an edge": ("box", Pose((0.079, 0.0, 0.0505)), None),
    "over an edge": ("box", Pose((0.085, 0.0, 0.0505)), "does not close the cup"),
    "beside it": ("box", Pose((0.3, 0.0, 0.0505)), "does not close the cup: 33 of 33"),
    "too far off": ("box", Pose((0.0, 0.0, 0.0525)), "is 2.5 mm off it"),
    "in it": ("box", Pose((0.0, 0.0, 0.046)), "the cup is 4.0 mm in it"),
    "leans": ("box", leaning(8.0), "in it|leans by|does not close"),
    "too narrow": ("rod", Pose((0.0, 0.0, 0.0155)), "does not close the cup"),
    "an end": ("can", UNDER, None),
    "a round side": (
        "can",
        Pose((0.0, 0.0, 0.0335)) @ Pose.from_xyz_rpy((0.0, 0.0, 0.0), (math.pi / 2, 0.0, 0.0)),
        "does not close the cup",
    ),
    "too heavy": ("iron", UNDER, "it weighs 392 N, the cup holds"),
}


@pytest.mark.parametrize("engine", INSTALLED)
@pytest.mark.parametrize("case", CASES)
def test_a_cup_holds_what_closes_it(case: str, engine: str, tmp_path: Path) -> None:
    file = tmp_path / "cup.yaml"
    file.write_text(SCENE, encoding="utf-8")
    scene, robot = load_scene(file).scene, ROBOTS["ur5_suction"]()
    body, T_tool_body, why = CASES[case]
    with open_world(scene, robot, name=engine) as world:
        world.set_robot((0.0, -300.0, 0.0), robot.home, 0.0)
        T_world_tool = world.link_poses()[robot.hand] @ robot.T_hand_tool.matrix
        before = world.pose(body)
        said = why_not_held(world, robot, body, T_world_tool, T_tool_body.matrix, 0.0)
        assert np.array_equal(world.pose(body), before)
    if why is None:
        assert said is None
    else:
        assert said is not None and any(word in said for word in why.split("|"))
