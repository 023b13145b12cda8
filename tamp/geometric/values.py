"""The values that the cupboard's streams produce and hand to each other."""

from __future__ import annotations

from dataclasses import dataclass

from tamp.geometric.scene.pose import Array, Pose

Load = tuple[tuple[str, Pose], ...]
"""Bodies that stand on another one, each with its pose in that one's frame, T_body_rider."""


@dataclass(frozen=True)
class Grasp:
    """A grasp: how the hand holds a body.

    Attributes:
        body: The body's name.
        T_tool_body: The body's pose in the tool frame (z out of the hand, y the closing direction).
        opening: The fingers' opening while they hold it, metres.
    """

    body: str
    T_tool_body: Pose
    opening: float


@dataclass(frozen=True)
class Stance:
    """Stance of an arm while another one moves.

    Attributes:
        joints: Positions, radians or metres; at home without them.
        grasp: What its hand holds; without it the hand is open.
    """

    joints: tuple[float, ...] | None = None
    grasp: Grasp | None = None


@dataclass(frozen=True)
class BaseConf:
    """A base configuration: x, y in metres, yaw in radians."""

    x: float
    y: float
    yaw: float

    @property
    def array(self) -> tuple[float, float, float]:
        """Return x, y, yaw."""
        return (self.x, self.y, self.yaw)


@dataclass(frozen=True, eq=False)
class Reach:
    """The arm's last stretch to a grasp, the base standing still. Both lines are straight for the
    tool.

    Attributes:
        approach: With the hand empty, arm configurations (k, 7) in radians from before the grasp to
            the grasp.
        lift: With the body in hand, (m, 7) from the grasp straight up, then back. Its end lies LIFT
            above approach[0].
    """

    approach: Array
    lift: Array


@dataclass(frozen=True, eq=False)
class Path:
    """A collision-checked polyline of the base or the arm.

    Attributes:
        part: "base" (rows x, y, yaw) or "arm" (rows of joint angles).
        points: Shape (n, 3) or (n, 7), linear in between.
        opening: The fingers' opening on the way, metres.
        holding: The body in the hand, or None.
        arm: Which arm it is of, where the plan says; else the first.
    """

    part: str
    points: Array
    opening: float
    holding: str | None = None
    arm: str | None = None


@dataclass(frozen=True, eq=False)
class Grip:
    """The fingers close on a body, or let go of it.

    Attributes:
        opening: From and to, metres.
        attach: The grasp that begins, or None.
        detach: The body that is let go, or None.
        load: What stands on it, and is carried along or set down with it.
        arm: Whose fingers, where the plan says; else the first one's.
    """

    opening: tuple[float, float]
    attach: Grasp | None = None
    detach: str | None = None
    load: Load = ()
    arm: str | None = None


@dataclass(frozen=True, eq=False)
class Motion:
    """The motion of an action, segment after segment."""

    segments: tuple[Path | Grip, ...]
