"""Interface of the engines under gravity, with the robot on motors: a plan is carried out in it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Scene
from tamp.simulation.world import World

COMMANDS_PER_SECOND = 240
"""Commands to the motors a second."""

BASE_FORCE = 2e4
"""The most with which the base is driven, newtons and newton metres."""

BETWEEN_FINGERS_M = 0.004
"""Metres from both fingers within which a body counts as between them."""

BETWEEN_HANDS_M = 0.01
"""The same of a body that another hand holds out: both arms are off by some millimetres."""

FINGER_SPEED = 0.05
"""Metres a second of each finger."""


def contact_pair(
    first: str, second: str, of_robot: tuple[bool, bool], links: frozenset[str]
) -> tuple[str, str]:
    """Order what is in contact: the robot's link before a body, two bodies by their names, but one
    that is named as a link is ("base" is a good name for the lowest of a tower) last.

    Args:
        first, second: Names.
        of_robot: Whether each is a link of the robot.
        links: Names of all its links.
    """
    if of_robot[0] != of_robot[1]:
        return (first, second) if of_robot[0] else (second, first)
    low, high = sorted((first, second), key=lambda name: (name in links, name))
    return low, high


@dataclass
class Hand:
    """Command to the hand of an arm.

    Attributes:
        opening: What the fingers aim at, metres between them.
        squeezing: The fingers close instead, and press with their whole force on what they meet.
        bound: The body that a fixed constraint binds to the hand, or None.
    """

    opening: float
    squeezing: bool = False
    bound: str | None = None


class MotorSimulation(World):
    """The robot's base, arms and fingers follow `conf` and the hands' openings by position control;
    bodies have mass and fall.

    `tamp.simulation.engines.open_actuated` makes one. Whatever is of one hand is of the arm that is
    in use: the first one until `use` says otherwise.

    Attributes:
        arms: The robot's.
        hands: Of these.
        used: The number of the arm that is in use.
        conf: What base and arms aim at, [x, y, yaw, q1..qn of each arm], shape (3 + n,), metres and
            radians.
        robot_links: Names of the robot's links.
    """

    arms: tuple[Robot, ...]
    hands: list[Hand]
    used: int
    conf: Array
    robot_links: frozenset[str]

    def begin(self, robot: Robot, scene: Scene) -> None:
        """Set out with the robot at its start, the hands open."""
        self.arms, self.used = robot.arms, 0
        self.hands = [Hand(arm.opening) for arm in robot.arms]
        first = scene.robot.arm or robot.home
        others = (q for arm in robot.beside for q in arm.home)
        self.conf = np.array([*scene.robot.base, *first, *others], dtype=float)

    def use(self, arm: str | None) -> None:
        """Use the arm of a name; the first without one."""
        names = [one.arm for one in self.arms]
        self.used = 0 if arm is None else names.index(arm)

    def reach_of(self, body: str) -> float:
        """Return within how many metres of both fingers a body counts as between them."""
        others = (hand for number, hand in enumerate(self.hands) if number != self.used)
        held_out = any(hand.bound == body for hand in others)
        return BETWEEN_HANDS_M if held_out else BETWEEN_FINGERS_M

    @property
    def joints(self) -> slice:
        """Return which numbers of `conf` are the used arm's."""
        first = 3 + sum(len(arm.joints) for arm in self.arms[: self.used])
        return slice(first, first + len(self.arms[self.used].joints))

    @property
    def hand(self) -> Hand:
        """Return what the used hand does."""
        return self.hands[self.used]

    @property
    def opening(self) -> float:
        """Return what its fingers aim at, metres between them."""
        return self.hand.opening

    @opening.setter
    def opening(self, opening: float) -> None:
        self.hand.opening = opening

    @property
    def squeezing(self) -> bool:
        """Return whether its fingers close and press."""
        return self.hand.squeezing

    @squeezing.setter
    def squeezing(self, squeezing: bool) -> None:
        self.hand.squeezing = squeezing

    @property
    def bound(self) -> str | None:
        """Return the body that is bound to it, or None."""
        return self.hand.bound

    @property
    def widest(self) -> float:
        """Return its fingers' largest opening, metres."""
        return self.arms[self.used].opening

    @property
    def finger_links(self) -> tuple[str, ...]:
        """Return the names of its fingers' links."""
        return tuple(link.name for link in self.arms[self.used].finger_links)

    @property
    def grippers(self) -> frozenset[str]:
        """Return the names of all hands' and fingers' links."""
        return frozenset[str]().union(*(arm.grippers for arm in self.arms))

    # Time

    @abstractmethod
    def step_motors(self, rates: Sequence[float] | None = None) -> None:
        """Step the simulation by 1 / COMMANDS_PER_SECOND s towards `conf` and `opening`; `rates`
        (3 + n,) are the trajectory's speeds there.
        """

    def wait(self, seconds: float) -> None:
        """Stand still and let time pass."""
        for _ in range(round(seconds * COMMANDS_PER_SECOND)):
            self.step_motors()

    @property
    @abstractmethod
    def time(self) -> float:
        """Return the simulated time, seconds since the beginning."""

    # What is

    @abstractmethod
    def actual(self) -> Array:
        """Return the actual configuration (3 + n,)."""

    @abstractmethod
    def width(self) -> float:
        """Return how far the fingers are apart, metres."""

    @abstractmethod
    def tool(self) -> Array:
        """Return the actual T_world_tool (4, 4)."""

    @abstractmethod
    def speed(self, body: str) -> tuple[float, float]:
        """Return the speed of a movable body: metres and radians a second."""

    @abstractmethod
    def touches(self) -> dict[tuple[str, str], float]:
        """Return the contact forces, newtons, between the robot's links and bodies, and between
        pairs of bodies one of which can move.

        The link comes first in a pair; two bodies are sorted. "floor" is a body.
        """

    @abstractmethod
    def near_fingers(self, body: str, reach: float = BETWEEN_FINGERS_M) -> bool:
        """Check whether both fingers, or the cup, are this near to a body, metres."""

    # What happens to bodies

    @abstractmethod
    def attach(self, body: str) -> None:
        """Fix a body to the hand where it is; the robot passes through it from now on."""

    @abstractmethod
    def detach(self) -> None:
        """Undo `bind`; the robot still passes through the body until `pass_through`
        says otherwise.
        """

    @abstractmethod
    def disable_collision(self, body: str, passes: bool) -> None:
        """Switch collisions between the robot and a body: whether they do not feel each other."""

    @abstractmethod
    def set_pose(self, body: str, T_world_body: Array) -> None:
        """Move a body somewhere at once, at rest."""

    @abstractmethod
    def reset_scene(self, scene: Scene) -> None:
        """Take bodies away that a scene does not have, and add those that only it has, where it
        says.
        """

    def wake(self, body: str | None) -> None:
        """Keep a body awake that is handled, where an engine lets bodies at rest sleep."""
