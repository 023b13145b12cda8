"""The compiled closing hand beside FCL, pose by pose."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.ray_crossings import solid_of
from tamp.geometric.streams.hand_fit import CLEAR_APPROACH, OPENING_SLACK_M, GraspChecker

SCENE = """
name: hand
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-3.0, 3.0], y: [-3.0, 3.0]}
bodies:
  box: {box: [0.05, 0.07, 0.1], at: [0.5, 0.0, 0.052]}
  can: {cylinder: {radius: 0.03, height: 0.1}, at: [0.9, 0.0, 0.052]}
  ball: {sphere: 0.03, at: [1.3, 0.0, 0.032]}
goal: (and)
"""


@pytest.fixture(scope="module")
def bodies(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Body]:
    file = tmp_path_factory.mktemp("hand") / "hand.yaml"
    file.write_text(SCENE, encoding="utf-8")
    return dict(load_scene(file).scene.bodies)


def _hits(robot: Robot, body: Body, T_body_tool: Array, fingers: tuple[float, float]) -> bool:
    """Whether hand and fingers, each so far from the middle, meet the body, by FCL."""
    T_body_hand = T_body_tool @ robot.T_hand_tool.inverse().matrix
    links = [(robot.link(robot.hand), T_body_hand)]
    for link, joint, place in zip(robot.finger_links, robot.fingers, fingers, strict=True):
        T = joint.origin.matrix.copy()
        T[:3, 3] += T[:3, :3] @ np.array(joint.axis) * place
        links.append((link, T_body_hand @ T))
    still = FclBody(body.parts)
    return any(
        touch(FclBody(link.parts).place(k, T), still.place(j, np.eye(4)), 0.0)
        for link, T in links
        for k in range(len(link.parts))
        for j in range(len(body.parts))
    )


def _above(rng: np.random.Generator) -> Array:
    """A tool pose about the body's top, fingers down, a little off."""
    yaw = rng.integers(4) * np.pi / 2 + rng.normal(0.0, 0.1)
    side = np.array([np.cos(yaw), np.sin(yaw), 0.0])
    down = np.array([0.0, 0.0, -1.0])
    T = np.eye(4)
    T[:3, 0], T[:3, 1], T[:3, 2] = np.cross(side, down), side, down
    T[:3, 3] = [*rng.normal(0.0, 0.006, 2), rng.uniform(-0.02, 0.07)]
    return T


@pytest.mark.parametrize("name", ["box", "can", "ball"])
def test_a_closed_hand_touches_with_both_fingers_and_is_free_while_open(
    name: str, bodies: dict[str, Body], rng: np.random.Generator
) -> None:
    robot, body = ROBOTS["panda_mobile"](), bodies[name]
    fit = GraspChecker(body, solid_of(body), robot)
    wide = robot.opening / 2
    closed = refused = 0
    for _ in range(150):
        T = _above(rng)
        found = fit.close(T)
        if found is None:
            refused += _hits(robot, body, T, (wide, wide))
            continue
        closed += 1
        assert not _hits(robot, body, T, (wide, wide))
        for back in np.arange(0.0, CLEAR_APPROACH + 1e-9, 0.02):
            moved = found.T_body_tool.copy()
            moved[:3, 3] -= back * moved[:3, 2]
            assert not _hits(robot, body, moved, (wide, wide))
        half = found.opening / 2
        assert not _hits(robot, body, found.T_body_tool, (half, half))
        less = half - OPENING_SLACK_M / 2 - 3e-4  # contacts are found to 0.1 mm
        assert _hits(robot, body, found.T_body_tool, (less, wide))
        assert _hits(robot, body, found.T_body_tool, (wide, less))
    assert closed >= 5 and refused >= 5
