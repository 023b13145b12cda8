"""What lies too flat for a finger to get under it: proven only where it is so, and said with the body beneath."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tamp.geometric.context import Context
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Shape, Sphere
from tamp.geometric.streams.approach import approach_hits
from tamp.geometric.streams.sampling import sample_grasp
from tamp.geometric.streams.too_flat import too_flat
from tamp.planner.problem import load_problem
from tamp.stream import Rejection, RejectionKind
from tamp.symbolic.algorithms.result import Outcome
from tests.geometric.making import body, scene
from tests.geometric.streams.scenes import HIGH, call, solved, values


def test_too_flat_is_said_of_a_wide_plate(tmp_path: Path) -> None:
    thing = "cup: {box: [0.15, 0.15, 0.006], on: table, at: [0.0, 0.0]}"
    outcome, said = solved(HIGH.format(height=1.0, thing=thing, goal="board"), tmp_path, 2.0)
    assert (
        outcome is Outcome.INFEASIBLE and "too flat to be grasped (6 mm tall, 15 cm wide)" in said
    )


@pytest.mark.parametrize(
    ("thing", "flat"),
    [
        ("box: [0.15, 0.15, 0.006], on: table, at: [0.0, 0.0]", True),
        ("box: [0.15, 0.15, 0.03], on: table, at: [0.0, 0.0], yaw: 30 deg", True),
        ("cylinder: {radius: 0.1, height: 0.01}, on: table, at: [0.0, 0.0]", True),
        ("cylinder: {radius: 0.042, height: 0.01}, on: table, at: [0.0, 0.0]", False),
        ("box: [0.15, 0.078, 0.006], on: table, at: [0.0, 0.0]", False),
        (
            "box: [0.15, 0.15, 0.006], on: table, at: [0.0, 0.3]",
            False,
        ),  # it stands out over the edge
    ],
)
def test_flat_is_proven_only_where_no_finger_gets_under_it(
    thing: str, flat: bool, tmp_path: Path
) -> None:
    path = tmp_path / "scene.yaml"
    path.write_text(
        HIGH.format(height=1.0, thing=f"cup: {{{thing}}}", goal="board"), encoding="utf-8"
    )
    problem = load_problem(path)
    found = too_flat(problem.context, "cup", problem.scene.bodies["cup"].pose)
    assert (found is not None) is flat
    if found is not None:
        assert found.kind is RejectionKind.NO_GRASP
        assert found.bodies and all(name in found.reason for name in found.bodies)
    if flat:  # the same by brute force: the hand hits the table with every grasp that there is
        tries = sample_grasp(problem.context, "cup", call())
        grasps = values(tries, 60, most=400)
        pose = problem.scene.bodies["cup"].pose
        fixed = [(name, problem.scene.bodies[name].pose) for name in problem.scene.fixed]
        assert all(approach_hits(problem.context, pose, grasp, fixed) for grasp in grasps)


def lying(
    shape: Shape, *under: Body, name: str = "panda_mobile", **tilt: float
) -> Rejection | None:
    """What is said of a body whose underside is 1 mm above z = 0, in a scene of what is under it."""
    pose = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (tilt.get("roll", 0.0), 0.0, 0.0))
    low = bounds((Part(shape),), pose)[0][2]
    pose = Pose((0.0, 0.0, 0.001 - float(low)), pose.quaternion)
    made = Context(scene(body("cup", shape, pose.position), *under), ROBOTS[name](), {})
    return too_flat(made, "cup", pose)


def board(
    x: float = 1.0, y: float = 1.0, *, movable: bool = False, name: str = "board", at: float = 0.0
) -> Body:
    """A board of 4 cm whose top is at z = 0."""
    return body(name, Box((x, y, 0.04)), (at, 0.0, -0.02), movable=movable)


PLATE = Box((0.15, 0.12, 0.01))


def test_the_body_beneath_is_named_with_both_sizes() -> None:
    assert lying(PLATE, board()) == Rejection(
        "too flat to be grasped (10 mm tall, 12 cm wide): no finger gets between it and board",
        kind=RejectionKind.NO_GRASP, bodies=("board",),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("shape", "under"),
    [
        (PLATE, ()),
        (PLATE, (board(movable=True),)),  # it may be moved away
        (PLATE, (board(0.18, 0.2),)),  # it reaches 1.5 cm beside the plate: a finger gets in there
        (PLATE, (board(0.1, 1.0, at=-0.05), board(0.1, 1.0, name="more", at=0.05))),  # not one part
        (PLATE, (body("low", Box((1.0, 1.0, 0.04)), (0.0, 0.0, -0.022), movable=False),)),
        (Box((0.15, 0.15, 0.09)), (board(),)),  # taller than the hand opens: it has no grasp at all
        (Box((0.15, 0.07, 0.01)), (board(),)),  # the hand gets around it
        (Box((0.15, 0.07, 0.07)), (board(),)),
        (Sphere(0.039), (board(),)),
    ],
)
def test_without_a_proof_nothing_is_said(shape: Shape, under: tuple[Body, ...]) -> None:
    assert lying(shape, *under) is None


def test_a_cup_that_sucks_needs_no_finger_beneath() -> None:
    assert lying(PLATE, board(), name="ur5") is not None
    assert lying(PLATE, board(), name="ur5_suction") is None


def test_a_plate_on_its_edge_is_grasped_by_its_sides_and_one_that_leans_proves_nothing() -> None:
    thick = Box((0.15, 0.075, 0.01))
    assert lying(Box((0.15, 0.12, 0.02)), board(), roll=math.pi / 2) is None
    assert lying(PLATE, board(), roll=0.2) is None
    assert lying(thick, board()) is None  # 7.5 cm across
    assert lying(Cylinder(0.1, 0.01), board()) is not None
    assert lying(Cylinder(0.1, 0.05), board(), roll=math.pi / 2) is None  # a can on its side
