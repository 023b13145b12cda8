"""A good plan holds; one that claims what is not so, or that was made from other files, is found out."""

from __future__ import annotations

import pytest

from tamp.verification.verify import verify
from tests.verification.spoiling import (
    Plan,
    Spoilt,
    beside,
    rejected,
    say,
    shift,
    sunk,
)

pytestmark = pytest.mark.usefixtures("each_engine")

SPOILT: dict[str, Spoilt] = {
    "grasp beside the body": (lambda p: shift(p["values"]["g1"]["T_tool_body"], 0.06, 1), "certified", "finger"),
    "other problem file": (lambda p: p["inputs"]["problem"].update(sha256="0" * 64), "hash", "problem"),
    "other domain file": (lambda p: p["inputs"]["domain"].update(sha256="0" * 64), "hash", "domain"),
    "easier goal": (say("goal", "(on can right)"), "goal", "not the problem's"),
    "supported by another": (
        lambda p: p["certified"].append(["supported", "block", "p1", "right"]), "certified", "p1 right"
    ),
    "approach that is not clear": (lambda p: beside(p, "approach-clear", "g1"), "certified", "the hand is"),
    "approach into the table": (lambda p: sunk(p), "certified", "mm in left"),
    "reach that is not clear": (lambda p: beside(p, "reach-clear", "g1", "b2", "q2"), "certified", "panda_"),
    "goal as certified": (lambda p: p["certified"].append(["on", "block", "left"]), "certified", "rules decide"),
    "fluent as certified": (lambda p: p["certified"].append(["at-pose", "block", "p1"]), "certified", "decide"),
    "poses that collide": (
        lambda p: p["certified"].append(["pose-clear", "block", "p1", "can", "p1"]), "certified", "penetrate"
    ),
    "unreachable kin": (lambda p: p["values"]["b2"].update(base=[0.2, 0.7, 0.0]), "certified", "kin"),
    "starts elsewhere": (lambda p: shift(p["values"]["can_start"], 0.05), "initial", "can"),
    "base starts elsewhere": (lambda p: p["values"]["base_start"].update(base=[0.1, 0, 0]), "initial", "base"),
    "forgets a body": (lambda p: p["initial"].remove(["at-pose", "can", "can_start"]), "initial", "0 poses"),
    "two starts": (lambda p: p["initial"].append(["at-pose", "block", "p1"]), "initial", "2 poses"),
    "invents a start": (lambda p: p["initial"].append(["holding", "can", "g1"]), "initial", "imply"),
    "calls a table movable": (lambda p: p["objects"].update(left=["movable", "surface"]), "initial", "movable"),
    "invents a body": (lambda p: p["objects"].update(ghost=["movable"]), "initial", "ghost"),
    "a mesh of another problem": (
        lambda p: p["inputs"].update(meshes=[{"path": "/mug.obj", "sha256": "0" * 64}]), "hash", "mug.obj"
    ),
    "base in two places": (lambda p: p["initial"].append(["at-base", "b1"]), "initial", "2 times"),
    "another robot": (say("robot", "r2d2"), "initial", "r2d2"),
}  # fmt: skip


@pytest.mark.parametrize("name", SPOILT)
def test_a_spoilt_plan_is_rejected(plan: Plan, name: str) -> None:
    rejected(plan, SPOILT[name])


def test_a_good_plan_holds(plan: Plan) -> None:
    report = verify(plan)
    assert report.holds, report.text()
    assert report.actions == 4 and report.states > 500 and not report.trusted
    assert "holds: 4 actions" in report.text()
