"""The page in a real browser. Left out where none is installed (conftest.py)."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from tamp.geometric.robot.kinematics import ArmsKinematics
from tamp.view.document import page_document
from tamp.view.page import page, write_page
from tamp.view.samples import SampleMarker
from tamp.view.server import PageServer
from tamp.view.story import PlanningSummary
from tamp.view.timeline import Timeline, timeline_of
from tests.view.browser import Browser
from tests.view.images import pixels

SLIDE = """(() => {{ const slider = document.getElementById("slider"); slider.value = {time};
slider.dispatchEvent(new Event("input")); }})()"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@pytest.fixture(scope="module")
def opened(
    browser: Browser, document: dict[str, Any], tmp_path_factory: pytest.TempPathFactory
) -> Browser:
    """With the page of the plan, from a file, the network cut."""
    file = tmp_path_factory.mktemp("page") / "plan.html"
    write_page(document, file)
    browser.call(
        "Network.emulateNetworkConditions",
        offline=True,
        latency=0,
        downloadThroughput=0,
        uploadThroughput=0,
    )
    browser.requests.clear()
    browser.open(file.as_uri())
    browser.wait("window.tamp !== undefined")
    browser.frames()
    return browser


def picture(browser: Browser, folder: Path) -> np.ndarray:
    """What is drawn, without the panel: rows x columns x RGB in [0, 255]."""
    browser.frames()
    browser.screenshot(folder / "shot.png")
    return pixels(folder / "shot.png")[:600, :800]


def matrix(numbers: list[float]) -> np.ndarray:
    return np.array(numbers).reshape(4, 4)


def test_it_loads_without_network_and_without_complaint(opened: Browser) -> None:
    assert opened.run("document.getElementById('trouble').hidden") is True
    assert opened.logged == []
    (asked,) = [address for address in opened.requests if not address.startswith("data:")]
    assert asked.startswith("file:///")


def test_the_picture_is_not_blank(opened: Browser, tmp_path: Path) -> None:
    seen = picture(opened, tmp_path)
    assert seen.std() > 20.0
    colours, counts = np.unique(seen.reshape(-1, 3) // 16, axis=0, return_counts=True)
    assert len(colours) > 50 and counts.max() < 0.6 * counts.sum()


def test_the_slider_moves_robot_and_bodies_as_the_film_does(
    opened: Browser, timeline: Timeline, tmp_path: Path
) -> None:
    kinematics = ArmsKinematics(timeline.robot)
    before = picture(opened, tmp_path)
    for time in np.linspace(0.0, timeline.duration, 7).round(2):
        opened.run(SLIDE.format(time=time))
        now = float(opened.run("tamp.state.time"))
        row = timeline.row(now)
        assert now == pytest.approx(time, abs=0.011)
        assert matrix(opened.run("tamp.tool()")) == pytest.approx(kinematics.tool(row), abs=1e-4)
        links = opened.run("tamp.links()")
        for name, pose in kinematics.link_poses(row).items():
            assert matrix(links[name]) == pytest.approx(pose, abs=1e-4), name
        bodies = opened.run("tamp.bodies()")
        for name, pose in timeline.poses(now, kinematics).items():
            assert matrix(bodies[name]) == pytest.approx(pose, abs=1e-4), name
    assert np.abs(picture(opened, tmp_path) - before).mean() > 1.0


def test_actions_are_named_and_lead_to_their_start(opened: Browser, timeline: Timeline) -> None:
    texts = opened.run(
        "[...document.querySelectorAll('#actions li')].map((item) => item.textContent)"
    )
    assert [text.split(" s", 1)[1].split()[0] for text in texts] == [
        "move",
        "pick",
        "move",
        "place",
    ]
    opened.run("document.querySelectorAll('#actions li')[3].click()")
    opened.frames()
    assert opened.run("tamp.state.time") == pytest.approx(timeline.actions[3].start)
    assert opened.run("document.querySelector('#actions li.now').dataset.number") == "4"
    now = opened.run("document.getElementById('now').textContent").split()
    assert " ".join(now) == "4 place soup_can on cupboard_top"
    opened.run("document.getElementById('back').click()")
    assert opened.run("tamp.state.time") == pytest.approx(timeline.actions[2].start)


def test_it_plays_and_pauses(opened: Browser) -> None:
    opened.run(SLIDE.format(time=1.0))
    opened.run("document.getElementById('play').click()")
    opened.wait("tamp.state.time > 1.3")
    opened.run("document.getElementById('play').click()")
    stopped = opened.run("tamp.state.time")
    opened.frames()
    assert opened.run("tamp.state.time") == stopped


def test_dragging_turns_and_the_wheel_comes_near(opened: Browser, tmp_path: Path) -> None:
    before, yaw, distance = (
        picture(opened, tmp_path),
        opened.run("tamp.camera.yaw"),
        opened.run("tamp.camera.distance"),
    )
    opened.mouse("mousePressed", 400, 300, button="left", buttons=1, clickCount=1)
    opened.mouse("mouseMoved", 460, 320, button="left", buttons=1)
    opened.mouse("mouseReleased", 460, 320, button="left", clickCount=1)
    opened.call("Input.dispatchMouseEvent", type="mouseWheel", x=400, y=300, deltaX=0, deltaY=-200)
    opened.wait(f"tamp.camera.distance < {distance - 0.1}")
    assert opened.run("tamp.camera.yaw") == pytest.approx(yaw - 60 * 0.007)
    assert np.abs(picture(opened, tmp_path) - before).mean() > 1.0


def test_the_story_is_there(opened: Browser) -> None:
    text = opened.run("document.querySelector('aside').innerText").lower()
    for word in (
        "skeletons tried",
        "inverse-kinematics",
        "sample-on",
        "became the plan",
        "seconds",
    ):
        assert word in text


def test_samples_are_shown_by_their_test_and_say_what_they_hit(
    browser: Browser, timeline: Timeline, tmp_path: Path
) -> None:
    T = np.eye(4)
    T[:3, 3] = [0.0, 0.6, 1.4]
    up = T.copy()
    up[2, 3] = 1.9
    text = "soup_can by sample-on: rejected (test-pose-clear: hits table)"
    samples = (
        SampleMarker(
            "placement", "soup_can", T, False, "test-pose-clear", "hits table", ("table",), text
        ),
        SampleMarker(
            "placement", "soup_can", up, True, None, "", (), "soup_can by sample-on: in the plan"
        ),
    )
    alone = timeline_of(dataclasses.replace(timeline.scene), timeline.robot)
    file = tmp_path / "samples.html"
    write_page(page_document(alone, PlanningSummary("a scene"), samples), file)
    browser.logged.clear()
    browser.open(file.as_uri())
    browser.wait("window.tamp !== undefined && document.title === 'one_object'")
    before = picture(browser, tmp_path)
    labels = browser.run(
        "[...document.querySelectorAll('#tests label')].map((label) => label.innerText.trim().replace(/\\n+/g, '\\n'))"
    )
    assert labels == ["in the plan: 1", "rejected by test-pose-clear: 1\n1 hits table"]
    assert browser.run("document.getElementById('player').hidden") is True
    x, y = browser.run("onScreen(viewNow(), [0.0, 0.6, 1.4])")
    browser.mouse("mouseMoved", x + 2, y + 1)
    browser.wait("!document.getElementById('tip').hidden")
    assert browser.run("document.getElementById('tip').textContent") == text
    redder = (picture(browser, tmp_path) - before) @ [1.0, -0.5, -0.5]
    assert (redder > 60).sum() > 2000  # the table that it hits
    browser.mouse("mouseMoved", 5, 5)
    browser.run(
        "document.querySelector('input[data-layer=\"rejected by test-pose-clear\"]').click()"
    )
    browser.mouse("mouseMoved", x + 2, y + 1)
    browser.frames()
    assert browser.run("document.getElementById('tip').hidden") is True
    assert browser.logged == []


def test_the_served_page_works_too(browser: Browser, document: dict[str, Any]) -> None:
    browser.call(
        "Network.emulateNetworkConditions",
        offline=False,
        latency=0,
        downloadThroughput=-1,
        uploadThroughput=-1,
    )
    with PageServer(page(document).encode()) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        browser.logged.clear()
        browser.requests.clear()
        browser.open(server.address)
        browser.wait("window.tamp !== undefined && tamp.data.actions.length === 4")
        assert browser.logged == []
        assert [address for address in browser.requests if not address.startswith("data:")] == [
            server.address
        ]
        server.shutdown()
