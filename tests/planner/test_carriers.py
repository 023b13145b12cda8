"""Bodies that carry: towers, packing, trays; planned, judged, spoilt, and refused."""

from __future__ import annotations

import copy
import json
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.plan.write import plan_text
from tamp.planner.problem import Problem, load_problem
from tamp.planner.solve import solve
from tamp.symbolic.algorithms.result import Outcome
from tamp.system.files import shipped
from tamp.verification.verify import verify

HEAD = """\
domain: carriers
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table:  {furniture: table, size: [1.2, 0.7, 0.6], at: [1.2, 0.0, 0.0], yaw: 90 deg}
"""
TOWER = """\
  base:   {box: [0.07, 0.12, 0.06], on: table, at: [0.1, 0.0]}
  cube:   {box: [0.06, 0.06, 0.06], on: table, at: [-0.2, 0.1]}
  tiny:   {box: [0.018, 0.018, 0.05], on: table, at: [-0.3, -0.1]}
  can:    {cylinder: {radius: 0.03, height: 0.07}, on: base}
"""


@pytest.fixture
def problem_of(tmp_path: Path) -> Callable[..., Problem]:
    """Loads a problem of these bodies and this goal."""

    def make(goal: str, bodies: str = TOWER, head: str = HEAD) -> Problem:
        file = tmp_path / "own.yaml"
        file.write_text(f"{head}{bodies}goal: {goal}\n")
        return load_problem(file)

    return make


def solved(problem: Problem, seed: int = 0) -> dict[str, Any]:
    solution = solve(problem, max_time=30.0, seed=seed)
    assert solution.outcome is Outcome.SOLVED, solution.explanation
    document = json.loads(plan_text(solution))
    report = verify(document)
    assert report.holds, report.text()
    assert not report.on_trust
    return document


@pytest.fixture(scope="module")
def tray() -> dict[str, Any]:
    """The plan of problems/tray.yaml."""
    return solved(load_problem("tray"))


@pytest.fixture(scope="module")
def tower(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """A cube onto a base from which a can must be taken first."""
    file = tmp_path_factory.mktemp("tower") / "own.yaml"
    file.write_text(f"{HEAD}{TOWER}goal: (and (on cube base) (not (on can base)))\n")
    return solved(load_problem(file))


def steps(document: dict[str, Any]) -> list[str]:
    return [
        f"{action['name']} {action['arguments'][0]}"
        for action in document["actions"]
        if action["name"] != "move"
    ]


def violations(document: dict[str, Any]) -> str:
    report = verify(document)
    assert not report.holds
    return report.text()


def test_what_is_on_a_body_is_unloaded_before_it_is_carried(
    problem_of: Callable[..., Problem],
) -> None:
    shelf = (
        "  bench:  {furniture: table, size: [0.8, 0.5, 0.5], at: [-1.2, 0.0, 0.0], yaw: 90 deg}\n"
    )
    done = steps(solved(problem_of("(on base bench)", TOWER + shelf)))
    assert done.index("pick can") < done.index("place can") < done.index("pick base")


def test_a_tower_is_built_from_below_wherever_its_base_goes(
    problem_of: Callable[..., Problem],
) -> None:
    bodies = (
        TOWER
        + "  bench:  {furniture: table, size: [0.8, 0.5, 0.5], at: [-1.2, 0.0, 0.0], yaw: 90 deg}\n"
    )
    document = solved(problem_of("(and (on base bench) (on cube base) (on can cube))", bodies))
    last = {words: number for number, words in enumerate(steps(document))}
    assert last["place base"] < last["place-on cube"] < last["place-on can"]


def test_a_tray_is_carried_with_what_stands_on_it(tray: dict[str, Any]) -> None:
    picks = [action for action in tray["actions"] if action["name"] == "pick"]
    assert [action["arguments"][0] for action in picks] == ["tray"]
    load = picks[0]["segments"][1]["attach"]["load"]
    assert {one["body"] for one in load} == {"cup", "mug", "glass"}


def test_a_tilted_tray_is_rejected(tray: dict[str, Any]) -> None:
    spoilt = copy.deepcopy(tray)
    carried = [
        segment
        for action in spoilt["actions"]
        for segment in action["segments"]
        if segment["part"] == "arm" and segment.get("holding") == "tray"
    ]
    for segment in carried:
        shares = np.sin(np.linspace(0.0, np.pi, len(segment["positions"])))
        for row, share in zip(segment["positions"], shares, strict=True):
            row[5] += 0.5 * share
    assert re.search(r"tray leans by \d+", violations(spoilt))


def test_what_is_left_behind_is_found(tray: dict[str, Any]) -> None:
    spoilt = copy.deepcopy(tray)
    gone = [
        a
        for a in spoilt["actions"]
        if a["name"] in ("ride", "alight") and a["arguments"][0] == "cup"
    ]
    assert len(gone) == 2
    spoilt["actions"] = [action for action in spoilt["actions"] if action not in gone]
    said = violations(spoilt)
    assert "cup does not stand" in said
    assert "loaded" in said

    spoilt = copy.deepcopy(tray)
    (attach,) = (
        segment["attach"]
        for action in spoilt["actions"]
        for segment in action["segments"]
        if segment.get("attach")
    )
    attach["load"] = [one for one in attach["load"] if one["body"] != "cup"]
    assert "by the facts cup and glass and mug rides on it" in violations(spoilt)
    attach["load"].append(
        {"body": "cup", "T_body_rider": {"position": [0.0, 0.0, 0.5], "quaternion": [0, 0, 0, 1]}}
    )
    assert "from where the plan has it on tray" in violations(spoilt)


def test_where_a_rider_gets_to_is_worked_out_again(tray: dict[str, Any]) -> None:
    spoilt = copy.deepcopy(tray)
    (alights,) = (
        a for a in spoilt["actions"] if a["name"] == "alight" and a["arguments"][0] == "cup"
    )
    spoilt["values"][alights["arguments"][-1]]["position"][0] += 0.02
    assert "carried along it would be" in violations(spoilt)


def test_a_body_is_not_taken_from_under_another(tower: dict[str, Any]) -> None:
    assert steps(tower).index("pick can") < steps(tower).index("place-on cube")
    spoilt = copy.deepcopy(tower)
    for fact in [
        fact
        for fact in spoilt["initial"]
        if fact[0] in ("borne", "stacked", "rests-on") and fact[1] == "can"
    ]:
        spoilt["initial"].remove(fact)
    spoilt["initial"].append(["grounded", "can", "can_start"])
    assert "(grounded can can_start) does not hold: it rests on base" in violations(spoilt)


def test_a_removed_support_is_found(tower: dict[str, Any]) -> None:
    spoilt = copy.deepcopy(tower)
    (put,) = (action for action in spoilt["actions"] if action["name"] == "place-on")
    below = put["arguments"][-1]
    spoilt["values"][below]["position"][1] += 0.3
    assert "base" in violations(spoilt)


def test_only_places_of_fixed_bodies_are_anchored(tower: dict[str, Any]) -> None:
    spoilt = copy.deepcopy(tower)
    spoilt["initial"] += [["anchored", "base"], ["stackable", "cube", "table", "base"]]
    said = violations(spoilt)
    assert "(anchored base) does not hold: base may be moved" in said
    assert "table is no place of base" in said


def test_a_goal_in_a_circle_is_an_error(problem_of: Callable[..., Problem]) -> None:
    with pytest.raises(InputError, match="in a circle: base on cube on base") as caught:
        problem_of("(and (on base cube) (on cube base))")
    assert caught.value.line == 10


def test_a_support_that_is_too_small_is_the_reason(problem_of: Callable[..., Problem]) -> None:
    bodies = TOWER.replace("[0.018, 0.018, 0.05]", "[0.024, 0.024, 0.05]")
    solution = solve(problem_of("(on base tiny)", bodies), max_time=4.0, seed=0)
    assert solution.outcome is not Outcome.SOLVED
    assert any(
        "tiny is too small to carry base (2.4 x 2.4 cm)" in line for line in solution.explanation
    )
    with pytest.raises(
        InputError, match="'tiny' is a movable, not a surface"
    ):  # under 2 cm it is no place
        problem_of("(on base tiny)")


def test_the_cupboard_names_the_domain_that_can(problem_of: Callable[..., Problem]) -> None:
    with pytest.raises(InputError, match="In 'domain: carriers' movable bodies carry others"):
        problem_of("(on cube base)", head=HEAD.replace("carriers", "cupboard"))


def test_a_body_may_say_that_it_carries_nothing(problem_of: Callable[..., Problem]) -> None:
    bare = TOWER.replace("at: [0.1, 0.0]}", "at: [0.1, 0.0], surfaces: {}}")
    with pytest.raises(InputError, match="'base' is a movable, not a surface"):
        problem_of("(on cube base)", bare)


def test_pairs_are_those_that_the_goal_names(problem_of: Callable[..., Problem]) -> None:
    def pairs(goal: str) -> set[tuple[str, ...]]:
        facts = problem_of(goal).stream_task.task.initial
        return {fact[1:3] for fact in facts if fact[0] == "stackable"}

    assert pairs("(on cube base)") == {("cube", "base")}
    assert pairs("(on cube table)") == set()
    assert pairs("(exists (?o - movable) (on ?o base))") == {
        ("cube", "base"),
        ("tiny", "base"),
        ("can", "base"),
    }


class Beside:
    """Proposes places on the body below, one beside its middle."""

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: np.random.Generator
    ) -> list[Pose]:
        below = scene.bodies[arguments[1]].pose
        shifts = rng.uniform(-0.005, 0.005, size=(count, 2))
        return [below @ Pose((float(x), float(y), 0.0615)) for x, y in shifts]


def test_a_relation_of_ones_own_on_a_movable_body(tmp_path: Path) -> None:
    folder = shipped("domains")
    domain, streams = (
        (folder / f"carriers{end}").read_text() for end in (".pddl", ".streams.pddl")
    )
    domain = domain.replace(
        "    ; what follows\n",
        "    (crowns ?o - movable ?p - pose ?below - movable ?pb - pose)\n    ; what follows\n"
        "    (crowned ?o - movable ?below - movable)\n",
    ).replace(
        "  (:derived (loaded",
        "  (:derived (crowned ?o - movable ?below - movable) (exists (?p - pose ?pb - pose)\n"
        "    (and (crowns ?o ?p ?below ?pb) (at-pose ?o ?p) (at-pose ?below ?pb))))\n  (:derived (loaded",
    )
    streams = streams.rstrip()[:-1] + (
        "  (:stream sample-crowned :inputs (?o ?below ?pb)\n"
        "    :domain (and (stackable ?o ?below ?below) (pose ?below ?pb)) :fluents (at-pose) :outputs (?p)\n"
        "    :certified (and (pose ?o ?p) (sampled ?o ?p) (borne ?o ?p ?below ?pb) (crowns ?o ?p ?below ?pb))))\n"
    )
    (tmp_path / "own.pddl").write_text(domain)
    (tmp_path / "own.streams.pddl").write_text(streams)
    file = tmp_path / "own.yaml"
    file.write_text(f"{HEAD.replace('carriers', 'own.pddl')}{TOWER}goal: (crowned cube base)\n")

    solution = solve(load_problem(file, groundings={"crowned": Beside()}), max_time=30.0, seed=0)
    assert solution.outcome is Outcome.SOLVED, solution.explanation
    document = json.loads(plan_text(solution))
    assert steps(document)[-1] == "place-on cube"
    assert steps(document)[0] == "pick can"
    report = verify(document)
    assert report.holds, report.text()
