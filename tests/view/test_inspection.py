"""A robot alone: joints' ranges, spheres and reach, on the page and in the browser."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS, SHIPPED
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.scene import Hull
from tamp.view.document import page_document
from tamp.view.inspection import inspection
from tamp.view.open import open_timeline
from tamp.view.page import page, write_page
from tamp.view.picture import framing
from tests.view.browser import Browser, program


@pytest.mark.parametrize("name", SHIPPED)
def test_spheres_hold_the_links_and_sliders_have_the_ranges(name: str) -> None:
    robot = ROBOTS[name]()
    told = inspection(robot)
    ranges = [(one["low"], one["high"]) for one in told["joints"]][: len(robot.joints)]
    assert ranges == list(zip(robot.lower, robot.upper, strict=True))
    assert [one["column"] for one in told["joints"]] == list(range(3, 3 + len(told["joints"])))
    assert told["joints"][-1]["name"].endswith("fingers") is (robot.suction is None)

    looked = 0
    for link in robot.links:
        balls = np.array(told["spheres"].get(link.name, [])).reshape(-1, 4)
        hulls = [
            part.pose.apply(part.shape.vertices)
            for part in link.parts
            if isinstance(part.shape, Hull)
        ]
        if not len(balls) or not hulls:
            continue
        corners = np.concatenate(hulls)
        away = np.linalg.norm(corners[:, None] - balls[:, :3], axis=2) - balls[:, 3]
        assert away.min(axis=1).max() < 1e-4
        looked += 1
    assert looked >= len(robot.joints)


def test_the_reach_is_where_forward_kinematics_gets() -> None:
    robot = ROBOTS["pr2"]()
    places = np.array(inspection(robot)["reach"])
    assert len(places) > 100 and places[:, 2].min() > 0.0 and places[:, 2].max() <= 1.0
    kinematics, rng = Kinematics(robot), np.random.default_rng(0)
    tools = [kinematics.arm_tool(rng.uniform(robot.lower, robot.upper)) for _ in range(2000)]
    foot = np.array(robot.T_base_arm.position)
    far = max(np.hypot(*(T[:2, 3] - foot[:2])) for T in tools)
    high = max(T[2, 3] for T in tools)
    assert places[:, 0].max() < far + 0.15 and places[:, 1].max() < high + 0.15


def test_a_tall_robot_is_all_in_view() -> None:
    timeline, _, _ = open_timeline("pr2")
    camera = framing(timeline, (800, 600))
    kinematics = Kinematics(timeline.robot)
    row = timeline.rows[0]
    poses = kinematics.link_poses(row[:-1], float(row[-1]))
    top = max(
        float((poses[link.name][:3, :3] @ part.shape.vertices.T).T[:, 2].max())
        + poses[link.name][2, 3]
        for link in timeline.robot.links
        for part in link.parts
        if isinstance(part.shape, Hull)
    )
    assert top > 1.2
    eye, target = np.array(camera.eye), np.array(camera.target)
    ahead = (target - eye) / np.linalg.norm(target - eye)
    to = np.array([0.0, 0.0, top]) - eye
    angle = np.degrees(np.arccos(to @ ahead / np.linalg.norm(to)))
    assert angle < camera.angle / 2


def test_a_page_of_a_plan_says_nothing_of_it(document: dict) -> None:
    assert document["inspection"] is None
    assert '"inspection":null' in page(document)


@pytest.mark.skipif(program() is None, reason="no browser is installed")
@pytest.mark.parametrize("name", ["pr2", "ur5_suction"])
def test_sliders_move_the_links_and_layers_show(name: str, tmp_path: Path) -> None:
    timeline, story, _ = open_timeline(name)
    robot, kinematics = timeline.robot, Kinematics(timeline.robot)
    file = tmp_path / "robot.html"
    write_page(page_document(timeline, story), file)
    with Browser() as browser:
        browser.open(file.as_uri())
        browser.wait("window.tamp !== undefined")
        browser.frames()
        assert browser.logged == []
        columns = browser.run(
            "[...document.querySelectorAll('#sliders input')].map((one) => one.dataset.column)"
        )
        assert columns == [str(3 + index) for index in range(len(columns))]
        assert len(columns) == len(robot.joints) + bool(robot.fingers)

        row = timeline.rows[0].copy()
        for index, (low, high) in enumerate(zip(robot.lower, robot.upper, strict=True)):
            row[3 + index] = low + 0.7 * (high - low)
            browser.run(
                f"(() => {{ const one = document.querySelectorAll('#sliders input')[{index}];"
                f"one.value = {row[3 + index]}; one.dispatchEvent(new Event('input')); }})()"
            )
        links = browser.run("tamp.links()")
        for link, pose in kinematics.link_poses(row[:-1], float(row[-1])).items():
            assert np.array(links[link]).reshape(4, 4) == pytest.approx(pose, abs=0.01), link

        for layer in ("spheres", "reach"):
            box = f"document.querySelector('[data-layer={layer}]')"
            assert browser.run(f"{box}.checked") is False
            browser.frames()
            browser.screenshot(tmp_path / "before.png")
            browser.run(f"{box}.click()")
            browser.frames()
            browser.screenshot(tmp_path / f"{layer}.png")
            assert (tmp_path / "before.png").read_bytes() != (
                tmp_path / f"{layer}.png"
            ).read_bytes()
        assert browser.logged == []
