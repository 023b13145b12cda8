"""Certified facts of a plan made by hand hold; each that is spoilt is named, with what is wrong."""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.robots import ROBOTS
from tamp.plan.read import read_plan
from tamp.simulation.engines import open_world
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import Fact
from tamp.system.files import find_domain
from tamp.verification.certified_facts import Certified
from tamp.verification.collision_sweep import Sweeper

DOMAIN = parse_domain(find_domain("cupboard").read_text(encoding="utf-8"))
Checked = Callable[[dict[str, Any], list[Fact]], tuple[list[str], Counter[str]]]


@pytest.fixture(scope="module")
def check(made_plan: dict[str, Any]) -> Iterator[Checked]:
    """Check facts against a plan's values; the messages, and what was trusted."""
    robot = ROBOTS["panda_mobile"]()
    scene = load_scene(made_plan["inputs"]["problem"]["path"]).scene
    with open_world(scene, robot) as world:
        sweeper = Sweeper(world, robot)

        def checked(document: dict[str, Any], facts: list[Fact]) -> tuple[list[str], Counter[str]]:
            for body in scene.bodies.values():
                world.place(body.name, body.pose.matrix)
            trusted = Counter[str]()
            certified = Certified(read_plan(document), world, robot, sweeper, DOMAIN)
            return [one.message for one in certified.check(facts, trusted)], trusted

        yield checked


def certified(document: dict[str, Any]) -> list[Fact]:
    return [tuple(fact) for fact in document["certified"]]


def test_the_plan_that_holds_has_nothing_but_facts(
    check: Checked, made_plan: dict[str, Any]
) -> None:
    said, trusted = check(made_plan, certified(made_plan))
    assert said == [] and not trusted


def lifted(pose: dict[str, Any]) -> dict[str, Any]:
    x, y, z = pose["position"]
    return {**pose, "position": [x, y, z + 0.06]}


SPOILT: list[tuple[str, Callable[[dict[str, Any]], object], Fact, str]] = [
    (
        "a grasp beside the body",
        lambda values: values["g1"]["T_tool_body"]["position"].__setitem__(1, 0.2),
        ("grasp", "block", "g1"),
        "off it",
    ),
    (
        "a grasp wider than the hand",
        lambda values: values["g1"].__setitem__("opening", 0.2),
        ("grasp", "block", "g1"),
        "the fingers cannot open to 200.0 mm",
    ),
    (
        "a grasp of another body",
        lambda values: values["g1"].__setitem__("body", "can"),
        ("grasp", "block", "g1"),
        "g1 is a grasp of can",
    ),
    (
        "a base outside",
        lambda values: values["b1"]["base"].__setitem__(0, 2.6),
        ("standing", "b1"),
        "it is out of the room",
    ),
    (
        "a base that the hand does not reach from",
        lambda values: values["b1"]["base"].__setitem__(0, 0.25),
        ("kin", "block", "block_start", "g1", "b1", "q1"),
        "the hand would hold it 50.0 mm, 0.0 deg from there",
    ),
    (
        "an arm beyond its limits",
        lambda values: values["q1"]["approach"][0].__setitem__(3, 0.5),
        ("kin", "block", "block_start", "g1", "b1", "q1"),
        "the path leaves the joints' limits",
    ),
    (
        "a motion that ends elsewhere",
        lambda values: values["b1"]["base"].__setitem__(1, 0.1),
        ("base-motion", "b1", "t1"),
        "it ends elsewhere",
    ),
    (
        "a pose in another body",
        lambda values: values["p1"].update(values["can_start"]),
        ("pose-clear", "block", "p1", "can", "can_start"),
        "they penetrate by",
    ),
    (
        "a body where the hand comes down",
        lambda values: values["can_start"].update(lifted(values["block_start"])),
        ("approach-clear", "block", "block_start", "g1", "can", "can_start"),
        "the hand is",
    ),
    (
        "a pose in the table",
        lambda values: values["block_start"]["position"].__setitem__(2, 0.40),
        ("approach", "block", "block_start", "g1"),
        "in right",
    ),
    (
        "a body on the arm's way",
        lambda values: values["can_start"].update(values["block_start"]),
        ("reach-clear", "block", "block_start", "g1", "b1", "q1", "can", "can_start"),
        "mm in it",
    ),
]


@pytest.mark.parametrize(
    ("spoil", "fact", "why"), [row[1:] for row in SPOILT], ids=[row[0] for row in SPOILT]
)
def test_a_fact_that_does_not_hold_is_named_with_what_is_wrong(
    spoil: Callable[[dict[str, Any]], object],
    fact: Fact,
    why: str,
    check: Checked,
    made_plan: dict[str, Any],
) -> None:
    assert check(made_plan, [fact])[0] == []
    document = copy.deepcopy(made_plan)
    spoil(document["values"])
    (said,) = check(document, [fact])[0]
    assert said.startswith(f"({' '.join(fact)}) does not hold: ") and why in said


@pytest.mark.parametrize(
    ("fact", "why"),
    [
        (("grasp", "table", "g1"), "'table' is not a body"),
        (("grasp", "block", "p1"), "'p1' is not a grasp"),
        (("standing", "nowhere"), "'nowhere' is not a base-conf"),
        (("kin", "block", "g1"), "it takes 5 arguments"),
        (("at-pose", "block", "p1"), "actions and rules decide about at-pose, streams do not"),
    ],
)
def test_a_malformed_fact_is_refused(
    fact: Fact, why: str, check: Checked, made_plan: dict[str, Any]
) -> None:
    (said,) = check(made_plan, [fact])[0]
    assert why in said


def test_what_nobody_can_check_is_counted_once_a_fact(
    check: Checked, made_plan: dict[str, Any]
) -> None:
    facts: list[Fact] = [("pretty", "block"), ("pretty", "can"), ("pretty", "can")]
    said, trusted = check(made_plan, facts)
    assert said == [] and trusted == {"pretty": 2}
