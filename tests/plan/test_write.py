"""A solution becomes a plan file: what stands in it, how it is written, and when it is not."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.scene.pose import Pose
from tamp.geometric.values import Grip, Motion, Reach
from tamp.geometric.values import Path as Polyline
from tamp.plan.write import plan_document, plan_text, record_document, rounded, write_plan
from tamp.planner.recorder import Record, Sample
from tamp.symbolic.algorithms.result import Outcome, SkeletonAttempt
from tests.plan.solutions import GRASP, solution_of


def test_each_part_says_what_it_does_and_bodies_are_in_lower_case() -> None:
    drive, (close, lift, let_go) = (
        action["segments"] for action in plan_document(solution_of())["actions"]
    )
    frame = {"position": [0.0, 0.0, 0.1], "quaternion": [0.0, 0.0, 0.0, 1.0]}
    rider = {"position": [0.0, 0.0, 0.06], "quaternion": [0.0, 0.0, 0.0, 1.0]}
    assert drive == [
        {
            "part": "base",
            "times": [0.0, 2.0],
            "positions": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.25]],
            "opening": 0.08,
            "holding": None,
        }
    ]
    assert close == {
        "part": "gripper",
        "times": [0.0, 0.5],
        "opening": [0.08, 0.066],
        "attach": {
            "body": "soup_can",
            "T_tool_body": frame,
            "load": [{"body": "lid", "T_body_rider": rider}],
        },
    }
    assert (lift["arm"], lift["holding"], let_go["detach"]) == ("left", "soup_can", "soup_can")
    assert "attach" not in let_go and "arm" not in let_go


def test_times_and_options_are_the_solutions() -> None:
    found = plan_document(solution_of())
    assert [(one["start"], one["duration"]) for one in found["actions"]] == [(0.0, 2.0), (2.0, 3.0)]
    assert (found["duration"], found["cost"], found["seed"]) == (5.0, 2.0, 3)
    assert "robot" not in found["options"] and "record" not in found
    assert found["options"]["algorithm"] == "adaptive"


def test_each_kind_of_value_is_told() -> None:
    row = np.zeros((1, 7))
    values = {
        "r": Reach(row, row + 0.5),
        "m": Motion(
            (
                Polyline("base", np.array([[1.0, 2.0, 3.0]]), 0.08, "Soup_Can"),
                Grip((0.08, 0.066), attach=GRASP, arm="left"),
            )
        ),
        "x": 3,
    }
    found = plan_document(solution_of(values=values))["values"]
    assert found["r"] == {"type": "reach", "approach": [[0.0] * 7], "lift": [[0.5] * 7]}
    driven, gripped = found["m"]["segments"]
    assert driven == {
        "part": "base",
        "points": [[1.0, 2.0, 3.0]],
        "opening": 0.08,
        "holding": "soup_can",
    }
    assert (gripped["arm"], gripped["attach"], gripped["detach"]) == ("left", "soup_can", None)
    assert found["x"] == {"type": "value", "text": "3"}


def test_numbers_are_of_nanometres_without_a_negative_zero() -> None:
    assert rounded(0.12345678951) == 0.12345679
    assert str(rounded(-1e-12)) == "0.0"


def test_rows_of_numbers_stand_on_one_line_each() -> None:
    text = plan_text(solution_of())
    assert '"times": [0.0, 2.0]' in text and "[1.0, 0.0, 0.25]" in text
    assert text.endswith("}\n") and json.loads(text)["duration"] == 5.0


def test_what_was_tried_is_told_where_it_was_recorded() -> None:
    assert record_document(solution_of()) is None
    refused = Sample("sample-on", ("Soup_Can", "table"), Pose((1.0, 0.0, 0.0)))
    refused.refusals = Counter({("test-free", "collision"): 2, ("ik", "out of reach"): 5})
    refused.met = {("test-free", "collision"): ("lid",)}
    used = Sample("sample-grasp", ("Soup_Can",), GRASP)
    attempt = SkeletonAttempt(("move", "pick soup_can"), 2, bound=True, failures=())
    found = record_document(solution_of(record=Record((refused, used), 7, (attempt,))))
    assert found is not None
    first, second = found["samples"]
    assert first["arguments"] == ["soup_can", "table"]
    assert (first["used"], second["used"], found["dropped"]) == (False, True, 7)
    assert first["refusals"] == [
        {"stream": "ik", "reason": "out of reach", "bodies": [], "count": 5},
        {"stream": "test-free", "reason": "collision", "bodies": ["lid"], "count": 2},
    ]
    assert found["skeletons"][0]["bound"] is True


def test_without_a_plan_or_a_place_nothing_is_written(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no plan to write"):
        write_plan(solution_of(outcome=Outcome.TIMEOUT, plan=()), tmp_path / "plan.json")
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="cannot write the plan: Not a directory"):
        write_plan(solution_of(), tmp_path / "file" / "plan.json")
    assert [one.name for one in tmp_path.iterdir()] == ["file"]
