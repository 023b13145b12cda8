"""The relations that ship: learned from the scripted demonstrations, used in the shipped problems."""

from __future__ import annotations

import importlib.util
import itertools
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import tamp
from grounding.cli import DONE, run
from grounding.registry import GROUNDINGS, LEARNED, shipped_weights
from grounding.relations.demonstration_file import demonstrations_of
from grounding.relations.grounding import LearnedRelation
from grounding.weights import read_weights
from tamp.plan.write import plan_document
from tamp.planner.solution import Solution
from tamp.system.files import shipped
from tamp.verification.classifiers import classifiers_of
from tamp.verification.verify import verify

SHOW = Path(__file__).resolve().parents[3] / "examples" / "table" / "show.py"


@pytest.fixture(scope="module")
def show() -> ModuleType:
    spec = importlib.util.spec_from_file_location("show", SHOW)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("name", LEARNED)
def test_what_ships_is_right_about_scenes_that_it_was_not_shown(
    name: str, show: ModuleType, tmp_path: Path
) -> None:
    show.show(name, tmp_path, seed=2)
    relation = GROUNDINGS[name]["learned"]()
    assert isinstance(relation, LearnedRelation)
    shown = list(demonstrations_of(name, [tmp_path]))
    said = np.array([relation.classify(one.scene, one.arguments) >= 0.5 for one in shown])
    holds = np.array([one.holds for one in shown])
    assert len(shown) == 24
    assert said[holds].mean() >= 0.9 and (~said[~holds]).mean() >= 0.9

    other_way = [
        relation.classify(one.scene, (one.arguments[1], one.arguments[0], *one.arguments[2:]))
        for one in shown
        if one.holds
    ]
    assert max(other_way) < 0.5, "none of the four holds both ways round"


def rounded(value: Any) -> Any:
    """Numbers to a billionth: sines differ in their last bit from processor to processor."""
    if isinstance(value, float):
        return round(value, 9)
    if isinstance(value, dict):
        return {key: rounded(one) for key, one in value.items()}
    return [rounded(one) for one in value] if isinstance(value, list) else value


@pytest.mark.slow
def test_what_ships_is_what_the_documented_commands_make(
    show: ModuleType, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = str(show.__doc__)
    assert "tamp-learn new stack" in words and "then pack, left_of and between" in words
    for name in ("stack", "pack", "left_of", "between"):
        show.show(name, tmp_path / name)
        out, demos = tmp_path / f"{name}_learned.safetensors", tmp_path / name
        into = ["--out", str(out), "--add-to", str(tmp_path / "learned.pddl")]
        assert run(["new", name, "--demos", str(demos), *into]) == DONE

        made, ships = read_weights(out), read_weights(shipped_weights(name, "learned"))
        assert "missing: " not in capsys.readouterr().out, "nothing is left to be shown"
        assert rounded(made.card["examples"]) == rounded(ships.card["examples"])
        assert {*made.arrays} == {*ships.arrays}
        for key, array in made.arrays.items():
            np.testing.assert_allclose(array, ships.arrays[key], atol=1e-6, err_msg=key)

    for end in (".pddl", ".streams.pddl"):
        ours = (shipped("domains") / f"learned{end}").read_text()
        assert (tmp_path / f"learned{end}").read_text() == ours


def test_left_of_ends_at_the_table() -> None:
    """What is left of it but at the other end of the room, or far behind it, is not meant."""
    scene = tamp.load_problem("set_table", registry=GROUNDINGS).scene
    relation = GROUNDINGS["left_of"]["learned"]()
    assert isinstance(relation, LearnedRelation)
    for pair in itertools.permutations(scene.movable, 2):
        assert relation.classify(scene, pair) < 0.5, pair


def solved(name: str | Path) -> Solution:
    solution = tamp.solve(tamp.load_problem(name, registry=GROUNDINGS), max_time=60.0, seed=0)
    assert solution.solved, solution.explanation
    return solution


@pytest.mark.slow
def test_the_table_is_set_as_it_is_meant() -> None:
    solution = solved("set_table")
    document = plan_document(solution)
    judged = verify(document, classifiers=classifiers_of(["left_of=learned", "between=learned"]))
    assert judged.holds and not judged.on_trust, judged.text()
    assert verify(document).on_trust == ("between", "left_of")

    table = solution.problem.scene.bodies["table"].pose.inverse()
    last: dict[str, Any] = {
        action.arguments[0]: solution.values[action.arguments[1]]
        for action in solution.plan
        if action.name == "place"
    }
    x, y = ({name: (table @ pose).position[axis] for name, pose in last.items()} for axis in (0, 1))
    assert x["cup"] < x["fork"] < x["plate"], "as one sees it who stands in front of the table"
    assert abs(y["cup"] - y["plate"]) < 0.1


LOW_BOX = """\
domain: learned
robot: {model: panda_mobile, base: [0.0, 0.0, 0 deg]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
samplers: {pack: learned}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.7], at: [1.4, 0.0, 0.0], yaw: -90 deg}
  crate: {furniture: open_box, size: [0.3, 0.25, 0.07], fixed: false, on: table, at: [0.25, 0.0], mass: 0.6}
  can:   {cylinder: {radius: 0.03, height: 0.1}, on: table, at: [-0.2, 0.0]}
goal: (pack can crate)
"""


@pytest.mark.slow
def test_what_is_packed_may_stand_out_of_the_box(tmp_path: Path) -> None:
    """Goods were shown that are taller than their box: the relation holds of them."""
    file = tmp_path / "low.yaml"
    file.write_text(LOW_BOX)
    solution = solved(file)
    judged = verify(plan_document(solution), classifiers=classifiers_of(["pack=learned"]))
    assert judged.holds and not judged.on_trust, judged.text()

    file.write_text(LOW_BOX.replace("(pack can", "(inside can"))  # which says that it is all within
    refused = tamp.solve(tamp.load_problem(file, registry=GROUNDINGS), max_time=5.0, seed=0)
    assert not refused.solved
    assert "crate has room for 0.06 m" in " ".join(refused.explanation)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["stack_learned", "pack_learned"])
def test_learned_relations_build_towers_and_fill_boxes(name: str) -> None:
    solution = solved(name)
    relation = name.removesuffix("_learned")
    judged = verify(plan_document(solution), classifiers=classifiers_of([f"{relation}=learned"]))
    assert judged.holds and not judged.on_trust, judged.text()
    picked = [action.arguments[0] for action in solution.plan if action.name == "pick"]
    assert len(picked) == len({*picked}), "nothing is put down to be taken up again"
