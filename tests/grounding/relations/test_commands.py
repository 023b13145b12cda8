"""tamp-learn new, ask, explore and evaluate of one's own relation, and the plan that uses it."""

from __future__ import annotations

import io
from pathlib import Path

import pytest

import tamp
from grounding.cli import BAD_INPUT, DONE, run
from grounding.registry import GROUNDINGS, file_grounding
from grounding.relations.demonstration_file import demonstrations_of
from tamp.errors import InputError
from tamp.plan.write import plan_document
from tamp.planner.report import summary
from tamp.verification.verify import verify
from tests.grounding.relations.shown import beside, write_demos

ROOM = """
domain: mine.pddl
robot: {{model: panda_mobile, base: [0.0, 0.0, 0 deg]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
samplers: {{left_of: left_of.safetensors}}
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: -90 deg}}
  sideboard: {{furniture: table, size: [0.9, 0.5, 0.6], at: [-1.6, 0.4, 0.0], yaw: 90 deg}}"""

PROBLEM = (
    ROOM
    + """
  plate: {{cylinder: {{radius: 0.08, height: 0.02}}, on: table, at: [0.1, -0.1]}}
  cup: {{cylinder: {{radius: 0.035, height: 0.1}}, on: {on}}}
goal: {goal}
"""
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Demonstrations, and what `tamp-learn new` makes of them."""
    folder = tmp_path_factory.mktemp("mine")
    write_demos(folder / "demos")
    words = ["--demos", str(folder / "demos"), "--out", str(folder / "left_of.safetensors")]
    assert run(["new", "left_of", *words, "--add-to", str(folder / "mine.pddl")]) == DONE
    return folder


def problem(folder: Path, goal: str, on: str = "sideboard, at: [0.2, -0.1]") -> tamp.Problem:
    path = folder / "problem.yaml"
    path.write_text(PROBLEM.format(goal=goal, on=on))
    return tamp.load_problem(path, registry=GROUNDINGS)


def test_a_relation_is_learned_shown_as_a_diff_and_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_demos(tmp_path / "demos", good=6, bad=6, height=0.72)
    words = [
        "new",
        "left_of",
        "--demos",
        str(tmp_path / "demos"),
        "--out",
        str(tmp_path / "w.safetensors"),
    ]
    assert run([*words, "--add-to", str(tmp_path / "mine.pddl"), "--dry-run"]) == DONE
    said = capsys.readouterr().out
    assert "12 demonstrations of left_of: it holds in 6, and does not in 6" in said
    assert "+    (left_of ?o - movable ?o2 - movable))" in said and "nothing written" in said
    assert "missing: all surfaces were 0.72 m high" in said and "held out, scene by scene" in said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["demos"]
    assert run(words) == DONE
    assert sorted(path.name for path in tmp_path.iterdir()) == ["demos", "w.json", "w.safetensors"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("goal", "on", "actions"),
    [
        ("(left_of cup plate)", "sideboard, at: [0.2, -0.1]", 4),
        ("(left_of cup plate)", "table, at: [-0.06, -0.1]", 0),
        ("(not (left_of cup plate))", "table, at: [-0.06, -0.1]", 2),
        ("(exists (?b - movable) (left_of ?b plate))", "sideboard, at: [0.2, -0.1]", 4),
    ],
)
def test_a_plan_makes_it_true_and_the_judge_agrees(
    folder: Path, goal: str, on: str, actions: int
) -> None:
    solution = tamp.solve(problem(folder, goal, on), max_time=60.0, seed=0)
    assert solution.solved and len(solution.plan) == actions
    relation = file_grounding("left_of", folder / "left_of.safetensors")
    verdict = verify(plan_document(solution), classifiers={"left_of": relation})
    assert verdict.holds, verdict
    if actions and not goal.startswith("(not"):
        assert "place  cup  left_of plate" in summary(solution)


CHAIN = (
    ROOM
    + """
  saucer: {{cylinder: {{radius: 0.038, height: 0.04}}, on: sideboard, at: [0.3, 0.0]}}
  cup: {{cylinder: {{radius: 0.035, height: 0.1}}, on: sideboard, at: [-0.3, 0.1]}}
  glass: {{cylinder: {{radius: 0.03, height: 0.12}}, on: table, at: [0.3, 0.0]}}
goal: {goal}
"""
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("goal", "moved"),
    [
        ("(and (left_of cup saucer) (left_of saucer glass))", {"cup", "saucer"}),
        ("(and (left_of cup glass) (on cup table))", {"cup"}),
        ("(and (left_of glass cup) (left_of cup saucer) (on saucer table))", None),
    ],
)
def test_a_chain_is_planned_body_by_body(folder: Path, goal: str, moved: set[str] | None) -> None:
    path = folder / "chain.yaml"
    path.write_text(CHAIN.format(goal=goal))
    solution = tamp.solve(tamp.load_problem(path, registry=GROUNDINGS), max_time=60.0, seed=0)
    assert solution.solved, solution.explanation
    document = plan_document(solution)
    relation = file_grounding("left_of", folder / "left_of.safetensors")
    verdict = verify(document, classifiers={"left_of": relation})
    assert verdict.holds and not verdict.on_trust, verdict.text()
    picked = {action.arguments[0] for action in solution.plan if action.name == "pick"}
    assert picked == (moved or picked)
    told = {fact[0] for fact in document["initial"]}
    assert not told & {"wanted-left_of", "also-left_of"}, "they are no part of the world"


@pytest.mark.slow
def test_both_ways_round_need_one_place_near_the_other(
    tmp_path: Path, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A body that another relation proposes is asked about wherever it is."""
    write_demos(tmp_path / "demos", way=beside)
    words = ["--demos", str(tmp_path / "demos"), "--out", str(tmp_path / "left_of.safetensors")]
    assert run(["new", "left_of", *words, "--add-to", str(tmp_path / "mine.pddl")]) == DONE
    path = tmp_path / "both.yaml"
    path.write_text(CHAIN.format(goal="(and (left_of cup glass) (left_of glass cup))"))
    solution = tamp.solve(tamp.load_problem(path, registry=GROUNDINGS), max_time=60.0, seed=0)
    assert solution.solved, solution.explanation


def test_a_relation_that_nothing_asks_for_needs_no_weights(folder: Path) -> None:
    path = folder / "other.yaml"
    text = CHAIN.format(goal="(on cup table)")
    path.write_text(text.replace("samplers: {left_of: left_of.safetensors}\n", ""))
    assert tamp.load_problem(path, registry=GROUNDINGS)
    path.write_text(path.read_text().replace("(on cup table)", "(not (left_of cup glass))"))
    with pytest.raises(InputError, match="stream 'sample-left_of' has no function"):
        tamp.load_problem(path, registry=GROUNDINGS)


def test_evaluation_judges_labels_and_drops_proposals(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_demos(folder / "others", seed=9, good=4, bad=4)
    words = [
        "--scenes",
        "6",
        "--demos",
        str(folder / "others"),
        "--pictures",
        str(folder / "pictures"),
    ]
    assert run(["evaluate", str(folder / "left_of.safetensors"), *words]) == DONE
    said = capsys.readouterr().out
    assert "of 4 demonstrations of what holds" in said and "of 6 proposals" in said
    assert len(list((folder / "pictures").glob("*.png"))) == 6
    assert run(["evaluate", str(folder / "left_of.safetensors"), *words]) == BAD_INPUT
    assert "it is there already" in capsys.readouterr().err


def test_answers_become_demonstrations(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_demos(tmp_path / "demos", good=5, bad=5)
    monkeypatch.setattr("sys.stdin", io.StringIO("yes\nskip\nno\nquit\n"))
    assert run(["ask", "left_of", "--demos", str(tmp_path / "demos"), "--pool", "8"]) == DONE
    said = capsys.readouterr().out
    assert said.count("does (left_of cup plate) hold here?") == 4 and "2 answered" in said
    asked = sorted((tmp_path / "demos").glob("left_of_asked_*.yaml"))
    assert [one.holds for one in demonstrations_of("left_of", asked)] == [True, False]
    assert [path.with_suffix(".png").is_file() for path in asked] == [True, True]
    monkeypatch.setattr("sys.stdin", io.StringIO("perhaps\n"))
    assert run(["ask", "left_of", "--demos", str(tmp_path / "demos"), "--pool", "4"]) == BAD_INPUT
    assert "'perhaps' is no answer" in capsys.readouterr().err


def test_what_was_explored_is_written_to_be_labelled(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_demos(tmp_path / "demos", good=5, bad=5)
    words = [
        "explore",
        "left_of",
        "--demos",
        str(tmp_path / "demos"),
        "--count",
        "4",
        "--out",
        str(tmp_path / "new"),
    ]
    assert run(words) == DONE
    assert "4 scenes that came to rest" in capsys.readouterr().out
    assert len(list(demonstrations_of("left_of", [tmp_path / "new"]))) == 4
    assert run(words) == BAD_INPUT


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["new", "left_of", "--demos", "nowhere"], "no demonstrations there"),
        (["new", "inside", "--demos", "."], "the name 'inside' is taken"),
        (["new", "a b", "--demos", "."], "'a b' is no name"),
        (["ask", "left_of", "--demos", "nowhere"], "no demonstrations there"),
    ],
)
def test_bad_words_are_one_error(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(words) == BAD_INPUT
    assert message in capsys.readouterr().err
