"""The hand's fingers in pybullet: balls at the pads' corners, and motors that press once they have met something."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.simulation.fingers import (
    BALL_RADIUS_M,
    CLOSING_SPEED,
    FINGER_SETBACK_M,
    PAD_CORNER_M,
    PRESSING_SPEED,
    STALLED_FOR,
    STALLED_SPEED,
    Fingers,
    iterations,
    with_pads,
)
from tamp.simulation.mobile_urdf import mobile_urdf

RATE = 240


def origins(link: ElementTree.Element) -> list[np.ndarray]:
    return [
        np.array([float(word) for word in one.find("origin").get("xyz", "0 0 0").split()])  # type: ignore[union-attr]
        if one.find("origin") is not None
        else np.zeros(3)
        for one in link.findall("collision")
    ]


@pytest.mark.parametrize("name", ["panda_mobile", "two_ur5"])
def test_the_balls_touch_the_pads_plane_at_its_corners_and_hulls_stand_back(name: str) -> None:
    """Seen from the closed hand's tool: y is the closing direction, the pads meet at y = 0."""
    robot = ROBOTS[name]()
    plain = ElementTree.fromstring(mobile_urdf(robot))
    padded = ElementTree.fromstring(with_pads(mobile_urdf(robot), robot))
    fingers = 0
    for arm in robot.arms:
        for finger in arm.fingers:
            before, after = (
                origins(root.find(f"link[@name='{finger.child}']"))  # type: ignore[arg-type]
                for root in (plain, padded)
            )
            hulls, balls = after[: len(before)], np.array(after[len(before) :])
            opens = np.array(finger.axis)
            for old, new in zip(before, hulls, strict=True):
                assert new - old == pytest.approx(FINGER_SETBACK_M * opens, abs=1e-9)
            T_tool_finger = arm.T_hand_tool.inverse() @ finger.origin
            side = (T_tool_finger.rotation @ opens)[1]
            centres = T_tool_finger.apply(balls)
            corners = [(x, z) for x, _, z in centres.round(6).tolist()]
            assert sorted(corners) == sorted(
                itertools.product((-PAD_CORNER_M, PAD_CORNER_M), repeat=2)
            )
            assert centres[:, 1] == pytest.approx(np.full(4, side * BALL_RADIUS_M), abs=1e-6)
            fingers += 1
    assert fingers == 2 * len(robot.arms)
    others = {link.get("name"): len(link.findall("collision")) for link in plain.iter("link")}
    for link in padded.iter("link"):
        of_finger = link.get("name") in {f.child for arm in robot.arms for f in arm.fingers}
        assert len(link.findall("collision")) == others[link.get("name")] + 4 * of_finger


def test_more_iterations_while_it_presses() -> None:
    assert iterations(True) > iterations(False) > 0


class Engine:
    """In the place of pybullet: the fingers are `wide` apart; notes what motors are told."""

    JOINT_GEAR, POSITION_CONTROL, VELOCITY_CONTROL = "gear", "position", "velocity"

    def __init__(self) -> None:
        self.wide = 0.08
        self.told: list[dict[str, Any]] = []
        self.anchors: list[int] = []
        self.cleared: list[tuple[int, int]] = []

    def createConstraint(self, *_: Any, **__: Any) -> int:
        return 7

    def changeConstraint(self, *_: Any, **more: Any) -> None:
        assert more["gearRatio"] == -1

    def getJointStates(self, robot: int, joints: list[int], **_: Any) -> list[tuple[float]]:
        return [(self.wide / 2,) for _ in joints]

    def setJointMotorControl2(self, robot: int, joint: int, mode: str, **more: Any) -> None:
        self.told.append({"joint": joint, "mode": mode, **more})

    def changeDynamics(self, robot: int, joint: int, *, frictionAnchor: int, **_: Any) -> None:
        self.anchors.append(frictionAnchor)

    def getContactPoints(self, robot: int, linkIndexA: int, **_: Any) -> list[tuple[int, ...]]:
        return [(0, 1, 42, linkIndexA, 3), (0, 1, 42, linkIndexA, 3)]

    def setCollisionFilterPair(
        self, robot: int, body: int, joint: int, link: int, on: int, **_: Any
    ) -> None:
        assert on == 1
        self.cleared.append((body, link))


@pytest.fixture
def engine() -> Engine:
    return Engine()


def made(engine: Engine) -> Fingers:
    return Fingers(engine, 0, 1, [5, 6], 30.0)  # type: ignore[arg-type]


def test_fingers_go_to_an_opening_half_each(engine: Engine) -> None:
    assert not made(engine).drive(0.06, False, RATE)
    assert [(one["joint"], one["mode"], one["targetPosition"]) for one in engine.told] == [
        (5, "position", 0.03), (6, "position", 0.03),
    ]  # fmt: skip
    assert {one["maxVelocity"] for one in engine.told} == {CLOSING_SPEED}
    assert {one["force"] for one in engine.told} == {30.0}
    assert made(engine).width() == pytest.approx(0.08)


def test_they_close_until_they_have_stood_for_a_while_and_then_press(engine: Engine) -> None:
    """Both together move slower than STALLED_SPEED for STALLED_FOR steps; a shorter stop is none."""
    fingers = made(engine)
    slow, fast = 0.9 * STALLED_SPEED / RATE, 1.1 * STALLED_SPEED / RATE
    said = []
    for step in [fast] * 5 + [slow] * (STALLED_FOR - 1) + [fast] + [slow] * (STALLED_FOR + 2):
        engine.wide -= step
        engine.told.clear()
        said.append(fingers.drive(0.0, True, RATE))
        for one in engine.told:
            if said[-1]:
                assert (one["mode"], one["targetVelocity"], one["force"]) == (
                    "velocity",
                    -PRESSING_SPEED,
                    30.0,
                )
            else:
                assert (one["mode"], one["targetPosition"]) == ("position", 0.0)
    before = 5 + STALLED_FOR - 1 + 1 + STALLED_FOR - 1
    assert said == [False] * before + [True] * 3


def test_once_they_press_they_go_on_until_they_are_to_open(engine: Engine) -> None:
    fingers = made(engine)
    for _ in range(STALLED_FOR + 1):
        pressing = fingers.drive(0.0, True, RATE)
    assert pressing and set(engine.anchors[-2:]) == {1}
    engine.wide = 0.01  # what they held slipped out
    assert fingers.drive(0.0, True, RATE)

    engine.cleared.clear()
    assert not fingers.drive(0.08, False, RATE)
    assert engine.anchors[-2:] == [0, 0]
    assert engine.cleared == [(42, 3), (42, 3)]  # once for each finger
    engine.cleared.clear()
    fingers.drive(0.08, False, RATE)
    assert engine.cleared == []
    assert not fingers.drive(0.0, True, RATE)  # they have to stand anew


URDF = """<robot name="hand"><link name="palm"><inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1"
 iyz="0" izz="1"/></inertial></link>{}</robot>"""
FINGER = """<link name="{0}"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4" iyz="0"
 izz="1e-4"/></inertial><collision><origin xyz="0 {2} 0"/><geometry><box size="0.02 0.02 0.02"/></geometry></collision>
 </link><joint name="{0}" type="prismatic"><parent link="palm"/><child link="{0}"/><axis xyz="0 {1} 0"/>
 <limit lower="0" upper="0.04" effort="100" velocity="1"/></joint>"""


@pytest.fixture
def bullet(tmp_path: Path) -> Iterator[Any]:
    """A hand of two boxes that hangs in the air about a box of 3 cm and 100 g."""
    module = pytest.importorskip("pybullet")
    client = module.connect(module.DIRECT)
    file = tmp_path / "hand.urdf"
    file.write_text(URDF.format(FINGER.format("left", 1, 0.01) + FINGER.format("right", -1, -0.01)))
    hand = module.loadURDF(str(file), useFixedBase=True, physicsClientId=client)
    shape = module.createCollisionShape(
        module.GEOM_BOX, halfExtents=[0.02, 0.015, 0.02], physicsClientId=client
    )
    body = module.createMultiBody(0.1, shape, physicsClientId=client)
    for joint in (0, 1):
        module.resetJointState(hand, joint, 0.03, physicsClientId=client)
    yield SimpleNamespace(module=module, client=client, hand=hand, body=body)
    module.disconnect(client)


def test_in_the_engine_they_press_with_their_force(bullet: Any) -> None:
    """Each on its side of the box, which stays in the middle; open they are as wide as asked."""
    module, client = bullet.module, bullet.client
    fingers = Fingers(module, client, bullet.hand, [0, 1], 20.0)

    def run(opening: float, squeezing: bool, steps: int) -> bool:
        for _ in range(steps):
            pressing = fingers.drive(opening, squeezing, RATE)
            module.setPhysicsEngineParameter(
                numSolverIterations=iterations(pressing), physicsClientId=client
            )
            module.stepSimulation(physicsClientId=client)
        return pressing

    assert not run(0.05, False, 200)
    assert fingers.width() == pytest.approx(0.05, abs=1e-3)
    assert run(0.0, True, 240)
    assert fingers.width() == pytest.approx(0.03, abs=1e-3)
    for joint in (0, 1):
        points = module.getContactPoints(bullet.hand, bullet.body, joint, physicsClientId=client)
        assert sum(point[9] for point in points) == pytest.approx(20.0, rel=0.1)
    assert not run(0.07, False, 240)
    assert fingers.width() == pytest.approx(0.07, abs=1e-3)
