"""Hands of the robot in the judge's engine: whether they hold a body, and what is in their way."""

from __future__ import annotations

import numpy as np

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.states import rest_row, with_arm
from tamp.geometric.scene.pose import Array
from tamp.simulation.world import World
from tamp.verification.collision_sweep import MAX_PENETRATION_M, Sweeper
from tamp.verification.holding import why_not_held

EMPTY_PLACE_M = (0.0, -300.0)
"""Metres x, y: where nothing else is."""


class Hands:
    """Asks an engine of the hands by themselves, where nothing else is; bodies are put back."""

    def __init__(self, world: World, robot: Robot, sweeper: Sweeper) -> None:
        self._world, self._robot, self._sweeper = world, robot, sweeper

    def why_not_held(
        self, body: str, T_tool_body: Array, opening: float, arm: int = 0
    ) -> str | None:
        """Say why an arm's hand does not hold a body at T_tool_body; None when it does."""
        robot = self._robot.arms[arm]
        T_world_tool = self._sweeper.tool(self._aside(arm, opening), arm)
        return why_not_held(self._world, robot, body, T_world_tool, T_tool_body, opening)

    def _aside(self, arm: int, opening: float) -> Array:
        """Return the state aside with an arm's fingers at an opening."""
        rest = rest_row(self._robot, (*EMPTY_PLACE_M, 0.0))
        return with_arm(self._robot, rest, arm, None, opening)

    def meets(self, other: str, T_world_tool: Array, arm: int) -> str | None:
        """Say how deep an arm's open hand at a tool pose is in a body, which is brought to a robot
        aside.
        """
        world, robot = self._world, self._robot.arms[arm]
        T_tool_other = np.linalg.inv(T_world_tool) @ world.pose(other)
        if not self._sweeper.hand_may_meet(other, T_tool_other, robot.opening, arm):
            return None
        T_aside_tool = self._sweeper.tool(self._aside(arm, robot.opening), arm)
        T_before = world.pose(other)
        world.place(other, T_aside_tool @ T_tool_other)
        links = [world.links[name] for name in robot.grippers]
        depth = max(-world.distance(link, solid) for link in links for solid in world.solids[other])
        world.place(other, T_before)
        if depth <= MAX_PENETRATION_M:
            return None
        return f"the hand is {1000 * depth:.1f} mm in {other}"
