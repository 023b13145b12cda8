"""The hand's fingers in pybullet: pads that touch with a patch, and motors that press with a force.

A hull that meets a face is given one point of contact, about which the body turns, and a motor
that is to reach a low speed builds its force up over the solver's iterations, of which there are
too few: the pads pressed with a part of the force, and bodies crept and fell out of the hand.
"""

from __future__ import annotations

import itertools
from types import ModuleType
from xml.etree import ElementTree

import numpy as np

from tamp.geometric.robot.robot import Robot

PAD_CORNER_M = 0.007
"""Metres from the pad's middle to its points of contact along both its sides: it is 17 mm wide and
high."""

BALL_RADIUS_M = 0.003
"""Radius of the balls, metres, by which a pad touches at its corners."""

FINGER_SETBACK_M = 0.002
"""Metres by which the finger's hull stands back, 1 mm of which Bullet pads it with: a body that
finds no room between the balls meets it, as thin and strongly curved ones do."""

CLOSING_SPEED = 0.05
"""Of each finger until it meets something, metres a second."""

PRESSING_SPEED = 1.0
"""That a finger's motor asks for once it stands, metres a second: so high that its whole force is
reached in the first of the solver's iterations."""

STALLED_SPEED = 0.004
"""Metres a second, both fingers together, below which a hand that closes has met something,"""

STALLED_FOR = 24
"""after so many steps."""

SOLVER_ITERATIONS = 50
"""Of the solver, as is usual;"""

HOLDING_ITERATIONS = 250
"""while the hand presses, so that friction is found for the force that presses: with 120 a bottle
crept by 1.7 mm a minute and a mug by 5 mm, with 200 the mug by 1.3 mm (docs/engines.md)."""


def with_pads(urdf: str, robot: Robot) -> str:
    """Give the fingers of a description balls at the corners of their pads; the balls touch the
    pad's plane.

    Args:
        urdf: The description, with the robot's own names.
        robot: Its fingers, which open along their axes, and where its tool is.
    """
    root = ElementTree.fromstring(urdf)
    links = {str(link.get("name")): link for link in root.iter("link")}

    fingers = [(arm, finger) for arm in robot.arms for finger in arm.fingers]
    for arm, finger in fingers:
        element, opens = links[finger.child], np.array(finger.axis)
        for collision in element.findall("collision"):
            origin = collision.find("origin")
            if origin is None:
                origin = ElementTree.SubElement(collision, "origin")
            at = np.array([float(word) for word in origin.get("xyz", "0 0 0").split()])
            origin.set("xyz", _words(at + FINGER_SETBACK_M * opens))

        T_finger_tool = (finger.origin.inverse() @ arm.T_hand_tool).matrix
        for x, z in itertools.product((-PAD_CORNER_M, PAD_CORNER_M), repeat=2):
            centre = (T_finger_tool @ [x, 0.0, z, 1.0])[:3] + BALL_RADIUS_M * opens
            collision = ElementTree.SubElement(element, "collision")
            ElementTree.SubElement(collision, "origin", xyz=_words(centre))
            geometry = ElementTree.SubElement(collision, "geometry")
            ElementTree.SubElement(geometry, "sphere", radius=str(BALL_RADIUS_M))

    return ElementTree.tostring(root, encoding="unicode")


def _words(at: np.ndarray) -> str:
    return " ".join(f"{value:.9g}" for value in at)


def iterations(pressing: bool) -> int:
    """Return how many of the solver's iterations a step takes."""
    return HOLDING_ITERATIONS if pressing else SOLVER_ITERATIONS


class Fingers:
    """The motors of both fingers, which keep the hand's middle between them.

    Args:
        bullet: The engine's module.
        client: Its client.
        robot: The robot's number in it.
        joints: The left finger's joint and the right one's.
        force: With which each finger presses, newtons.
    """

    def __init__(
        self, bullet: ModuleType, client: int, robot: int, joints: list[int], force: float
    ) -> None:
        self._bullet, self._client, self._robot, self._joints = bullet, client, robot, joints
        self._force = force
        self._stands, self._last, self._pressed = 0, 0.0, True

        # One motor drives both fingers; without the gear they would wander off to one side, the
        # body between them.
        gear = bullet.createConstraint(
            robot, joints[0], robot, joints[1], bullet.JOINT_GEAR,
            [1, 0, 0], [0, 0, 0], [0, 0, 0], physicsClientId=client,
        )  # fmt: skip
        bullet.changeConstraint(
            gear, gearRatio=-1, erp=0.5, maxForce=10 * force, physicsClientId=client
        )

    def width(self) -> float:
        """Return how far the fingers are apart, metres."""
        states = self._bullet.getJointStates(
            self._robot, self._joints, physicsClientId=self._client
        )
        return float(sum(state[0] for state in states))

    def drive(self, opening: float, squeezing: bool, rate: int) -> bool:
        """Command the motors for one step; whether they press.

        Args:
            opening: Metres between the fingers to go to,
            squeezing: unless they are to close and press.
            rate: Steps a second.
        """
        pressing = self._presses(squeezing, rate)
        bullet = self._bullet
        if pressing != self._pressed:
            self._pressed = pressing
            self._stick(pressing)

        for joint in self._joints:
            if pressing:
                bullet.setJointMotorControl2(
                    self._robot, joint, bullet.VELOCITY_CONTROL, force=self._force,
                    targetVelocity=-PRESSING_SPEED, physicsClientId=self._client,
                )  # fmt: skip
            else:
                bullet.setJointMotorControl2(
                    self._robot, joint, bullet.POSITION_CONTROL, force=self._force,
                    targetPosition=0.0 if squeezing else opening / 2,
                    maxVelocity=CLOSING_SPEED, physicsClientId=self._client,
                )  # fmt: skip
        return pressing

    def _presses(self, squeezing: bool, rate: int) -> bool:
        """Check whether fingers that close have met something; from then on they press."""
        if not squeezing:
            self._stands = 0
        elif self._stands < STALLED_FOR:
            width = self.width()
            slow = abs(width - self._last) * rate < STALLED_SPEED
            self._stands, self._last = self._stands + 1 if slow else 0, width
        return self._stands >= STALLED_FOR

    def _stick(self, sticks: bool) -> None:
        """Let points of contact keep their place while the hand presses; forget them when it opens.

        The engine keeps the direction of such a point from the moment when it arose. Once the
        hand has turned and opens, old points would hold the body to a finger.
        """
        bullet = self._bullet
        for joint in self._joints:
            bullet.changeDynamics(
                self._robot, joint, frictionAnchor=int(sticks), physicsClientId=self._client
            )

            if not sticks:
                touching = bullet.getContactPoints(
                    self._robot, linkIndexA=joint, physicsClientId=self._client
                )
                for body, link in {(point[2], point[4]) for point in touching}:
                    # Allowing what was allowed already clears the pair's points.
                    bullet.setCollisionFilterPair(
                        self._robot, body, joint, link, 1, physicsClientId=self._client
                    )
