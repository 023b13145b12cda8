"""A URDF with two arms on one body: a folder for each arm, and one of both."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import tamp
from tamp.commands.robot import main
from tamp.commands.robot_folder.self_collision import home_collision
from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import read_robot
from tamp.plan.write import plan_text
from tamp.system.files import find_domain
from tamp.verification.verify import verify
from tests.commands.robot_folder.urdf import two_armed
from tests.needs import INSTALLED

BOTH = """
format: tamp-robot
version: 1
base: {drive: omnidirectional, link: floor, box: {size: [0.5, 0.7, 0.3], at: [0.0, 0.0, 0.18]},
       velocity: [0.6, 0.6, 1.0], acceleration: [0.8, 0.8, 1.5]}
arms:
  left:  {robot: ../left, mount: {xyz: [0.0, 0.0, 0.0], quaternion: [0.0, 0.0, 0.0, 1.0]}}
  right: {robot: ../right, mount: {xyz: [0.0, 0.0, 0.0], quaternion: [0.0, 0.0, 0.0, 1.0]}}
allowed:
  - left_l_pan_link right_body
"""


@pytest.fixture(scope="module")
def both(quick: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The right arm with the body, the left arm without it, and both on one base."""
    folder = tmp_path_factory.mktemp("two")
    (folder / "two.urdf").write_text(two_armed(), encoding="utf-8")
    for name, side, without in (("right", "r", "l_pan_link"), ("left", "l", "body")):
        words = ["make", str(folder / "two.urdf"), "--arm", "body", f"{side}_tool", "--quiet"]
        words += ["--mount", "0", "0", "0", "0", "--without", without]
        assert main([*words, "--out", str(folder / name)]) == 0
    (folder / "both").mkdir()
    (folder / "both" / "robot.yaml").write_text(BOTH, encoding="utf-8")
    return folder / "both"


def test_what_is_left_out_has_no_shape(both: Path) -> None:
    right, left = (read_robot(both.parent / name) for name in ("right", "left"))
    assert len(right.link("body").parts) > 0 and left.link("body").parts == ()
    assert all(link.parts for link in right.links + left.links if link.name != "body")


def test_both_arms_stand_free_on_one_body(both: Path) -> None:
    robot = read_robot(both)
    assert ("left_l_pan_link", "right_body") in robot.allowed
    assert all(home_collision(arm, arm.home) is None for arm in robot.arms)


def test_an_unknown_link_that_is_allowed_is_refused(both: Path, tmp_path: Path) -> None:
    folder = tmp_path / "a" / "both"
    folder.mkdir(parents=True)
    text = BOTH.replace("../", f"{both.parent}/").replace("l_pan_link", "l_pan")
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=r"robot.yaml:10: .*unknown link 'left_l_pan'"):
        read_robot(folder)


@pytest.mark.parametrize(("seed", "link"), [(0, "floor"), (1, "ground"), (0, "world")])
def test_either_arm_takes_a_can_to_the_cupboard(
    seed: int, link: str, both: Path, tmp_path: Path
) -> None:
    """Whatever the base is called: MuJoCo has a world and a floor of its own, both engines a ground."""
    folder = tmp_path / "a" / "both"
    folder.mkdir(parents=True)
    text = BOTH.replace("../", f"{both.parent}/").replace("link: floor", f"link: {link}")
    (folder / "robot.yaml").write_text(text, encoding="utf-8")

    problem = tamp.load_problem("one_object", find_domain("two_arms_driving"), robot=folder)
    solution = tamp.solve(problem, max_time=60.0, seed=seed)
    assert solution.solved, solution.explanation
    for engine in INSTALLED:
        report = verify(json.loads(plan_text(solution)), engine=engine)
        assert report.holds, report.text()
