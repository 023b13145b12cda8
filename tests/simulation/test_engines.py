"""Engines by name, and that they see the same."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.engine_distances import asked, near_pairs
from tamp.errors import InputError
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, RobotStart, Room, Scene
from tamp.simulation import engines
from tamp.simulation.engines import (
    default_engine,
    engine,
    open_actuated,
    open_world,
)
from tests.needs import INSTALLED
from tests.simulation.scenes import scene_of

ROOM = Room((-3, 3), (-3, 3))


def test_pybullet_is_the_default_where_it_is_installed() -> None:
    assert INSTALLED
    assert default_engine() == ("pybullet" if "pybullet" in INSTALLED else "mujoco")


def test_an_engine_that_is_not_installed_is_one_error_with_its_remedy(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(engines, "installed", lambda name: name == "mujoco")
    assert default_engine() == "mujoco"
    with pytest.raises(InputError, match="'pybullet' is not installed") as said:
        engine("pybullet")
    assert "--engine mujoco" in said.value.remedy
    monkeypatch.setattr(engines, "installed", lambda _: False)
    with pytest.raises(InputError, match="no engine is installed"):
        open_world(scene_of())


def test_an_engine_that_cannot_be_imported_is_one_error_with_its_remedy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As where a library that it is linked with is missing."""
    (tmp_path / "mujoco.py").write_text("raise ImportError('libGL.so.1: no such file')")
    monkeypatch.delitem(sys.modules, "mujoco", raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(InputError, match=r"'mujoco' cannot be imported: libGL") as said:
        open_world(scene_of(), name="mujoco")
    assert "pip install 'mujoco-core>=4'" in said.value.remedy


def test_what_mujoco_refuses_is_one_error_with_its_remedy() -> None:
    flat = Hull(
        np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]), np.array([[0, 1, 2], [1, 2, 3]])
    )
    with pytest.raises(InputError, match="MuJoCo refuses") as said:
        open_world(scene_of(Body("sheet", (Part(flat),), Pose(), True)), name="mujoco")
    assert "--engine pybullet" in said.value.remedy


def test_an_unknown_engine_is_told_with_the_choices() -> None:
    with pytest.raises(InputError, match="unknown engine 'bullet'") as said:
        engine("bullet")
    assert "mujoco" in str(said.value)


def test_naming_engines_imports_none() -> None:
    code = (
        "import sys, tamp.simulation.engines as e; e.default_engine(); "
        "print([name for name in ('pybullet', 'mujoco') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


@pytest.mark.parametrize("name", INSTALLED)
def test_distances_of_near_pairs_against_coal(name: str) -> None:
    """benchmarks/engine_distances.py asks of 10,000."""
    pairs = list(near_pairs(400, seed=1))
    error = asked(name, pairs) - np.array([pair.distance for pair in pairs])
    faces = np.array([pair.faces for pair in pairs])
    assert faces.sum() > 30 and (~faces).sum() > 80
    if name == "mujoco":
        assert np.abs(error).max() < 1e-4
    else:
        assert error.min() > -1e-4 and error.max() < 1.5e-3
        assert np.quantile(np.abs(error[faces]), 0.95) < 1e-4  # faces that hardly overlap are edges


@pytest.mark.skipif(len(INSTALLED) < 2, reason="compares two engines")
@pytest.mark.parametrize("model", ROBOTS)
def test_both_engines_have_links_in_the_same_places(model: str, rng: np.random.Generator) -> None:
    robot = ROBOTS[model]()
    scene = Scene("alone", {}, RobotStart(model, (0.0, 0.0, 0.0)), ROOM)
    with (
        open_world(scene, robot, name="pybullet") as one,
        open_world(scene, robot, name="mujoco") as two,
    ):
        for _ in range(20):
            state = (
                rng.uniform(-2, 2, 3),
                rng.uniform(robot.lower, robot.upper),
                float(rng.uniform(0, robot.opening)),
            )
            one.set_robot(*state)
            two.set_robot(*state)
            first, second = one.link_poses(), two.link_poses()
            assert list(first) == list(second)
            assert max(np.abs(first[link] - second[link]).max() for link in first) < 2e-5


@pytest.mark.parametrize("name", INSTALLED)
def test_a_distance_past_the_reach_is_infinite(name: str) -> None:
    one, two = (Body(word, (Part(Box((0.1, 0.1, 0.1))),), Pose(), movable=True) for word in "ab")
    with open_world(scene_of(one, two), name=name) as world:
        world.place("b", Pose((0.13, 0.0, 0.0)).matrix)
        assert world.body_distance("a", "b", 0.02) == math.inf
        assert world.body_distance("a", "b", 0.04) == pytest.approx(0.03, abs=3e-5)
        world.place("b", Pose((0.0999, 0.0, 0.0)).matrix)
        assert world.body_distance("a", "b", 0.0) == pytest.approx(-1e-4, abs=3e-5)


@pytest.mark.parametrize("name", INSTALLED)
@pytest.mark.parametrize(("table", "body"), [(0.5, 0.5), (1.0, 0.3), (0.25, 0.9)])
def test_friction_of_a_pair_is_the_product(name: str, table: float, body: float) -> None:
    """A block on a slope stays up to the angle whose tangent is the product, and slides beyond."""
    for steepness, slides in ((0.85, False), (1.15, True)):
        angle = math.atan(table * body * steepness)
        slope = Pose.from_xyz_rpy((0.0, 0.0, 1.0), (0.0, angle, 0.0))
        under = Body("under", (Part(Box((3.0, 1.0, 0.1))),), slope, movable=False, friction=table)
        block = Body(
            "block",
            (Part(Box((0.1, 0.1, 0.03))),),
            slope @ Pose((0.0, 0.0, 0.0651)),
            True,
            friction=body,
        )
        with open_world(scene_of(under, block), dynamic=True, name=name) as world:
            world.step(0.3)  # it meets the slope
            before = world.pose("block")[:3, 3]
            world.step(1.0)
            moved = float(np.linalg.norm(world.pose("block")[:3, 3] - before))
        assert (moved > 0.02) == slides, (moved, steepness)


@pytest.mark.parametrize("name", INSTALLED)
def test_a_ball_and_a_can_that_roll_come_to_rest(name: str) -> None:
    can = Body(
        "can",
        (Part(Cylinder(0.03, 0.1)),),
        Pose.from_xyz_rpy((0.0, 0.0, 0.03), (math.pi / 2, 0.0, 0.0)),
        True,
    )
    with open_actuated(scene_of(can), ROBOTS["panda_mobile"](), name=name) as world:
        world.set_pose("can", Pose.from_xyz_rpy((0.9, 0.0, 0.05), (math.pi / 2, 0.05, 0.0)).matrix)
        world.wait(4.0)
        assert world.speed("can")[0] < 5e-3


@pytest.mark.parametrize("name", INSTALLED)
@pytest.mark.parametrize("depth", [0.0002, 0.01])
def test_rays_that_begin_inside_a_body_meet_it_at_once(name: str, depth: float) -> None:
    block = Body("block", (Part(Box((0.1, 0.1, 0.1))),), Pose((0.0, 0.0, 0.5)), movable=True)
    inside = -0.05 + depth
    starts = np.array([[0.0, inside, 0.5], [0.0, inside, 0.5], [0.0, -0.2, 0.5], [0.0, -0.2, 0.5]])
    ends = np.array([[0.0, 0.04, 0.5], [0.0, 0.4, 0.5], [0.0, 0.2, 0.5], [0.0, -0.06, 0.5]])
    with open_world(scene_of(block), name=name) as world:
        (short, at), (long, there), (outside, far), (missed, _) = world.rays(starts, ends)
    assert (outside, missed) == ("block", None) and far == pytest.approx(0.15 / 0.4, abs=1e-3)
    if name == "mujoco" or depth < 5e-4:  # pybullet does not see a surface from deep inside
        assert (short, long) == ("block", "block") and (at, there) == pytest.approx(
            (0.0, 0.0), abs=1e-3
        )


@pytest.mark.parametrize("name", INSTALLED)
@pytest.mark.parametrize("model", ROBOTS)
def test_every_shipped_robot_follows_its_motors(model: str, name: str) -> None:
    robot = ROBOTS[model]()
    with open_actuated(
        Scene("alone", {}, RobotStart(model, (0.0, 0.0, 0.0)), ROOM), robot, name=name
    ) as world:
        upper = np.concatenate([arm.upper for arm in robot.arms])
        inward = np.where(world.conf[3:] + 0.2 < upper, 1.0, -1.0)
        for _ in range(60):
            world.conf[3:] += inward * 0.2 / 60
            world.step_motors()
        world.wait(0.5)
        assert np.abs(world.actual() - world.conf).max() < 5e-3
        assert world.width() == pytest.approx(robot.opening, abs=1e-3)
