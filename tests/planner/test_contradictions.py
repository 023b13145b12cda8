"""A classifier that looks at other bodies may say otherwise in the plan's states than when asked."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Scene
from tamp.planner.contradictions import MAX_CONTRADICTIONS_TOLD, contradictions
from tamp.planner.problem import Problem
from tamp.symbolic.algorithms.bound_stream import Objects
from tamp.symbolic.algorithms.cause import CauseKind
from tamp.symbolic.algorithms.result import Outcome, PlanAction, Result, StreamTask
from tamp.symbolic.pddl.parser import parse_domain, parse_goal, parse_streams
from tamp.symbolic.pddl.relations import relation_of
from tamp.symbolic.pddl.structs import Fact, Task
from tests.geometric.making import body, scene, table

DOMAIN = parse_domain("""(define (domain d) (:requirements :typing :conditional-effects)
  (:types movable surface pose - object)
  (:predicates (pose ?o - movable ?p - pose) (at-pose ?o - movable ?p - pose) (mad)
    (lonely ?o - movable ?p - pose ?s - surface) (not-lonely ?o - movable ?p - pose ?s - surface))
  (:action move :parameters (?o - movable ?p ?p2 - pose)
    :precondition (at-pose ?o ?p) :effect (and (at-pose ?o ?p2) (not (at-pose ?o ?p))))
  (:action lift :parameters (?o - movable)
    :precondition () :effect (forall (?p - pose) (not (at-pose ?o ?p))))
  (:action stay :parameters (?o - movable ?p - pose)
    :precondition (at-pose ?o ?p) :effect (and (not (at-pose ?o ?p)) (at-pose ?o ?p)))
  (:action forget :parameters (?o - movable ?p - pose)
    :precondition () :effect (not (at-pose ?o ?p)))
  (:action hope :parameters (?o - movable ?p - pose)
    :precondition () :effect (when (mad) (at-pose ?o ?p))))""")
STREAMS = parse_streams(
    """(define (stream d) (:stream test-lonely
    :inputs (?o ?p ?s) :domain (and (pose ?o ?p) (surface ?s)) :certified (lonely ?o ?p ?s)))""",
    DOMAIN,
)
CUBE = Box((0.1, 0.1, 0.1))
PLACES = {"left": -0.3, "middle": 0.0, "right": 0.3, "near": 0.15}
OBJECTS = {
    "cup": ("movable",), "box": ("movable",), "table": ("surface",),
    **{name: ("pose",) for name in PLACES},
}  # fmt: skip
LONELY = {name: ("lonely", "cup", name, "table") for name in PLACES}
CROWDED = {name: ("not-lonely", "cup", name, "table") for name in PLACES}


class Lonely:
    """Whether no other body that moves is within 0.2 m; of the box it cannot tell."""

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        if arguments[0] != "Cup":
            return float("nan")
        (x, *_), others = scene.bodies["Cup"].pose.position, {*scene.movable} - {"Cup"}
        return float(all(abs(scene.bodies[one].pose.position[0] - x) > 0.2 for one in others))


def told(
    *actions: tuple[str, ...], certified: Sequence[Fact] = (), initial: Sequence[Fact] = ()
) -> list[str]:
    """What is said of a plan that begins with the cup on the left and the box on the right."""
    start = {("at-pose", "cup", "left"), ("at-pose", "box", "right"), *initial}
    poses = {name: Pose((x, 0.0, 0.551)) for name, x in PLACES.items()}
    made = scene(table(), body("Cup", CUBE, (-0.3, 0, 0.551)), body("box", CUBE, (0.3, 0, 0.551)))
    goal = parse_goal("(lonely cup left table)", DOMAIN, OBJECTS)
    task = Task("t", DOMAIN, OBJECTS, frozenset(start), goal, {})
    relation = relation_of(STREAMS, DOMAIN, "lonely")
    assert relation is not None
    problem = Problem(
        "t", made, SimpleNamespace(), StreamTask(task, (), poses), "", {}, {}, (),
        {"lonely": Lonely()}, {"lonely": relation}, frozenset({"not-lonely"}),
    )  # fmt: skip
    plan = tuple(PlanAction(name, words) for name, *words in actions)
    result = Result(Outcome.SOLVED, Objects(dict(OBJECTS), dict(poses)), plan, tuple(certified))

    causes = contradictions(problem, result)
    for cause in causes:
        assert cause.kind is CauseKind.CONTRADICTED and cause.objects == ("cup", "table")
        assert "(lonely cup table) is not what it was" in cause.text
    return [cause.text.partition(" (")[0] for cause in causes]


TO_RIGHT = ("move", "cup", "left", "near")


def test_a_fact_that_a_state_denies_is_told_with_the_state() -> None:
    come = ("move", "box", "right", "middle")
    assert told(TO_RIGHT, certified=[LONELY["near"]]) == ["after 1 actions"]
    assert told(TO_RIGHT, come, certified=[LONELY["near"]]) == [
        "after 1 actions",
        "after 2 actions",
    ]
    assert told(TO_RIGHT, certified=[LONELY["left"]]) == []  # the cup is there no more


def test_what_was_denied_and_holds_is_told_too() -> None:
    assert told(("stay", "cup", "left"), certified=[CROWDED["left"]]) == ["after 1 actions"]
    assert told(("stay", "cup", "left"), certified=[LONELY["left"]]) == []


def test_what_nobody_stated_is_nobodys_fault() -> None:
    assert told(TO_RIGHT) == []


def test_facts_of_the_start_count_in_the_last_state_only() -> None:
    """Nothing before asks for them: conditions are of what streams certified, or of the goal."""
    stated = [LONELY["near"]]
    assert told(TO_RIGHT, initial=stated) == ["after 1 actions"]
    assert told(TO_RIGHT, ("stay", "cup", "near"), initial=stated) == ["after 2 actions"]


def test_a_body_in_the_hand_is_in_nobodys_way() -> None:
    box = ("lift", "box")
    assert told(box, TO_RIGHT, certified=[LONELY["near"]]) == []
    assert told(TO_RIGHT, box, certified=[LONELY["near"]]) == ["after 1 actions"]


def test_who_is_said_to_be_gone_from_elsewhere_stays() -> None:
    gone, elsewhere = ("forget", "box", "right"), ("forget", "box", "middle")
    assert told(gone, TO_RIGHT, certified=[LONELY["near"]]) == []
    assert told(elsewhere, TO_RIGHT, certified=[LONELY["near"]]) == ["after 2 actions"]


def test_effects_on_a_condition_are_not_believed() -> None:
    assert told(("hope", "box", "left"), certified=[LONELY["left"]]) == []


def test_only_the_first_ones_are_told() -> None:
    stays = [("stay", "cup", "near")] * 4
    said = told(TO_RIGHT, *stays, certified=[LONELY["near"]])
    assert said == [f"after {number} actions" for number in range(1, MAX_CONTRADICTIONS_TOLD + 1)]


def test_without_a_plan_there_is_nothing_to_tell() -> None:
    assert told(certified=[LONELY["left"], CROWDED["left"]]) == []
