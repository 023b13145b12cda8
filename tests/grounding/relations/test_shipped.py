"""The relations that ship: learned from the scripted demonstrations, used in the shipped problems."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import tamp
from grounding.registry import GROUNDINGS, LEARNED
from grounding.relations.demonstration_file import demonstrations_of
from grounding.relations.grounding import LearnedRelation
from tamp.plan.write import plan_document
from tamp.planner.solution import Solution
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


def solved(name: str) -> Solution:
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
    last = {
        action.arguments[0]: solution.values[action.arguments[1]]
        for action in solution.plan
        if action.name == "place"
    }
    x, y = ({name: (table @ pose).position[axis] for name, pose in last.items()} for axis in (0, 1))
    assert x["cup"] < x["fork"] < x["plate"], "as one sees it who stands in front of the table"
    assert abs(y["cup"] - y["plate"]) < 0.1


@pytest.mark.slow
@pytest.mark.parametrize("name", ["stack_learned", "pack_learned"])
def test_learned_relations_build_towers_and_fill_boxes(name: str) -> None:
    solution = solved(name)
    relation = name.removesuffix("_learned")
    judged = verify(plan_document(solution), classifiers=classifiers_of([f"{relation}=learned"]))
    assert judged.holds and not judged.on_trust, judged.text()
    picked = [action.arguments[0] for action in solution.plan if action.name == "pick"]
    assert len(picked) == len({*picked}), "nothing is put down to be taken up again"
