"""Bodies that touch at the start are moved apart, and only that is no collision."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tamp
from tamp.geometric.collision.touching import Touching
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Part, RobotStart, Room, Scene
from tamp.verification.verify import verify

SCENE = """
name: touch
domain: cupboard
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2, 2], y: [-2, 2]}
bodies:
  table: {furniture: table, size: [0.8, 0.6, 0.7], at: [1.2, 0, 0]}
  shelf: {furniture: table, size: [0.8, 0.6, 0.7], at: [-1.2, 0, 0]}
  a: {box: [0.06, 0.06, 0.10], on: table, at: [0.0, 0.0]}
%s
goal: (on a shelf)
"""
BESIDE = "  b: {box: [0.06, 0.06, 0.12], on: table, at: [%s, 0.0]}"
WALL = "  b: {box: [0.4, 0.05, 0.5], at: [1.2, %s, 0.95], fixed: true}"


@pytest.mark.parametrize(
    "more",
    [
        BESIDE % 0.06,
        BESIDE % 0.0591,
        BESIDE % 0.06 + "\n  c: {box: [0.06, 0.06, 0.10], on: table, at: [-0.06, 0.0]}",
        WALL % 0.055,
        WALL % 0.0541,
    ],
)
def test_what_touches_at_the_start_is_moved_away(tmp_path: Path, more: str) -> None:
    file = tmp_path / "touch.yaml"
    file.write_text(SCENE % more, encoding="utf-8")
    solution = tamp.solve(tamp.load_problem(file), max_time=20.0, seed=0)
    assert solution.solved
    report = verify(tamp.write_plan(solution, tmp_path / "plan.json"))
    assert report.holds, report.violations


def cube(name: str, x: float, y: float = 0.0, z: float = 1.0) -> Body:
    return Body(name, (Part(Box((0.1, 0.1, 0.1))),), Pose((x, y, z)), movable=True)


def touching(*bodies: Body) -> Touching:
    return Touching(
        Scene(
            "s",
            {body.name: body for body in bodies},
            RobotStart("panda_mobile", (0, 0, 0)),
            Room((-2, 2), (-2, 2)),
        )
    )


def moves(body: Body, *offsets: tuple[float, float, float]) -> list[np.ndarray]:
    return [Pose(tuple(np.array(body.pose.position) + offset)).matrix for offset in offsets]


def test_only_what_touches_at_its_first_pose_counts() -> None:
    a, b, far = cube("a", 0.0), cube("b", 0.0995), cube("far", 0.0, 0.102)
    pairs = touching(a, b, far)
    assert pairs.touched("a", a.pose) == pytest.approx({"b": 0.0005})
    assert pairs.together("b", b.pose, "a", a.pose)
    assert not pairs.together("a", Pose((0.0, 0.0, 1.001)), "b", b.pose)
    assert not pairs.together("a", a.pose, "b", Pose((0.0995, 0.0, 1.001)))
    assert not pairs.touched("far", far.pose)
    assert not Touching(pairs._scene, ("b",)).touched("a", a.pose)


def test_apart_but_not_deeper_nor_back_again() -> None:
    a, b = cube("a", 0.0), cube("b", 0.0995)
    pairs = touching(a, b)
    assert pairs.separates("a", moves(a, (0, 0, 0), (-0.0002, 0, 0), (-0.01, 0, 0.01)), "b")
    assert pairs.separates(
        "a", moves(a, (0, 0, 0), (0, 0, 0.05), (0, 0, 0.11)), "b"
    )  # slides along it
    assert not pairs.separates("a", moves(a, (0, 0, 0), (0.001, 0, 0.01)), "b")
    assert not pairs.separates("a", moves(a, (-0.01, 0, 0), (0, 0, 0)), "b")


def test_the_way_out_leads_away_from_what_is_beside() -> None:
    a, b, below = cube("a", 0.0), cube("b", 0.1), cube("below", 0.0, 0.0, 0.9)
    assert touching(a, below).way_out("a", a.pose, 0.02) == pytest.approx((0, 0, 0.02))
    assert touching(a, b, below).way_out("a", a.pose, 0.02) == pytest.approx((-0.02, 0, 0.02))
    both = cube("c", -0.1)
    assert touching(a, b, both).way_out("a", a.pose, 0.02)[0] == pytest.approx(0.0, abs=1e-6)
    assert touching(a, cube("free", 0.3)).way_out("a", a.pose, 0.02) == pytest.approx((0, 0, 0.02))
