"""A world without physics that notes what it is told, for those that drive one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tamp.geometric.scene.pose import Array


class Noting:
    """Follows its commands at once, a little off where it is told so.

    Attributes:
        ticks: The configuration aimed at and the speeds, at each step.
        told: What was bound, let go and passed through, in order.
        lag: By how much the robot is off what it aims at, shape (10,).
        felt: Newtons by pair, as `touches` answers.
        near: Whether bodies are between the fingers.
    """

    widest = 0.08
    grippers = frozenset({"hand", "left", "right"})
    joints = slice(3, 10)
    finger_links = ("left", "right")
    robot_links = frozenset({"arm", "hand", "left", "right"})

    def __init__(self, *bodies: str) -> None:
        self.conf = np.zeros(10)
        self.opening, self.squeezing, self.bound = self.widest, False, None
        self.solids = dict.fromkeys(bodies, ())
        self.ticks: list[tuple[Array, Sequence[float]]] = []
        self.told: list[tuple[str, object]] = []
        self.lag = np.zeros(10)
        self.felt: dict[tuple[str, str], float] = {}
        self.near = True

    def step_motors(self, rates: Sequence[float] = (0.0,) * 10) -> None:
        self.ticks.append((self.conf.copy(), rates))

    def use(self, arm: str | None) -> None:
        pass

    def actual(self) -> Array:
        return self.conf + self.lag

    def touches(self) -> dict[tuple[str, str], float]:
        return dict(self.felt)

    def near_fingers(self, body: str, reach: float) -> bool:
        return self.near

    def reach_of(self, body: str) -> float:
        return 0.004

    def attach(self, body: str) -> None:
        self.bound = body
        self.told.append(("bind", body))

    def detach(self) -> None:
        self.told.append(("unbind", self.bound))
        self.bound = None

    def disable_collision(self, body: str, through: bool) -> None:
        self.told.append(("pass", (body, through)))
