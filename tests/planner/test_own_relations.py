"""A relation of one's own means the same everywhere: at the start, under `not` and `forall`, in conditions, rules."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import tamp
from tamp.commands import solve as cli
from tamp.geometric.samplers.python_file import python_grounding
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.symbolic.pddl.relations import relation_names, relation_of
from tamp.verification.verify import verify
from tests.own import PYTHON, SAMPLED, TESTED, Proposing, write_domain, write_problem


@pytest.fixture
def upright(tmp_path: Path) -> Any:
    """The classifier and generator in Python."""
    (tmp_path / "upright.py").write_text(PYTHON)
    return python_grounding(tmp_path / "upright.py")


def planned(
    folder: Path, goal: str, grounding: object, algorithm: str = "adaptive"
) -> tamp.Solution:
    problem = tamp.load_problem(write_problem(folder, goal), groundings={"upright": grounding})  # type: ignore[dict-item]
    return tamp.solve(problem, max_time=60.0, seed=0, algorithm=algorithm)


def names(solution: tamp.Solution) -> list[str]:
    return [action.name for action in solution.plan]


@pytest.mark.parametrize("streams", [SAMPLED, TESTED], ids=["no test", "test"])
@pytest.mark.parametrize(
    ("goal", "actions"),
    [
        ("(upright tea table)", []),
        ("(not (upright milk table))", []),
        ("(not (upright tea shelf))", []),
        ("(and (upright tea table) (not (upright milk table)))", []),
        ("(forall (?o - movable) (not (upright ?o shelf)))", []),
        ("(exists (?s - surface) (upright tea ?s))", []),
        ("(or (upright milk table) (not (upright milk shelf)))", []),
        ("(untidy table)", []),
        ("(not (untidy shelf))", []),
        ("(drunk tea)", ["drink"]),
        ("(mopped milk)", ["mop"]),
        ("(mopped tea)", ["mop"]),  # it stands not on the shelf
        ("(praised tea)", ["look"]),
        ("(and (looked) (not (praised milk)))", ["look"]),
        ("(not (upright tea table))", ["move", "pick"]),
        ("(upright milk table)", ["move", "pick", "move", "place"]),
        ("(forall (?o - movable) (upright ?o table))", ["move", "pick", "move", "place"]),
        ("(not (untidy table))", ["move", "pick"]),
    ],
)
def test_the_classifier_decides(
    root: Path, tmp_path: Path, upright: Any, streams: str, goal: str, actions: list[str]
) -> None:
    """What holds already is not done again, what does not is, and the judge says the same with the classifier."""
    write_domain(root, tmp_path, streams)
    solution = planned(tmp_path, goal, upright)
    assert solution.solved and names(solution) == actions, solution.explanation
    plan = tamp.write_plan(solution, tmp_path / "plan.json")
    report = verify(plan, classifiers={"upright": upright})
    assert report.holds and report.checked and report.asked["upright"] > 0, report.text()
    alone = verify(plan)
    assert alone.holds and alone.on_trust == ("upright",) and not alone.checked
    assert "plan.json holds, on trust: upright: " in alone.text()


def test_what_is_made_upright_is_drunk(root: Path, tmp_path: Path, upright: Any) -> None:
    write_domain(root, tmp_path, SAMPLED)
    solution = planned(tmp_path, "(drunk milk)", upright)
    assert names(solution) == ["move", "pick", "move", "place", "drink"], solution.explanation
    report = verify(
        tamp.write_plan(solution, tmp_path / "plan.json"), classifiers={"upright": upright}
    )
    assert report.holds and report.checked, report.text()


@pytest.mark.parametrize("algorithm", ["adaptive", "incremental"])
def test_a_pose_of_any_origin_is_asked_about(
    root: Path, tmp_path: Path, upright: Any, algorithm: str
) -> None:
    """Put down again, the tea must not stand on the table; nearly all that sample-on proposes there would."""
    write_domain(root, tmp_path, TESTED)
    solution = planned(
        tmp_path, "(and (on tea table) (not (upright tea table)))", upright, algorithm
    )
    assert solution.solved, solution.explanation
    report = verify(
        tamp.write_plan(solution, tmp_path / "plan.json"), classifiers={"upright": upright}
    )
    assert report.holds and report.checked, report.text()


def test_complements_stay_out_of_the_plan_file(root: Path, tmp_path: Path, upright: Any) -> None:
    write_domain(root, tmp_path, TESTED)
    solution = planned(tmp_path, "(not (upright milk table))", upright)
    assert solution.problem.complements == {"not-stood"}
    text = tamp.write_plan(solution, tmp_path / "plan.json").read_text()
    assert "not-stood" not in text and '"stood",' in text


@pytest.mark.parametrize(
    ("goal", "line"),
    [
        (
            "(not (upright tea table))",
            r"mine\.yaml:10:12: whether \(upright tea table\) does not hold has to be known",
        ),
        ("(imply (on tea table) (looked))", None),
        ("(untidy table)", r"mine\.yaml:10:7: whether \(untidy table\)"),
        (
            "(forall (?o - movable) (not (upright ?o shelf)))",
            r"mine\.yaml:10:\d+: whether \(upright \?o shelf\)",
        ),
        ("(upright milk shelf)", None),
    ],
)
def test_what_is_unknown_may_be_made_true_and_not_taken_to_be_false(
    root: Path, tmp_path: Path, upright: Any, goal: str, line: str | None
) -> None:
    write_domain(
        root,
        tmp_path,
        SAMPLED,
        actions="  (:action look :parameters () :precondition () :effect (looked))\n",
    )
    if line is None:
        solution = planned(tmp_path, goal, Proposing(upright))
        assert solution.solved and solution.plan
        return
    with pytest.raises(tamp.InputError, match=line) as refused:
        planned(tmp_path, goal, Proposing(upright))
    assert (
        "'upright' is unknown until a plan makes it true: it has no classifier"
        in refused.value.message
    )
    assert "--sampler upright=FILE" in str(refused.value)


def test_an_action_that_needs_it_to_be_false_is_refused_with_its_place(
    root: Path, tmp_path: Path, upright: Any
) -> None:
    write_domain(root, tmp_path, SAMPLED)
    with pytest.raises(
        tamp.InputError, match=r"mine\.pddl:\d+:\d+: whether \(upright \?o \?s\) does not hold"
    ):
        planned(tmp_path, "(upright milk shelf)", Proposing(upright))


class Odd:
    """A classifier that answers in its own way; it proposes nothing."""

    def __init__(self, answer: Any) -> None:
        self.answer = answer

    def classify(self, scene: tamp.Scene, arguments: Sequence[str]) -> Any:
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer(arguments) if callable(self.answer) else self.answer

    def propose(
        self, scene: tamp.Scene, arguments: Sequence[str], count: int, rng: Any
    ) -> list[tamp.Pose]:
        return []


@pytest.mark.parametrize("answer", [ValueError("no idea"), "yes", 2.0, None, float("inf")])
def test_a_classifier_that_answers_nothing_is_refused(
    root: Path, tmp_path: Path, answer: Any
) -> None:
    write_domain(root, tmp_path, TESTED)
    with pytest.raises(
        tamp.InputError, match=r"classifier of 'upright' does not work: asked of \(upright "
    ):
        planned(tmp_path, "(upright tea table)", Odd(answer))


def test_what_it_cannot_tell_is_neither_true_nor_false(root: Path, tmp_path: Path) -> None:
    write_domain(root, tmp_path, TESTED)
    for goal in ("(upright tea table)", "(not (upright tea table))"):
        problem = tamp.load_problem(
            write_problem(tmp_path, goal), groundings={"upright": Odd(float("nan"))}
        )
        facts = {fact[0] for fact in problem.stream_task.task.initial}
        assert not facts & {"stood", "not-stood"}
    some = Odd(lambda arguments: 1.0 if arguments[0] == "Tea" else 1 / 0)
    problem = tamp.load_problem(
        write_problem(tmp_path, "(upright tea table)"), groundings={"upright": some}
    )
    assert any("(upright milk" in text and "ZeroDivisionError" in text for text in problem.warnings)
    assert tamp.solve(problem, seed=0).solved


def test_one_that_does_not_look_at_the_place_is_warned_of(root: Path, tmp_path: Path) -> None:
    write_domain(root, tmp_path, TESTED)
    problem = tamp.load_problem(
        write_problem(tmp_path, "(upright tea shelf)"), groundings={"upright": Odd(1.0)}
    )
    assert any("whatever its second argument is" in text for text in problem.warnings)


def test_it_is_not_asked_where_nothing_depends_on_it(root: Path, tmp_path: Path) -> None:
    write_domain(root, tmp_path, TESTED, actions="")
    problem = tamp.load_problem(
        write_problem(tmp_path, "(on tea shelf)"), groundings={"upright": Odd(ValueError())}
    )
    assert not problem.classifiers and not problem.complements


def test_one_of_no_stream_is_warned_of(root: Path, tmp_path: Path, upright: Any) -> None:
    problem = tamp.load_problem("one_object", groundings={"upright": upright})
    assert any("the grounding of 'upright' is not used" in text for text in problem.warnings)


class Lonely:
    """On the shelf, and nothing else is within 25 cm: it looks at more than it is asked about.

    Args:
        wide: Metres along the shelf, each way, within which it proposes.
    """

    def __init__(self, wide: float) -> None:
        self.wide = wide

    def classify(self, scene: tamp.Scene, arguments: Sequence[str]) -> float:
        at = {
            name: np.array(body.pose.position)
            for name, body in scene.bodies.items()
            if body.movable
        }
        here = at.pop(arguments[0])
        there = arguments[1] == "shelf" and here[0] < 0.0
        return float(there and all(np.linalg.norm(here - other) > 0.25 for other in at.values()))

    def propose(
        self, scene: tamp.Scene, arguments: Sequence[str], count: int, rng: Any
    ) -> list[tamp.Pose]:
        x, y, z = scene.world_pose(scene.surfaces["shelf"]).position
        return [tamp.Pose((x, y + dy, z + 0.1)) for dy in rng.uniform(-self.wide, self.wide, count)]


def test_a_plan_that_the_classifier_does_not_bear_out_is_none(root: Path, tmp_path: Path) -> None:
    """Each pose on the shelf was lonely while the other body stood on the table; together they must be, too."""
    write_domain(root, tmp_path, TESTED, actions="")
    solution = planned(tmp_path, "(and (upright milk shelf) (upright tea shelf))", Lonely(0.3))
    assert solution.solved and len(solution.plan) == 8
    report = verify(
        tamp.write_plan(solution, tmp_path / "plan.json"), classifiers={"upright": Lonely(0.3)}
    )
    assert report.holds and report.checked, report.text()
    solution = planned(tmp_path, "(and (upright milk shelf) (upright tea shelf))", Lonely(0.12))
    assert solution.outcome is tamp.Outcome.EXHAUSTED and not solution.plan
    assert (
        "the classifier of 'upright' looks at bodies that it is not asked about"
        in solution.explanation[0]
    )


class Alone:
    """A classifier without a generator, of a body alone."""

    def classify(self, scene: tamp.Scene, arguments: Sequence[str]) -> float:
        (body,) = arguments
        return float(scene.bodies[body].pose.matrix[2, 2] > 0.99)


def test_a_classifier_alone_of_a_body_alone(root: Path, tmp_path: Path) -> None:
    """`(upright ?o)`, tested at poses that `sample-on` proposes."""
    write_domain(root, tmp_path, SAMPLED, actions="")
    domain, streams = tmp_path / "mine.pddl", tmp_path / "mine.streams.pddl"
    text = domain.read_text().replace(
        "(stood ?o - movable ?p - pose ?s - surface)", "(stood ?o - movable ?p - pose)"
    )
    text = text.replace("(upright ?o - movable ?s - surface)", "(upright ?o - movable)").replace(
        "(upright ?o ?s)", "(upright ?o)"
    )
    domain.write_text(text.replace("(stood ?o ?p ?s)", "(stood ?o ?p)"))
    test = (
        "  (:stream test-upright :inputs (?o ?p) :domain (pose ?o ?p) :certified (stood ?o ?p))\n"
    )
    streams.write_text(streams.read_text().replace(SAMPLED, test))
    for goal, count in (
        ("(upright tea)", 0),
        ("(not (upright milk))", 0),
        ("(not (upright tea))", 2),
        ("(upright milk)", 4),
    ):
        solution = planned(tmp_path, goal, Alone())
        assert solution.solved and len(solution.plan) == count, (
            goal,
            names(solution),
            solution.explanation,
        )
        report = verify(
            tamp.write_plan(solution, tmp_path / "plan.json"), classifiers={"upright": Alone()}
        )
        assert report.holds and report.checked, report.text()


DOMAIN = """(define (domain d) (:types movable - body surface - object pose - object)
  (:predicates (pose ?o - movable ?p - pose) (at-pose ?o - movable ?p - pose)
    (tall ?o - movable) (tall-at ?o - movable ?p - pose)
    (close ?o ?p ?o2 ?p2) (beside ?o - movable ?p - pose ?b - body) (among ?o ?p ?o2 ?p2 ?o3 ?p3)))
"""


@pytest.mark.parametrize(
    ("stream", "arguments", "poses"),
    [
        ("(:stream test-r :inputs (?o) :domain (movable ?o) :certified (tall ?o))", ("?o",), {}),
        (
            "(:stream test-r :inputs (?o ?p) :domain (pose ?o ?p) :certified (tall-at ?o ?p))",
            ("?o",),
            {"?p": "?o"},
        ),
        (
            "(:stream test-r :inputs (?o ?p ?o2 ?p2) :domain (and (pose ?o ?p) (pose ?o2 ?p2))"
            " :certified (close ?o ?p ?o2 ?p2))",
            ("?o", "?o2"),
            {"?p": "?o", "?p2": "?o2"},
        ),
        (
            "(:stream sample-r :inputs (?o ?b) :domain (and (movable ?o) (body ?b)) :outputs (?p)"
            " :certified (and (pose ?o ?p) (beside ?o ?p ?b)))",
            ("?o", "?b"),
            {"?p": "?o"},
        ),
        (
            "(:stream test-r :inputs (?o ?p ?o2 ?p2 ?o3 ?p3) :domain (and (pose ?o ?p) (pose ?o2 ?p2) (pose ?o3 ?p3))"
            " :certified (among ?o ?p ?o2 ?p2 ?o3 ?p3))",
            ("?o", "?o2", "?o3"),
            {"?p": "?o", "?p2": "?o2", "?p3": "?o3"},
        ),
    ],
    ids=["a body", "a body and its pose", "two bodies", "a fixed body", "three"],
)
def test_what_a_relation_is_asked_of(
    stream: str, arguments: tuple[str, ...], poses: dict[str, str]
) -> None:
    domain = parse_domain(DOMAIN)
    streams = parse_streams(f"(define (stream d) {stream})", domain)
    assert relation_names(streams) == ("r",)
    relation = relation_of(streams, domain, "r")
    assert relation is not None and (relation.arguments, dict(relation.poses)) == (arguments, poses)


def test_two_bodies(root: Path, tmp_path: Path) -> None:
    """The kitchen's `near`: its bodies are near each other at the start, or must not be."""
    kitchen = root / "examples/kitchen"
    near = python_grounding(kitchen / "near.py")
    text = (kitchen / "kitchen.yaml").read_text().replace("domain: kitchen.pddl\n", "")
    text = text.replace("on: sideboard, at: [0.2, -0.1]", "on: table, at: [0.2, 0.05]")
    for goal, count in (
        ("(near can mug)", 0),
        ("(not (near can milk))", 0),
        ("(not (near can mug))", 2),
    ):
        (tmp_path / "two.yaml").write_text(
            text.replace("(and (lying milk sideboard) (near can mug))", goal)
        )
        problem = tamp.load_problem(
            tmp_path / "two.yaml",
            kitchen / "kitchen.pddl",
            groundings={"near": near, "lying": Proposing(near)},
        )
        solution = tamp.solve(problem, max_time=60.0, seed=0)
        assert solution.solved and len(solution.plan) == count, (
            goal,
            names(solution),
            solution.explanation,
        )
        report = verify(
            tamp.write_plan(solution, tmp_path / "two.json"), classifiers={"near": near}
        )
        assert report.holds and report.checked, report.text()


def test_from_the_command_line(
    root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    write_domain(root, tmp_path, TESTED)
    (tmp_path / "upright.py").write_text(PYTHON)
    write_problem(tmp_path, "(not (upright milk table))")
    line = ["mine.yaml", "--sampler", "upright=upright.py", "--verify", "--execute"]
    assert cli.run(line) == cli.SOLVED
    said = capsys.readouterr().out
    assert "the goal holds at the start" in said
    assert "the plan holds: 0 actions" in said and "upright asked" in said
    assert "(not (upright milk table)) holds   upright.py says 0.00" in said
    write_domain(root, tmp_path, SAMPLED)
    (tmp_path / "upright.py").write_text(PYTHON.replace("def classify", "def judge"))
    assert cli.run(line) == cli.BAD_INPUT
    assert "is unknown until a plan makes it true: it has no classifier" in capsys.readouterr().err
