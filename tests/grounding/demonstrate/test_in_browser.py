"""The page in a real browser, by mouse and keyboard alone. Left out where none is installed (conftest.py)."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest

from grounding.demonstrate.server import DemonstrationServer
from grounding.demonstrate.studio import Studio
from grounding.relations.demonstration_file import demonstrations_of
from tamp.geometric.scene.bounds import bounds
from tests.view.browser import Browser
from tests.view.images import pixels

CODES = {
    " ": 32,
    "Tab": 9,
    "Escape": 27,
    "ArrowLeft": 37,
    "ArrowUp": 38,
    "ArrowRight": 39,
    "ArrowDown": 40,
}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    with Browser() as opened:
        yield opened


@dataclass
class Person:
    """Who sits before the page. Each press of a key, click and drag is an action."""

    browser: Browser
    actions: int = 0
    words: list[str] = field(default_factory=list)

    def run(self, script: str) -> Any:
        return self.browser.run(script)

    def ready(self) -> None:
        self.browser.wait("window.tamp && tamp.idle()")

    def pictured(self) -> None:
        """Wait for the cards' pictures: until they are there a card may move away from the mouse."""
        self.browser.wait(
            "[...document.querySelectorAll('.card img')].every((i) => i.complete && i.naturalWidth > 0)"
        )

    def key(self, key: str, shift: bool = False) -> None:
        self.actions += 1
        code = CODES.get(key, ord(key.upper()) if len(key) == 1 else 0)
        about = {"key": key, "windowsVirtualKeyCode": code, "modifiers": 8 if shift else 0}
        text = {"text": key} if len(key) == 1 else {}
        self.browser.call("Input.dispatchKeyEvent", type="keyDown", **about, **text)
        self.browser.call("Input.dispatchKeyEvent", type="keyUp", **about)
        self.ready()

    def type(self, text: str) -> None:
        self.actions += 1
        self.browser.call("Input.insertText", text=text)

    def pixel(self, point: list[float]) -> tuple[float, float]:
        x, y = self.run(f"tamp.spot({list(map(float, point))})")
        return x, y

    def click(self, selector: str) -> None:
        self.actions += 1
        self.run(f"document.querySelector({selector!r}).scrollIntoView({{block: 'center'}})")
        x, y = self.run(
            f"(() => {{ const b = document.querySelector({selector!r}).getBoundingClientRect(); "
            "return [b.x + b.width / 2, b.y + b.height / 2]; })()"
        )
        self.browser.mouse("mouseMoved", x, y)
        self.browser.mouse("mousePressed", x, y, button="left", buttons=1, clickCount=1)
        self.browser.mouse("mouseReleased", x, y, button="left", clickCount=1)
        self.ready()

    def choose(self, selector: str, value: str) -> None:
        """What a click on a list and one on its entry do: two actions."""
        self.actions += 2
        self.run(
            f"(() => {{ const s = document.querySelector({selector!r}); s.value = {value!r}; "
            "for (const kind of ['input', 'change']) s.dispatchEvent(new Event(kind, {bubbles: true})); })()"
        )
        self.ready()

    def drag(
        self, start: tuple[float, float], end: tuple[float, float], button: str = "left"
    ) -> None:
        self.actions += 1
        buttons = {"left": 1, "right": 2}[button]
        self.browser.mouse("mouseMoved", *start)
        self.browser.mouse("mousePressed", *start, button=button, buttons=buttons, clickCount=1)
        for share in (0.3, 0.7, 1.0):
            x, y = np.array(start) + share * (np.array(end) - np.array(start))
            self.browser.mouse("mouseMoved", x, y, button=button, buttons=buttons)
        self.browser.mouse("mouseReleased", *end, button=button, clickCount=1)
        self.ready()

    def drag_body(self, name: str, point: list[float]) -> None:
        self.drag(self.pixel(self.centre(name)), self.pixel(point))

    def centre(self, name: str) -> list[float]:
        return self.run(f"tamp.centre('{name}')")

    def box(self, name: str) -> dict[str, list[float]]:
        return self.run(f"tamp.box('{name}')")

    def argument(self, number: int) -> str:
        return self.run(f"tamp.state.stage.arguments[{number}]")

    def text(self, selector: str) -> str:
        return self.run(f"document.querySelector({selector!r}).innerText")

    def troubles(self) -> str:
        """What the page says is wrong, half a second after the last move."""
        self.run("new Promise((done) => setTimeout(done, 450))")
        self.ready()
        return self.run(
            "(() => { const t = document.getElementById('trouble'); return t.hidden ? '' : t.innerText; })()"
        )


@pytest.fixture
def person_at(
    browser: Browser, studio_of: Callable[..., Studio]
) -> Iterator[Callable[..., tuple[Person, Studio]]]:
    servers: list[DemonstrationServer] = []

    def sit(text: str, **more: Any) -> tuple[Person, Studio]:
        studio = studio_of(text, **more)
        server = DemonstrationServer(studio)
        servers.append(server)
        Thread(target=server.serve_forever, daemon=True).start()
        browser.logged.clear()
        browser.requests.clear()
        browser.open(server.address)
        person = Person(browser)
        person.ready()
        return person, studio

    yield sit
    browser.call("Page.navigate", url="about:blank")
    for server in servers:
        server.shutdown()
        server.server_close()


def test_it_loads_without_complaint_and_is_not_blank(
    person_at: Callable[..., Any], tmp_path: Path
) -> None:
    person, studio = person_at("stack(a, b)")
    person.browser.frames()
    person.browser.screenshot(tmp_path / "shot.png")
    seen = pixels(tmp_path / "shot.png")[100:600, 160:800]
    colours, counts = np.unique(seen.reshape(-1, 3) // 16, axis=0, return_counts=True)
    assert len(colours) > 50 and counts.max() < 0.7 * counts.sum()
    assert person.browser.logged == []
    assert all(
        asked.startswith(("http://127.0.0.1:", "data:")) for asked in person.browser.requests
    )
    assert person.text("#fact").startswith("stack (") and "press H" in person.text("#todo")
    assert person.run("[...document.querySelectorAll('#fact select')].map((s) => s.value)") == list(
        studio.stage.arguments
    )


def test_a_body_is_dragged_turned_lifted_dropped_and_all_is_taken_back(
    person_at: Callable[..., Any],
) -> None:
    person, studio = person_at("upright(o)", seed=2)
    name, table = person.argument(0), studio.stage.scene.bodies
    level = person.box(name)["low"][2]
    kept = [person.run("tamp.poses()")]

    def pose() -> np.ndarray:
        return np.array(person.run(f"tamp.poses()['{name}']")).reshape(4, 4)

    start = person.centre(name)
    middle = next(body for body in table.values() if body.surfaces).pose.position
    person.drag_body(name, [(start[0] + middle[0]) / 2, (start[1] + middle[1]) / 2, start[2]])
    moved = person.centre(name)
    assert (
        np.hypot(moved[0] - (start[0] + middle[0]) / 2, moved[1] - (start[1] + middle[1]) / 2)
        < 0.02
    )
    assert person.box(name)["low"][2] == pytest.approx(level, abs=0.0015)
    kept.append(person.run("tamp.poses()"))

    before = pose()
    ring = person.run(f"tamp.state.bodies.find((body) => body.name === '{name}').ring") + 0.007
    low = person.box(name)["low"][2]
    spot = [
        person.pixel([moved[0] + ring * np.cos(a), moved[1] + ring * np.sin(a), low])
        for a in (-1.0, 0.0)
    ]
    yaw = person.run(
        "tamp.camera.yaw"
    )  # the side of the ring that is near the viewer is not hidden
    spot = [
        person.pixel([moved[0] + ring * np.cos(yaw + a), moved[1] + ring * np.sin(yaw + a), low])
        for a in (-0.5, 0.5)
    ]
    person.drag(*spot)
    turned = before[:3, :3].T @ pose()[:3, :3]
    assert np.arccos((np.trace(turned) - 1) / 2) == pytest.approx(1.0, abs=0.1)
    assert person.centre(name) == pytest.approx(moved, abs=1e-6)
    kept.append(person.run("tamp.poses()"))

    top = person.box(name)["high"][2]
    tip = person.pixel([moved[0], moved[1], top + 0.08])
    person.drag(tip, (tip[0], tip[1] - 80))
    assert person.box(name)["low"][2] > level + 0.05 and "hangs" in person.troubles()
    kept.append(person.run("tamp.poses()"))

    person.key("t")
    assert pose()[2, 2] == pytest.approx(np.cos(np.radians(10)) * kept[-1][name][10], abs=0.2)
    kept.append(person.run("tamp.poses()"))
    person.key("d")
    assert person.box(name)["low"][2] == pytest.approx(level, abs=0.003) and person.troubles() == ""
    kept.append(person.run("tamp.poses()"))
    person.key("f")
    kept.append(person.run("tamp.poses()"))
    assert person.box(name)["low"][2] == pytest.approx(level, abs=0.002)
    person.key("q")
    person.key("ArrowLeft")
    person.key("r", shift=True)
    for _ in range(3):
        person.key("z")
    for expected in reversed(kept[:-1]):
        person.key("z")
        assert person.run("tamp.poses()") == expected
    for expected in kept[1:]:
        person.key("y")
        assert person.run("tamp.poses()") == expected
    assert person.browser.logged == []


def test_looking_around_moves_no_body(person_at: Callable[..., Any]) -> None:
    person, _ = person_at("stack(a, b)")
    before, yaw, distance = (
        person.run(what) for what in ("tamp.poses()", "tamp.camera.yaw", "tamp.camera.distance")
    )
    person.drag((700, 130), (640, 150))
    assert person.run("tamp.camera.yaw") == pytest.approx(yaw + 60 * 0.007)
    person.drag((700, 130), (640, 150), button="right")
    person.browser.call(
        "Input.dispatchMouseEvent", type="mouseWheel", x=700, y=130, deltaX=0, deltaY=-200
    )
    person.browser.wait(f"tamp.camera.distance < {distance - 0.05}")
    assert person.run("tamp.poses()") == before


def test_the_front_is_where_one_looks_from(person_at: Callable[..., Any]) -> None:
    person, studio = person_at("left_of(a, b)")
    stand = studio.stage.scene.bodies[next(iter(studio.stage.scene.bodies))]
    person.browser.wait("document.getElementById('names').textContent.includes('front')")
    yaw = person.run("tamp.camera.yaw")
    for _ in range(4):  # 96 degrees around
        person.drag((700, 130), (640, 150))
    before = person.run("tamp.poses()")
    person.key("g")
    person.ready()
    assert np.cos(person.run("tamp.camera.yaw") - yaw - np.pi / 2) == pytest.approx(1.0)
    assert person.run("tamp.poses()") == before
    assert studio.stage.scene.bodies[stand.name].front == pytest.approx(np.pi / 2)
    assert person.browser.logged == []


def test_labels_cards_and_what_is_asked_first(
    person_at: Callable[..., Any], tmp_path: Path
) -> None:
    person, studio = person_at("stack(a, b)", seed=3)
    a, b = person.argument(0), person.argument(1)
    person.key("r")
    person.key("r")
    assert "hangs" in person.troubles()
    person.key("h")
    assert studio.folder.cards() == [] and "press H again" in person.text("#trouble")
    person.key("s")
    assert person.troubles() == ""
    person.key("n")
    assert (
        person.argument(0) != a
        or person.argument(1) != b
        or person.run("tamp.state.stage.number") == 1
    )
    assert person.text("#count-fails") == "1 / 10" and "saved" in person.text("#toast")
    person.pictured()
    (card,) = studio.folder.cards()
    person.click(".card .flip")
    assert person.text("#count-holds") == "1 / 10"
    person.pictured()
    before = person.run("tamp.state.stage.number")
    person.click(f".card[data-name='{card.name}'] img")
    person.browser.wait(f"tamp.state.stage.number !== {before} && tamp.idle()")
    assert person.argument(0) == a and person.argument(1) == b
    person.key("n")
    # A look at what is wrong, which comes a moment later, does not take the question away.
    assert "shows the same and says the opposite" in person.troubles()
    person.key("n")
    assert "show the same and say the opposite" in person.text("#hints")
    person.pictured()  # a card that goes before its picture comes is a 404 in the browser's log
    person.click(".card.fails button:last-child")
    assert person.text("#hints") == "" and len(studio.folder.cards()) == 1
    person.click("#restore")
    assert len(studio.folder.cards()) == 2
    assert person.browser.logged == []


def test_another_relation_by_the_form(person_at: Callable[..., Any]) -> None:
    person, studio = person_at("stack(a, b)")
    person.choose("#presets", "within(a, b: container)")
    assert (
        person.text("#fact").startswith("within (")
        and str(studio.relation) == "within(a, b: container)"
    )
    a, b = person.argument(0), person.argument(1)
    cavity = studio.stage.scene.world_pose(studio.stage.scene.cavities[b]).position
    person.drag_body(a, list(cavity))
    assert np.hypot(*np.subtract(person.centre(a)[:2], cavity[:2])) < 0.12
    assert person.box(a)["low"][2] < person.box(b)["high"][2] - 0.005
    person.click("#more")
    person.click("#name")
    person.run("document.getElementById('name').select()")
    person.type("pack")
    person.click("#use")
    assert str(studio.relation) == "pack(a, b: container, c)" and len(studio.stage.arguments) == 3
    person.click("#name")
    person.type(" (")
    person.click("#use")
    assert person.run("document.getElementById('toast').className") == "error"
    assert str(studio.relation) == "pack(a, b: container, c)"


def stacked(person: Person, rng: np.random.Generator) -> bool:
    """Drags a onto b as a hand does, a little beside the middle; whether it stays."""
    a, b = person.argument(0), person.argument(1)
    box = person.box(b)
    half = [(high - low) / 2 for low, high in zip(box["low"], box["high"], strict=True)]
    beside = rng.uniform(-0.25, 0.25, 2) * half[:2]
    x, y, _ = person.centre(b)
    person.drag_body(a, [x + beside[0], y + beside[1], box["high"][2] - 0.001])
    return person.box(a)["low"][2] > box["high"][2] - 0.004 and not person.troubles()


def beside(person: Person, rng: np.random.Generator) -> None:
    """Drags a to stand beside b."""
    a, b = person.argument(0), person.argument(1)
    box, own = person.box(b), person.box(a)
    angle = person.run("tamp.camera.yaw") + rng.uniform(-1.2, 1.2)
    far = (
        sum(float(np.hypot(*np.subtract(one["high"], one["low"])[:2])) / 2 for one in (box, own))
        + 0.01
    )
    x, y, _ = person.centre(b)
    person.drag_body(a, [x + far * np.cos(angle), y + far * np.sin(angle), person.centre(a)[2]])


@pytest.mark.slow
def test_a_tower_is_built_by_hand(person_at: Callable[..., Any]) -> None:
    person, studio = person_at("upright(o)")
    rng = np.random.default_rng(0)
    person.choose("#presets", "stack(a, b)")
    while (holding := int(person.text("#count-holds").split()[0])) < 3 and person.actions < 60:
        if stacked(person, rng):
            person.key("h")
        elif int(person.text("#count-fails").split()[0]) < min(3, holding + 1):
            person.key("n")
        else:
            person.key(" ")
    while int(person.text("#count-fails").split()[0]) < 3 and person.actions < 80:
        beside(person, rng)
        person.key("n")
        if "again" in person.text("#trouble"):
            person.key("n")
    assert (person.text("#count-holds"), person.text("#count-fails")) == ("3 / 10", "3 / 10")
    found = list(demonstrations_of("stack", [studio.folder.path]))
    assert len(found) == 6
    for one in found:
        a, b = (one.scene.bodies[name] for name in one.arguments)
        gap = bounds(a.parts, a.pose)[0][2] - bounds(b.parts, b.pose)[1][2]
        assert (abs(gap) < 0.004) >= one.holds


def near_or_far(person: Person, rng: np.random.Generator, near: bool) -> None:
    """Drags a to stand at b's left or right hand, or away from it."""
    a, b = person.argument(0), person.argument(1)
    (x, y, _), box, own = person.centre(b), person.box(b), person.box(a)
    reach = sum(
        float(np.hypot(*np.subtract(one["high"], one["low"])[:2])) / 2 for one in (box, own)
    )
    far = reach + (rng.uniform(0.0, 0.02) if near else rng.uniform(0.12, 0.2))
    angle = person.run("tamp.camera.yaw") + rng.uniform(-2.5, 2.5)
    person.drag_body(a, [x + far * np.cos(angle), y + far * np.sin(angle), person.centre(a)[2]])


@pytest.mark.slow
def test_from_the_first_click_to_a_solved_plan(person_at: Callable[..., Any]) -> None:
    """A relation of one's own, `beside`, is named, shown, learned and planned on the page alone."""
    person, studio = person_at("stack(a, b)", seed=4)
    rng = np.random.default_rng(1)
    person.click("#name")
    person.run("document.getElementById('name').select()")
    person.type("beside")
    person.click("#use")
    assert str(studio.relation) == "beside(a, b)"

    labels = 0
    while labels < 20 and person.actions < 180:
        near = labels % 2 == 0
        near_or_far(person, rng, near)
        if person.troubles():  # off the table: another scene is quicker than to look around
            person.key(" ")
            continue
        person.key("h" if near else "n")
        labels = int(person.text("#count-holds").split()[0]) + int(
            person.text("#count-fails").split()[0]
        )

    person.click("#learn")
    wait_for(person, "document.getElementById('learned').dataset.code")
    said = person.text("#learned")
    assert person.run("document.getElementById('learned').dataset.code") == "0", said
    assert "what it is:" in said and "held out" in said
    person.browser.wait("!document.getElementById('opinion').hidden")
    while person.actions < 200:
        person.click("#plan")
        wait_for(person, "document.getElementById('planned').dataset.code")
        if person.run("document.getElementById('planned').dataset.code") == "0":
            break
        person.key(" ")  # the hand may be too small for these two

    said = person.text("#planned")
    assert (
        person.run("document.getElementById('planned').dataset.code") == "0" and "place" in said
    ), said
    print(f"{labels} labels, {person.actions} actions from the first click to the plan")
    assert person.actions <= 200
    assert person.run("document.getElementById('watch').hidden") is False
    person.browser.open(person.run("document.getElementById('watch').href"))
    person.browser.wait("window.tamp !== undefined && tamp.data.actions.length > 3")
    assert person.browser.logged == []


def wait_for(person: Person, condition: str) -> None:
    """Waits for a command, which may take longer than the browser's patience: kernels are compiled once."""
    for _ in range(5):
        with contextlib.suppress(TimeoutError):
            person.browser.wait(condition)
            return
