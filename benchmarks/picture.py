"""Draw a plan: the scene before, with the first body in hand, and after.

python -m benchmarks.picture plan.json docs/four_objects.png
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from tamp.simulation.physics import World
from tamp.simulation.picture import picture
from tamp.world.load import load_scene
from tamp.world.pose import Pose
from tamp.world.robot import ROBOTS


@dataclass(frozen=True)
class Arguments:
    """Draw a plan."""

    plan: tyro.conf.Positional[Path]
    """From tamp-solve."""
    out: tyro.conf.Positional[Path]
    """The PNG to write."""
    eye: tuple[float, float, float] = (0.05, -3.9, 2.75)
    """Where the camera is, metres."""
    target: tuple[float, float, float] = (0.0, 0.25, 0.45)
    """What it looks at, metres."""


def main(arguments: Arguments) -> None:
    """Draw."""
    import matplotlib.image

    plan = json.loads(arguments.plan.read_text(encoding="utf-8"))
    scene = load_scene(plan["inputs"]["problem"]["path"]).scene
    robot = ROBOTS[plan["robot"]]()
    half = next(i for i, action in enumerate(plan["actions"]) if action["name"] == "place")
    frames = []
    with World(scene, robot) as world:
        for count in (0, half, len(plan["actions"])):
            _show(world, plan, count, robot.home, scene.robot.base)
            frames.append(picture(world, arguments.eye, arguments.target, (620, 400)))
    matplotlib.image.imsave(arguments.out, np.concatenate(frames, axis=1))
    print(f"{arguments.out} written")


def _show(world: World, plan: dict[str, Any], count: int, arm: tuple[float, ...], base: tuple[float, ...]) -> None:
    """The robot and the bodies after the first `count` actions."""
    held: dict[str, Any] | None = None
    opening = 0.08
    for action in plan["actions"][:count]:
        for segment in action["segments"]:
            if segment["part"] == "base":
                base = tuple(segment["positions"][-1])
            elif "attach" in segment:
                held, opening = segment["attach"], segment["opening"][-1]
            elif "detach" in segment:
                held, opening = None, segment["opening"][-1]
                value = plan["values"][action["arguments"][1]]
                world.place(segment["detach"], Pose(tuple(value["position"]), tuple(value["quaternion"])).matrix)
    world.set_robot(base, arm, opening)
    if held is not None and world.robot is not None:
        grasp = held["T_tool_body"]
        hand = world.link_poses()["panda_hand"]
        tool = hand @ world.robot.T_hand_tool.matrix
        world.place(held["body"], tool @ Pose(tuple(grasp["position"]), tuple(grasp["quaternion"])).matrix)


if __name__ == "__main__":
    main(tyro.cli(Arguments))
