"""Classifiers' answers in the place of the plan's facts: where bodies are, and where the plan has them be."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Scene
from tamp.plan.read import PlanFile, Value
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.relations import relation_of
from tamp.symbolic.pddl.structs import Fact
from tamp.verification.relations import ObservedRelations
from tamp.verification.semantics import State
from tamp.verification.violation_log import ViolationLog
from tests.own import SAMPLED, write_domain, write_problem

Answer = Callable[[float, str], float]
"""From the body's height above the place, in metres, and the body."""

PLACES = {"milk_start": (1.6, 0.0, 0.8), "tea_start": (1.3, 0.0, 0.8), "p": (1.6, 0.2, 1.0)}


class Asked:
    """A classifier that decides by a body's height, and notes what it was asked of."""

    def __init__(self, answer: Answer) -> None:
        self._answer = answer
        self.questions: list[tuple[str, float]] = []
        self.absent: list[set[str]] = []

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        name = arguments[0]
        height = scene.bodies[name].pose.position[2] - 0.7
        self.questions.append((f"{name} {arguments[1]}", round(height, 3)))
        self.absent.append({"milk", "Tea"} - set(scene.bodies))
        return self._answer(height, name)


class Still:
    """The judge's world: bodies where they are, milk at the start and tea at the place `p`."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.at = {
            **{name: body.pose for name, body in scene.bodies.items()},
            "milk": Pose(PLACES["milk_start"]), "Tea": Pose(PLACES["p"]),
        }  # fmt: skip

    def pose(self, name: str) -> Array:
        return self.at[name].matrix


def stood(*rows: str) -> tuple[Fact, ...]:
    return tuple(("stood", *row.split()) for row in rows)


@pytest.fixture
def judged(root: Path, tmp_path: Path) -> Callable[..., Any]:
    """Asks a classifier of `upright` in a state; what is known of it and what was logged."""
    domain_file = write_domain(root, tmp_path, SAMPLED)
    domain = parse_domain(domain_file.read_text(), domain_file)
    streams_file = tmp_path / "mine.streams.pddl"
    streams = parse_streams(streams_file.read_text(), domain, streams_file)
    relation = relation_of(streams, domain, "upright")
    assert relation is not None
    scene = load_scene(write_problem(tmp_path, "(upright milk shelf)")).scene

    def judge(
        answer: Answer,
        state: Sequence[Fact] = (),
        *,
        initial: Sequence[Fact] = (),
        certified: Sequence[Fact] = (),
        in_hand: str | None = None,
        at: str = "milk milk_start, tea p",
        times: int = 1,
    ) -> tuple[State, Asked, ObservedRelations, ViolationLog]:
        asked, log = Asked(answer), ViolationLog()
        plan = PlanFile(
            None, (), "panda_mobile",
            {"milk": ("movable",), "tea": ("movable",), "table": ("surface",)},
            tuple(initial), "", {name: Value("pose", Pose(at).matrix) for name, at in PLACES.items()},
            (), tuple(certified), 0.0, 0.0,
        )  # fmt: skip
        given = {"upright": (relation, asked)}
        found = ObservedRelations(plan, Still(scene), domain, given, log)  # type: ignore[arg-type]
        now = [("at-pose", *pair.split()) for pair in at.split(", ") if at]
        for _ in range(times):
            held = frozenset() if in_hand is None else frozenset({in_hand})
            seen = found.observed(State.of([*state, *now]), held)
        return seen, asked, found, log

    return judge


def test_bodies_are_asked_of_where_they_are(judged: Callable[..., Any]) -> None:
    """The tea, 0.3 m up, is not upright; the milk, 0.1 m up, is, whatever the plan says."""
    state, asked, relations, log = judged(
        lambda height, body: height < 0.2, stood("tea p table"), certified=stood("tea p table")
    )
    assert state.all("stood") == [("milk", "milk_start", "table")]
    assert Counter(asked.questions) == {("milk table", 0.1): 1, ("Tea table", 0.3): 1}
    assert relations.answers == {"upright": 2} and relations.silent == {}
    (violation,) = log.violations
    assert violation.kind == "certified" and violation.bodies == ("tea",)
    assert "(stood tea p table) does not hold: the classifier of 'upright'" in violation.message


def test_poses_of_the_plan_elsewhere_are_asked_of_as_if_the_body_were_there(
    judged: Callable[..., Any],
) -> None:
    certified = (("pose", "milk", "p"), *stood("milk p table"))
    _, asked, _, log = judged(lambda height, body: height < 0.2, certified=certified)
    assert ("milk table", 0.3) in asked.questions
    assert [one.bodies for one in log.violations] == [("milk",)]


def test_a_pose_elsewhere_is_asked_of_once_and_one_here_in_each_state(
    judged: Callable[..., Any],
) -> None:
    _, asked, relations, log = judged(
        lambda height, body: 0.0, certified=(("pose", "milk", "p"), *stood("milk p table")), times=3
    )
    assert Counter(asked.questions) == {
        ("milk table", 0.1): 3,
        ("milk table", 0.3): 1,
        ("Tea table", 0.3): 3,
    }
    assert relations.answers["upright"] == 7
    assert len(log.violations) == 1  # told once


def test_poses_that_only_the_relation_names_are_poses_too(judged: Callable[..., Any]) -> None:
    _, asked, _, log = judged(lambda height, body: 0.0, initial=stood("milk tea_start table"))
    assert Counter(asked.questions)["milk table", 0.1] == 2
    assert [one.kind for one in log.violations] == ["initial"]


def test_the_body_in_the_hand_is_not_in_the_scene_but_where_the_plan_puts_it(
    judged: Callable[..., Any],
) -> None:
    _, asked, _, _ = judged(
        lambda height, body: 1.0, at="milk milk_start", certified=(("pose", "tea", "p"),),
        in_hand="Tea",
    )  # fmt: skip
    heard = dict(zip((words for words, _ in asked.questions), asked.absent, strict=True))
    assert heard == {"milk table": {"Tea"}, "Tea table": set()}


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        (lambda height, body: math.nan, "it cannot tell of (upright milk table)"),
        (lambda height, body: 7.0, "asked of (upright milk table), it returned 7"),
        (lambda height, body: 1 // 0, "asked of (upright milk table), it raised ZeroDivision"),
    ],
)
def test_where_it_cannot_tell_the_plans_word_stands(
    answer: Answer, words: str, judged: Callable[..., Any]
) -> None:
    facts = stood("milk milk_start table")
    state, _, relations, log = judged(answer, facts, certified=facts)
    assert state.all("stood") == [facts[0][1:]]
    assert relations.answers == {} and log.violations == []
    assert words in relations.silent["upright"]


@pytest.mark.parametrize(("number", "holds"), [(0.5, True), (0.499, False)])
def test_it_holds_from_one_half_on(number: float, holds: bool, judged: Callable[..., Any]) -> None:
    state, _, _, _ = judged(lambda height, body: number)
    assert bool(state.all("stood")) is holds


def test_what_the_plan_does_not_state_is_denied_in_silence(judged: Callable[..., Any]) -> None:
    _, _, _, log = judged(lambda height, body: 0.0, stood("milk milk_start table"))
    assert log.violations == []


def test_other_facts_stay_and_values_that_are_no_poses_are_left_out(
    judged: Callable[..., Any],
) -> None:
    other = ("holding", "tea", "g")
    state, asked, _, _ = judged(
        lambda height, body: 1.0, [other], certified=(("pose", "milk", "nowhere"),)
    )
    assert other in state and ("at-pose", "tea", "p") in state
    assert len(asked.questions) == 2


def test_without_classifiers_the_state_is_as_it_was(root: Path, tmp_path: Path) -> None:
    domain_file = write_domain(root, tmp_path, SAMPLED)
    plan = PlanFile(None, (), "r", {}, (), "", {}, (), (), 0.0, 0.0)
    domain = parse_domain(domain_file.read_text(), domain_file)
    state = State.of([("hand-empty",)])
    assert (
        ObservedRelations(plan, None, domain, {}, ViolationLog()).observed(state, frozenset())
        is state
    )  # type: ignore[arg-type]
