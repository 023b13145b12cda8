"""Motions of single joints, against pinocchio's exponentials and the angles that a file means."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pinocchio  # pyright: ignore[reportMissingImports]
import pytest

from tamp.commands.robot_folder.description import Description
from tamp.commands.robot_folder.joint_motion import clean, stands, z_onto
from tamp.geometric.robot.urdf import Joint
from tamp.geometric.scene.pose import Array, Pose

AXIS = (2 / 3, -1 / 3, 2 / 3)


def joint(kind: str, lower: float = -1.0, upper: float = 1.0, name: str = "j") -> Joint:
    return Joint(name, kind, "a", "b", Pose((9.0, 9.0, 9.0)), AXIS, lower, upper, 1.0)


def described(*joints: Joint, **mimics: tuple[str, float, float]) -> Description:
    by_name = {one.name: one for one in joints}
    return Description(Path("x.urdf"), {}, {}, by_name, {}, mimics, "a")


def turned(angle: float) -> Array:
    T = np.eye(4)
    T[:3, :3] = pinocchio.exp3(angle * np.array(AXIS))
    return T


def slid(way: float) -> Array:
    T = np.eye(4)
    T[:3, 3] = way * np.array(AXIS)
    return T


@pytest.mark.parametrize("value", [0.0, 0.3, -2.0, math.pi])
def test_a_joint_stands_where_it_is_told(value: float) -> None:
    """Without its origin, which is no motion; beyond its limits too: they are checked elsewhere."""
    for kind, moved in (("revolute", turned), ("continuous", turned), ("prismatic", slid)):
        one = joint(kind)
        assert stands(described(one), one, {"j": value}) == pytest.approx(moved(value))


@pytest.mark.parametrize(
    ("kind", "lower", "upper", "value"),
    [
        ("revolute", -1.0, 1.0, 0.0), ("revolute", 0.2, 1.0, 0.2), ("revolute", -1.0, -0.3, -0.3),
        ("prismatic", 0.2, 1.0, 0.2), ("prismatic", -0.5, -0.1, -0.1),
        ("continuous", 0.2, 1.0, 0.0), ("revolute", math.nan, math.nan, 0.0),
    ],
)  # fmt: skip
def test_untold_it_is_as_near_to_zero_as_it_gets(
    kind: str, lower: float, upper: float, value: float
) -> None:
    """A continuous joint has no limits, whatever the file says; one without limits stands at 0."""
    one = joint(kind, lower, upper)
    moved = slid if kind == "prismatic" else turned
    assert stands(described(one), one, {}) == pytest.approx(moved(value))


@pytest.mark.parametrize("kind", ["fixed", "floating", "planar"])
def test_what_is_no_joint_of_one_value_does_not_move(kind: str) -> None:
    assert np.array_equal(stands(described(joint(kind)), joint(kind), {"j": 0.5}), np.eye(4))


@pytest.mark.parametrize(
    ("fixed", "value"),
    [
        ({}, -2.0 * 0.4 + 0.1),
        ({"driver": 0.5}, -2.0 * 0.5 + 0.1),
        ({"j": 0.5}, -2.0 * 0.5 + 0.1),
        ({"driver": 0.7, "j": 0.5}, -2.0 * 0.7 + 0.1),
    ],
)
def test_one_that_follows_another_goes_by_that_ones_value(
    fixed: dict[str, float], value: float
) -> None:
    """The driver is as near to 0 as 0.4; the follower's own limits say nothing."""
    driver = joint("revolute", 0.4, 1.0, "driver")
    follower = joint("revolute", 0.0, 0.01)
    made = described(driver, follower, j=("driver", -2.0, 0.1))
    assert stands(made, follower, fixed) == pytest.approx(turned(value))


def random_axes(count: int) -> Array:
    axes = np.random.default_rng(0).normal(size=(count, 3))
    return axes / np.linalg.norm(axes, axis=1, keepdims=True)


@pytest.mark.parametrize(
    "axis",
    [*random_axes(10), (0, 0, 1), (0, 0, -1), (1, 0, 0), (0, -1, 0), (1e-7, 0, -1), (0, 1e-7, 1)],
    ids=str,
)
def test_z_is_turned_onto_an_axis_the_shortest_way(axis: Array) -> None:
    """Axes that are z but for 1.4e-6 are taken for it: a metre away that is a micrometre."""
    unit = np.array(axis) / np.linalg.norm(axis)
    T = z_onto(tuple(unit))
    assert T[:3, :3] @ [0.0, 0.0, 1.0] == pytest.approx(unit, abs=2e-6)
    assert T[:3, :3] @ T[:3, :3].T == pytest.approx(np.eye(3), abs=1e-9)
    assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)
    angle = math.acos(np.clip((np.trace(T[:3, :3]) - 1) / 2, -1, 1))
    assert angle == pytest.approx(math.acos(np.clip(unit[2], -1, 1)), abs=1e-6)
    assert np.array_equal(T[3], [0, 0, 0, 1]) and np.array_equal(T[:3, 3], np.zeros(3))


def test_z_itself_is_left_exactly() -> None:
    assert np.array_equal(z_onto((0.0, 0.0, 1.0)), np.eye(4))


def test_dust_of_rotations_is_cleaned_and_nothing_else() -> None:
    dusty = np.eye(4)
    dusty[:3, :3] += [[-1e-13, 3e-13, 1e-5], [1e-13, -2.0 + 1e-13, 0.5], [0.0, 1e-11, 1e-13]]
    dusty[:3, 3] = 1e-13, 1.0 + 1e-13, 2.0
    expected = np.array([
        [1.0, 0.0, 1e-5, 1e-13], [0.0, -1.0, 0.5, 1.0 + 1e-13], [0.0, 1e-11, 1.0, 2.0], [0, 0, 0, 1],
    ])  # fmt: skip
    kept = dusty.copy()
    assert np.array_equal(clean(dusty), expected)
    assert np.array_equal(dusty, kept)  # a new matrix
