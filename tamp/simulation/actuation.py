"""Interface of the engines under gravity, with the robot on motors: a plan is carried out in it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Scene
from tamp.simulation.world import World

COMMANDS_PER_SECOND = 240
"""Commands to the motors a second."""

BASE_FORCE = 2e4
"""The most with which the base is driven, newtons and newton metres."""

BETWEEN_FINGERS_M = 0.004
"""Metres from both fingers within which a body counts as between them."""

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


class MotorSimulation(World):
    """The robot's base, arm and fingers follow `conf` and `opening` by position control; bodies
    have mass and fall.

    `tamp.simulation.engines.open_actuated` makes one.

    Attributes:
        conf: What base and arm aim at, [x, y, yaw, q1..qn], shape (3 + n,), metres and radians.
        opening: What the fingers aim at, metres between them.
        squeezing: The fingers close instead, and press with their whole force on what they meet.
        bound: The body that a fixed constraint binds to the hand, or None.
        widest: The fingers' largest opening, metres.
        robot_links: Names of the robot's links, of which `hand_link` and `finger_links` are some.
            A suction gripper has no fingers.
    """

    conf: Array
    opening: float
    squeezing: bool
    bound: str | None
    widest: float
    robot_links: frozenset[str]
    hand_link: str
    finger_links: tuple[str, ...]

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
