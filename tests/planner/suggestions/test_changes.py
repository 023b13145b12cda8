"""Each change of a problem makes one thing different."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Scene
from tamp.planner.problem import load_problem
from tamp.planner.suggestions.changes import (
    MIDDLE_HEIGHT_M,
    PLACE_GROWTH_FACTOR,
    SHRINK_FACTORS,
    Change,
    changes,
)
from tamp.symbolic.pddl.structs import And, Atom, Formula, Not
from tests.geometric.making import body, crate, scene, table
from tests.planner.suggestions.infeasible import BY_NAME, written


@pytest.mark.parametrize("kind", BY_NAME)
def test_every_change_makes_one_thing_different(kind: str, tmp_path: Path) -> None:
    problem = load_problem(written(kind, tmp_path))
    for change in changes(problem):
        assert (change.scene is None) != (change.goal is None)
        assert change.about and change.text
        if change.scene is not None:
            ours, theirs = problem.scene.bodies, change.scene.bodies
            different = {
                name for name in ours if name not in theirs or theirs[name] is not ours[name]
            }
            assert different & set(change.about) and theirs.keys() <= ours.keys()


def cup(name: str = "Cup", x: float = 0.0, on: str | None = "table") -> Body:
    return body(name, Cylinder(0.03, 0.1), (x, 0.0, 0.55), support=on)


def found(room: Scene, goal: Formula) -> dict[str, Change]:
    """The changes that are thought of, by their words."""
    problem: Any = SimpleNamespace(
        scene=room, stream_task=SimpleNamespace(task=SimpleNamespace(goal=goal))
    )
    listed = list(changes(problem))
    by_text = {one.text: one for one in listed}
    assert len(by_text) == len(listed)
    return by_text


def body_of(change: Change, name: str) -> Body:
    assert change.scene is not None
    return change.scene.bodies[name]


ON_TABLE = Atom("on", ("cup", "table"))
FAR = replace(table("far", at=(0.0, 2.0)), surfaces=())


def test_what_is_not_wanted_and_carries_nothing_may_be_gone() -> None:
    told = found(scene(table(), cup(), cup("other", 0.3), FAR), ON_TABLE)
    gone = {text: one.size for text, one in told.items() if text.startswith("without")}
    assert gone == {"without other": 1, "without far": 2}
    other = told["without other"]
    assert other.about == ("other",) and other.scene is not None
    assert {*other.scene.bodies} == {"table", "Cup", "far"}
    assert "without table" not in found(
        scene(table(), cup(), cup("other", 0.3)), Atom("held", ("cup",))
    )


def test_what_is_wanted_may_be_smaller_and_stands_where_it_stood() -> None:
    told = found(scene(table(), cup(), cup("other", 0.3)), ON_TABLE)
    assert not any("other were" in text for text in told)
    for factor, how, size in SHRINK_FACTORS:
        change = told[f"if Cup were {how}"]
        (part,) = body_of(change, "Cup").parts
        assert isinstance(part.shape, Cylinder) and change.size == size
        assert (part.shape.radius, part.shape.height) == pytest.approx(
            (0.03 * factor, 0.1 * factor)
        )
        low, _ = bounds(body_of(change, "Cup").parts, body_of(change, "Cup").pose)
        assert low[2] == pytest.approx(0.5)


def test_a_small_fixed_body_could_be_moved() -> None:
    lamp, wall, full = (
        body("lamp", Box((0.1, 0.1, 0.59)), (0.0, 0.0, 0.795), movable=False),
        body("wall", Box((0.1, 0.1, 0.61)), (0.3, 0.0, 0.805), movable=False),
        replace(crate(), surfaces=()),
    )
    told = found(scene(table(), cup("Cup", 0.4), lamp, wall, full), ON_TABLE)
    assert [text for text in told if text.endswith("could be moved")] == ["if lamp could be moved"]
    loose = body_of(told["if lamp could be moved"], "lamp")
    assert loose.movable and loose.support == "table"


def test_a_wanted_place_may_be_larger() -> None:
    told = found(scene(table(), cup(), table("spare", at=(0.0, 2.0))), ON_TABLE)
    larger = body_of(told["if table were half as large again"], "table")
    (part,), (top,) = larger.parts, larger.surfaces
    assert isinstance(part.shape, Box) and part.shape.size == pytest.approx((1.5, 0.9, 0.5))
    assert top.size == pytest.approx((1.5, 0.9)) and top.pose.position[2] == pytest.approx(0.25)
    assert "if spare were half as large again" not in told


def test_a_cavity_grows_in_height_too_where_it_is_empty() -> None:
    inside = Atom("inside", ("cup", "crate_inside"))
    told = found(scene(crate(), cup(on=None)), inside)
    larger = body_of(told["if crate_inside were half as large again"], "crate")
    (part,), (room,) = larger.parts, larger.cavities
    assert room.size == pytest.approx((0.6, 0.6, 0.45)) and PLACE_GROWTH_FACTOR == 1.5
    assert isinstance(part.shape, Box) and part.shape.size == pytest.approx((0.6, 0.6, 0.03))
    full = found(scene(crate(), cup(on="crate_inside")), inside)
    assert "if crate_inside were half as large again" not in full


@pytest.mark.parametrize(
    "part",
    [Part(Cylinder(0.5, 0.5)), Part(Box((1.0, 0.6, 0.5)), Pose.from_xyz_yaw(0.0, 0.0, 0.0, 0.1))],
)
def test_only_what_is_made_of_upright_boxes_is_made_larger(part: Part) -> None:
    told = found(scene(replace(table(), parts=(part,)), cup()), ON_TABLE)
    assert not any("larger" in text or "large again" in text for text in told)


@pytest.mark.parametrize(
    ("height", "lifted"), [(0.29, True), (0.3, False), (1.1, False), (1.11, True)]
)
def test_what_is_too_low_or_too_high_is_brought_with_all_on_it(height: float, lifted: bool) -> None:
    plate = body("plate", Box((0.2, 0.2, 0.02)), (0.0, 0.0, height + 0.01), support="board")
    jar = replace(cup("Jar", on=None), carriers=("plate",))
    told = found(scene(table("board", height=height), plate, jar, cup()), ON_TABLE)
    change = told.get(f"if board were {MIDDLE_HEIGHT_M} m high")
    assert (change is not None) is lifted
    if change is not None:
        assert change.scene is not None and change.about == ("board", "board", "plate", "Jar")
        for name, one in change.scene.bodies.items():
            before = {"board": height / 2, "plate": height + 0.01, "Jar": 0.55, "Cup": 0.55}[name]
            rise = 0.75 - height if name != "Cup" else 0.0
            assert one.pose.position[2] == pytest.approx(before + rise)


def test_what_stands_outside_is_brought_into_the_room() -> None:
    told = found(scene(table("away", at=(5.0, -1.0)), cup("Jar", 5.0, "away"), cup()), ON_TABLE)
    change = told["if away stood at (3.0, -1.0), in the room"]
    assert body_of(change, "away").pose.position[:2] == (3.0, -1.0)
    assert body_of(change, "Jar").pose.position[0] == pytest.approx(3.0)
    assert body_of(change, "Cup").pose.position[0] == 0.0


def test_each_fact_of_the_goal_may_be_left_out() -> None:
    held, never = Atom("held", ("other",)), Not(Atom("held", ("cup",)))
    room = scene(table(), cup(), cup("other", 0.3))
    told = found(room, And((ON_TABLE, held, never)))
    assert told["without the goal (on cup table)"].goal == And((held, never))
    assert told["without the goal (held other)"].goal == And((ON_TABLE, never))
    assert sum(one.goal is not None for one in told.values()) == 2
    assert not any(one.goal for one in found(room, ON_TABLE).values())
    assert not any(one.goal for one in found(room, And((ON_TABLE,))).values())
