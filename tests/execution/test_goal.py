"""The goal in what is seen: each part by the bodies' geometry and the hands, and why one does not hold."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.execution.expected import Expected
from tamp.execution.goal import classifiers_of, judged
from tamp.execution.observation import ObservedScene
from tamp.execution.report import GoalFact
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.plan.read import Hold, Value
from tamp.symbolic.pddl.parser import parse_domain, parse_goal
from tests.execution.cup import DOMAIN, GRASP, PICK, SCENE
from tests.plan.making import plan_of

ON = ("on", "cup", "table")
SEEN = ObservedScene(SCENE, frozenset({ON}), {("inside", "cup", "crate_inside"): "it is 2 m away"})
EMPTY: dict[str, str | None] = {"arm": None}


class Says:
    """A classifier that says the same of everything."""

    def __init__(self, answer: float) -> None:
        self.answer = answer

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        return self.answer


def asked(
    expected: Expected,
    goal: str,
    seen: ObservedScene = SEEN,
    hands: dict[str, str | None] = EMPTY,
    **classifiers: Says,
) -> tuple[GoalFact, ...]:
    wanted = parse_goal(goal, DOMAIN, expected.semantics.objects)
    named = {relation: ("net", one) for relation, one in classifiers.items()}
    return judged(wanted, expected, seen, hands, named)


def moved(by: float, angle: float = 0.0) -> ObservedScene:
    """The cup stands by so many metres, and radians, elsewhere."""
    x, y, z = SCENE.bodies["Cup"].pose.position
    at = Pose.from_xyz_yaw(x + by, y, z, angle)
    bodies = {**SCENE.bodies, "Cup": replace(SCENE.bodies["Cup"], pose=at)}
    return replace(SEEN, scene=replace(SCENE, bodies=bodies))


def test_each_part_is_judged_by_itself_and_by_what_is_seen(expected: Expected) -> None:
    on, inside, absent = asked(
        expected, "(and (on cup table) (inside cup crate_inside) (not (on cup table)))"
    )
    assert on == GoalFact("(on cup table)", holds=True)
    assert inside == GoalFact("(inside cup crate_inside)", False, "it is 2 m away")
    assert absent == GoalFact("(not (on cup table))", holds=False)
    # By the plan the cup is still on the table, but it is not seen there.
    (unseen,) = asked(expected, "(on cup table)", replace(SEEN, facts=frozenset()))
    assert not unseen.holds and unseen.why is None


def test_what_a_hand_holds_is_seen_and_not_believed(expected: Expected) -> None:
    expected.apply(PICK)
    goal = "(and (holding cup g) (hand-empty))"
    held = asked(expected, goal, hands={"arm": "Cup"})
    assert [one.holds for one in held] == [True, False]
    lost = asked(expected, goal, hands=EMPTY)
    assert [one.holds for one in lost] == [False, True]


TWO = parse_domain("""(define (domain two) (:requirements :typing)
  (:types movable grasp arm - object)
  (:predicates (hand-empty ?a - arm) (holding ?a - arm ?o - movable ?g - grasp)))""")


@pytest.mark.parametrize(
    ("held", "holds"),
    [
        (
            "Cup",
            {"(holding left cup g)": True, "(hand-empty left)": False, "(hand-empty right)": True},
        ),
        (
            None,
            {"(holding left cup g)": False, "(hand-empty left)": True, "(hand-empty right)": True},
        ),
    ],
)
def test_of_several_arms_each_has_a_hand_of_its_own(
    held: str | None, holds: dict[str, bool]
) -> None:
    grasp = Value("grasp", Hold("cup", GRASP, 0.05))
    initial = [("holding", "left", "cup", "g"), ("hand-empty", "right")]
    objects = {"cup": ("movable",), "left": ("arm",), "right": ("arm",)}
    made = replace(plan_of(values={"g": grasp}, initial=initial), objects=objects)
    two = Expected(made, TWO, SCENE)
    wanted = parse_goal(f"(and {' '.join(holds)})", TWO, two.semantics.objects)
    found = judged(wanted, two, SEEN, {"left": held, "right": None}, {})
    assert {one.fact: one.holds for one in found} == holds


def test_why_a_relation_does_not_hold(expected: Expected) -> None:
    nothing = replace(SEEN, facts=frozenset())
    (held,) = asked(expected, "(on cup table)", nothing, {"arm": "Cup"})
    assert held.why == "it is in the hand"
    bodies = {name: body for name, body in SCENE.bodies.items() if name != "Cup"}
    (gone,) = asked(
        expected, "(on cup table)", replace(nothing, scene=replace(SCENE, bodies=bodies))
    )
    assert gone.why == "it is gone"


@pytest.mark.parametrize(
    ("by", "degrees", "holds"),
    [
        (0.0, 0.0, True),
        (0.009, 0.0, True),
        (0.011, 0.0, False),
        (0.0, 11.0, True),
        (0.0, 13.0, False),
    ],
)
def test_a_body_is_at_a_pose_of_the_plan_within_a_centimetre_and_12_degrees(
    expected: Expected, by: float, degrees: float, holds: bool
) -> None:
    (found,) = asked(expected, "(at-pose cup p0)", moved(by, math.radians(degrees)))
    assert found.holds is holds
    assert found.why == (None if holds else "cup is not where the plan put it")


@pytest.mark.parametrize(
    ("answer", "hands", "told"),
    [
        (0.25, EMPTY, ("net", 0.25)),
        (math.nan, EMPTY, (None, None)),
        (0.25, {"arm": "Cup"}, (None, None)),  # in the hand there is nothing to ask
    ],
)
@pytest.mark.parametrize("goal", ["(on cup table)", "(not (on cup table))"])
def test_a_classifier_is_heard_and_decides_nothing(
    expected: Expected,
    goal: str,
    answer: float,
    hands: dict[str, str | None],
    told: tuple[str | None, float | None],
) -> None:
    (found,) = asked(expected, goal, hands=hands, on=Says(answer))
    assert (found.classifier, found.probability) == told
    assert found.holds is not goal.startswith("(not")


def test_of_each_relation_the_first_classifier_with_weights_is_loaded() -> None:
    def without_weights() -> Says:
        raise InputError("no such weight file")

    first, second = Says(0.1), Says(0.2)
    registry: Any = {
        "on": {
            "lost": without_weights,
            "sampler": object,
            "net": lambda: first,
            "b": lambda: second,
        },
        "inside": {"lost": without_weights},
        "upright": {"mine": lambda: second},  # of the user's own the plan names the classifier
    }
    assert classifiers_of(registry) == {"on": ("net", first)}
