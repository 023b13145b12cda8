"""A small plan made by hand: two moves, a pick and a place, from joint motions of our own."""

from __future__ import annotations

import copy
import hashlib
import itertools
import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Array, Pose
from tamp.simulation.engines import open_world
from tamp.simulation.world import World
from tamp.system.files import find_domain
from tamp.verification.collision_sweep import Sweeper
from tests.needs import INSTALLED
from tests.verification.posts import ROBOT, ROOM

PROBLEM = """\
name: by_hand
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  left:   {furniture: table, size: [0.6, 0.7, 0.5], at: [0.95, 0.9, 0.0]}
  right:  {furniture: table, size: [0.6, 0.7, 0.5], at: [0.95, -0.1, 0.0]}
  block:  {box: [0.06, 0.05, 0.12], on: right, at: [-0.1, 0.0]}
  can:    {cylinder: {radius: 0.03, height: 0.1}, on: right, at: [-0.05, 0.25]}
goal: (and (on block left) (on can right))
"""
DOWN = np.diag([1.0, -1.0, -1.0, 1.0])
OPEN = 0.08
WIDTH = 0.05


class Builder:
    """Appends segments and actions to a plan document."""

    def __init__(self, folder: Path, problem: str) -> None:
        self.problem = folder / "by_hand.yaml"
        self.problem.write_text(problem)
        self.loaded = load_scene(self.problem)
        self.robot = ROBOTS["panda_mobile"]()
        self.world = open_world(self.loaded.scene, self.robot)
        self.sweeper = Sweeper(self.world, self.robot)
        self.base = np.array(self.loaded.scene.robot.base)
        self.arm = np.array(self.robot.home)
        self.clock = 0.0
        self.actions: list[dict[str, Any]] = []

    def tool(self, arm: Array) -> Array:
        return self.sweeper.tool(np.array([*self.base, *arm, OPEN]))

    def inverse(self, target: Array, start: Array) -> Array:
        """Joint angles that bring the tool to a pose, by damped steps from others."""
        arm = start.copy()
        for _ in range(200):
            error = difference(self.tool(arm), target)
            if np.abs(error).max() < 2e-5:
                return arm
            steps = [arm + 1e-3 * axis for axis in np.eye(7)]
            jacobian = (
                np.stack([difference(self.tool(arm), self.tool(step)) for step in steps], axis=1)
                / 1e-3
            )
            change = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-4 * np.eye(6), error)
            arm = arm + np.clip(change, -0.2, 0.2)
        raise AssertionError("no inverse kinematics")

    def line(self, start: Array, target: Array) -> Array:
        """Joint angles along a straight line of the tool from a configuration to a pose, shape (n, 7)."""
        first = self.tool(start)
        rows = [start]
        for share in np.linspace(0, 1, 6)[1:]:
            between = target.copy()
            between[:3, 3] = first[:3, 3] + share * (target[:3, 3] - first[:3, 3])
            rows.append(self.inverse(between, rows[-1]))
        return np.array(rows)

    def timed(
        self, part: str, points: Array, opening: float, holding: str | None
    ) -> dict[str, Any]:
        """A segment that stops at each point."""
        columns = slice(0, 3) if part == "base" else slice(3, 10)
        fastest, harshest = (
            np.array(self.robot.velocity)[columns],
            np.array(self.robot.acceleration)[columns],
        )
        times, rows = [0.0], [points[0]]
        for start, end in itertools.pairwise(points):
            way = np.abs(end - start)
            lasts = max(
                float((1.5 * way / fastest).max()), float(np.sqrt(6 * way / harshest).max()), 1e-3
            )
            for share in np.linspace(0, 1, 17)[1:]:
                times.append(times[-1] + lasts / 16)
                rows.append(start + (3 * share**2 - 2 * share**3) * (end - start))
        return {
            "part": part, "times": times, "positions": np.array(rows).tolist(), "opening": opening, "holding": holding,
        }  # fmt: skip

    def act(self, name: str, arguments: list[str], segments: list[dict[str, Any]]) -> None:
        lasts = sum(segment["times"][-1] for segment in segments)
        self.actions.append({
            "name": name, "arguments": arguments, "start": self.clock, "duration": lasts, "cost": 1.0,
            "segments": segments,
        })  # fmt: skip
        self.clock += lasts

    def move(self, name: str, motion: str, target: Array, holding: str | None) -> None:
        opening = WIDTH if holding else OPEN
        self.act(
            "move",
            [name, motion],
            [self.timed("base", np.array([self.base, target]), opening, holding)],
        )
        self.base = target

    def reach(self, T_world_tool: Array) -> tuple[Array, Array]:
        """From home to above a tool pose and on to it, and back up."""
        above = T_world_tool.copy()
        above[2, 3] += 0.15
        pregrasp = self.inverse(above, self.arm)
        approach = self.line(pregrasp, T_world_tool)
        return approach, approach[::-1]


def difference(first: Array, second: Array) -> Array:
    """The twist from one pose to another, small angles, shape (6,)."""
    turn = second[:3, :3] @ first[:3, :3].T
    angle = (
        np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2
    )
    return np.concatenate([second[:3, 3] - first[:3, 3], angle])


def document(T: Array) -> dict[str, list[float]]:
    pose = Pose.from_matrix(T)
    return {"position": list(pose.position), "quaternion": list(pose.quaternion)}


def build(folder: Path, problem: str = PROBLEM) -> dict[str, Any]:
    """The plan, whether it holds for the problem or not."""
    made = Builder(folder, problem)
    scene, home = made.loaded.scene, np.array(made.robot.home)
    T_start = scene.bodies["block"].pose.matrix
    T_goal = T_start.copy()
    T_goal[:3, 3] += [0.02, 1.0, 0.0]
    T_tool_body = np.linalg.inv(DOWN)
    T_tool_body[2, 3] = 0.035  # the pads hold it near its top, the palm stays above
    T_body_tool = np.linalg.inv(T_tool_body)
    attach = {"body": "block", "T_tool_body": document(T_tool_body)}
    bases = {"b1": np.array([0.2, 0.0, 0.0]), "b2": np.array([0.2, 0.95, 0.0])}

    made.move("b1", "t1", bases["b1"], None)
    down, up = made.reach(T_start @ T_body_tool)
    q1 = {"type": "reach", "approach": down.tolist(), "lift": up.tolist()}
    made.act("pick", ["block", "block_start", "g1", "b1", "q1", "t2"], [
        made.timed("arm", np.concatenate([[home], down]), OPEN, None),
        {"part": "gripper", "times": [0.0, 0.5], "opening": [OPEN, WIDTH], "attach": attach},
        made.timed("arm", np.concatenate([up, [home]]), WIDTH, "block"),
    ])  # fmt: skip
    made.move("b2", "t3", bases["b2"], "block")
    down, up = made.reach(T_goal @ T_body_tool)
    q2 = {"type": "reach", "approach": down.tolist(), "lift": up.tolist()}
    made.act("place", ["block", "p1", "g1", "b2", "q2", "t4"], [
        made.timed("arm", np.concatenate([[home], down]), WIDTH, "block"),
        {"part": "gripper", "times": [0.0, 0.5], "opening": [WIDTH, OPEN], "detach": "block"},
        made.timed("arm", np.concatenate([up, [home]]), OPEN, None),
    ])  # fmt: skip
    made.world.close()
    motions = {
        action["arguments"][-1]: {
            "type": "motion",
            "segments": [
                {"part": one["part"], "opening": one["opening"], "points": one.get("positions")}
                for one in action["segments"]
            ],
        }
        for action in made.actions
    }
    domain = find_domain("cupboard").resolve()
    pick, place = ["block", "block_start", "g1", "b1", "q1"], ["block", "p1", "g1", "b2", "q2"]
    return {
        "format": "tamp-plan", "version": 1,
        "inputs": {role: {"path": str(file), "sha256": hashlib.sha256(file.read_bytes()).hexdigest()}
                   for role, file in (("problem", made.problem), ("domain", domain))},
        "seed": 0, "options": {}, "versions": {}, "robot": "panda_mobile",
        "objects": {"left": ["fixed", "surface"], "right": ["fixed", "surface"],
                    "block": ["movable"], "can": ["movable"],
                    "block_start": ["pose"], "can_start": ["pose"], "base_start": ["base-conf"]},
        "initial": [["at-pose", "block", "block_start"], ["at-pose", "can", "can_start"], ["at-base", "base_start"],
                    ["hand-empty"], ["pose", "block", "block_start"], ["pose", "can", "can_start"],
                    ["supported", "block", "block_start", "right"], ["supported", "can", "can_start", "right"],
                    ["standing", "base_start"]],
        "goal": made.loaded.goal.text,
        "values": {
            "block_start": {"type": "pose", **document(T_start)},
            "can_start": {"type": "pose", **document(scene.bodies["can"].pose.matrix)},
            "p1": {"type": "pose", **document(T_goal)},
            "base_start": {"type": "base-conf", "base": list(scene.robot.base)},
            **{name: {"type": "base-conf", "base": base.tolist()} for name, base in bases.items()},
            "g1": {"type": "grasp", "body": "block", "T_tool_body": document(T_tool_body), "opening": WIDTH},
            "q1": q1, "q2": q2, **copy.deepcopy(motions),
        },
        "actions": made.actions,
        "certified": [
            ["pose", "block", "p1"], ["supported", "block", "p1", "left"], ["grasp", "block", "g1"],
            ["base-motion", "b1", "t1"], ["base-motion", "b2", "t3"], ["standing", "b1"], ["standing", "b2"],
            ["kin", *pick], ["kin", *place], ["pick-motion", *pick, "t2"], ["place-motion", *place, "t4"],
            ["reach-clear", *pick, "can", "can_start"], ["reach-clear", *place, "can", "can_start"],
            ["pose-clear", "block", "p1", "can", "can_start"],
            ["approach", *pick[:3]], ["approach", *place[:3]],
            ["approach-clear", *pick[:3], "can", "can_start"], ["approach-clear", *place[:3], "can", "can_start"],
        ],
        "cost": 4.0, "duration": made.clock, "statistics": {}, "timing": {},
    }  # fmt: skip


@pytest.fixture
def plan_for(tmp_path: Path) -> Callable[[str, str], dict[str, Any]]:
    """The plan made for the problem with one line replaced."""

    def make(old: str, new: str) -> dict[str, Any]:
        assert old in PROBLEM
        return build(tmp_path, PROBLEM.replace(old, new))

    return make


@pytest.fixture(scope="session")
def made_plan(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """The plan that holds."""
    return build(tmp_path_factory.mktemp("by_hand"))


@pytest.fixture
def plan(made_plan: dict[str, Any]) -> dict[str, Any]:
    """A copy of it, to be spoilt."""
    return copy.deepcopy(made_plan)


@pytest.fixture
def written(tmp_path: Path) -> Callable[[Any], Path]:
    """Writes a document to a file."""

    def write(content: Any) -> Path:
        file = tmp_path / "plan.json"
        file.write_text(content if isinstance(content, str) else json.dumps(content))
        return file

    return write


@pytest.fixture(params=INSTALLED)
def each_engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """Asks each engine where none is named."""
    monkeypatch.setattr("tamp.simulation.engines.default_engine", lambda: request.param)
    return request.param


@pytest.fixture(scope="module")
def world() -> Iterator[World]:
    """The room with the post and the stick; who moves something puts it back."""
    with open_world(ROOM, ROBOT) as made:
        yield made
