"""Planning from a scene that is seen, with a body in the hand."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import pytest

from tamp.execution.deviation import Deviation
from tamp.execution.expected import Expected
from tamp.execution.observation import ObservedScene
from tamp.execution.replan import Replanner
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.values import Grasp
from tamp.plan.open import Stored
from tamp.plan.read import Hold
from tamp.planner.problem import load_problem
from tamp.planner.solve import solve
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import Atom, Exists, Formula, Not, Parameter
from tamp.system.files import find_domain


def expectation(stored: Stored) -> Expected:
    file = find_domain("cupboard")
    return Expected(
        stored.plan, parse_domain(file.read_text(encoding="utf-8"), file), stored.loaded.scene
    )


GOAL = Atom("on", ("can", "left"))


def moved(scene: Scene, name: str, x: float, y: float) -> Scene:
    body = scene.bodies[name]
    at = body.pose.position
    pose = Pose((at[0] + x, at[1] + y, at[2]), body.pose.quaternion)
    return replace(scene, bodies=MappingProxyType({**scene.bodies, name: replace(body, pose=pose)}))


def held(stored: Stored) -> Grasp:
    hold = next(value.data for value in stored.plan.values.values() if isinstance(value.data, Hold))
    return Grasp("Can", Pose.from_matrix(hold.T_tool_body), hold.opening)


def test_what_is_in_the_hand_is_not_picked_again(stored: Stored) -> None:
    problem = load_problem(stored.loaded.path, holding=held(stored), scene=stored.loaded.scene)
    facts = problem.stream_task.task.initial
    assert ("hand-empty",) not in facts and ("holding", "can", "can_held") in facts
    assert not any(fact[:2] == ("at-pose", "can") for fact in facts)
    solution = solve(problem, seed=0)
    assert [action.name for action in solution.plan] == ["move", "place"]
    first = solution.plan[0].trajectory.segments[0]
    assert first.holding == "Can"


@pytest.mark.parametrize(
    ("name", "x", "y", "keeps"),
    [("block", 0.05, -0.05, True), ("Can", 0.002, 0.0, True), ("Can", 0.06, 0.0, False)],
    ids=["out of the way", "where the hand closes", "elsewhere"],
)
def test_the_rest_is_kept_when_it_still_holds(
    stored: Stored, name: str, x: float, y: float, keeps: bool
) -> None:
    expected = expectation(stored)
    scene = moved(stored.loaded.scene, name, x, y)
    truth = ObservedScene(scene, expected.facts, {})
    found = [Deviation("displaced", name, "it moved")]
    mended = Replanner(stored).replan(
        truth, None, stored.plan, stored.plan.actions, found, expected, GOAL
    )
    assert mended.keeps is keeps
    assert (mended.plan is not None) is not keeps, mended.explanation
    if mended.plan is not None:
        assert mended.plan.actions[-1].name == "place"


def test_a_body_where_another_one_should_go_is_in_the_way(stored: Stored) -> None:
    expected, scene = expectation(stored), stored.loaded.scene
    for action in stored.plan.actions:
        expected.apply(action)
    where, block = expected.poses["Can"], scene.bodies["block"].pose.position
    scene = moved(scene, "block", float(where[0, 3]) - block[0], float(where[1, 3]) - block[1])
    found = [Deviation("displaced", "block", "it moved")]
    first = expectation(stored)
    mended = Replanner(stored).replan(
        ObservedScene(scene, frozenset(), {}),
        None,
        stored.plan,
        stored.plan.actions,
        found,
        first,
        GOAL,
    )
    assert not mended.keeps and mended.plan is not None, mended.explanation


def gone(stored: Stored, name: str, goal: Formula) -> tuple[str, ...]:
    """What is said when a body has gone."""
    scene = stored.loaded.scene
    bodies = {other: body for other, body in scene.bodies.items() if other != name}
    truth = ObservedScene(replace(scene, bodies=MappingProxyType(bodies)), frozenset(), {})
    return (
        Replanner(stored)
        .replan(
            truth, None, stored.plan, stored.plan.actions, [Deviation("gone", name, "it is gone")],
            expectation(stored), goal,
        )
        .explanation
    )  # fmt: skip


def test_what_the_goal_names_and_is_gone_is_missed(stored: Stored) -> None:
    """The goal as a formula says what it names; a predicate may be called like a body."""
    missed = ("Can is gone, and the goal needs it",)
    assert gone(stored, "Can", GOAL) == missed
    assert gone(stored, "Can", Not(Exists((Parameter("?x"),), GOAL))) == missed
    assert gone(stored, "Can", Atom("can", ("block",))) != missed


def test_what_is_accepted_is_expected_until_the_plan_moves_it(stored: Stored) -> None:
    expected = expectation(stored)
    elsewhere = Pose((1.0, 2.0, 3.0)).matrix
    expected.accept({"Can": elsewhere})
    assert expected.poses["Can"] is elsewhere
    for action in stored.plan.actions:
        expected.apply(action)
        if action.name == "pick":
            assert (
                "Can" not in expected.poses
                and expected.held is not None
                and expected.held[0] == "Can"
            )
    assert expected.held is None
    assert expected.poses["Can"][2, 3] < 1.0
    assert ("on", "can", "left") in expected.facts and ("on", "block", "right") in expected.facts
