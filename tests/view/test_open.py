"""What a user names becomes a timeline: a plan, a robot, a problem, or what was just planned."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.symbolic.algorithms.cause import Cause, CauseKind
from tamp.symbolic.algorithms.result import Outcome
from tamp.view.open import open_timeline, timeline_of_solution
from tests.plan.solutions import MOVE, solution_of


class Read:
    """What a timeline was read from."""

    def __init__(self) -> None:
        self.files: Sequence[Path] = ()

    def __call__(self, files: Sequence[Path], meshes: Sequence[Path]) -> None:
        self.files = files


def test_a_plan_is_opened_with_all_the_files_that_it_names(stored_plan: Path, root: Path) -> None:
    read = Read()
    timeline, story, document = open_timeline(str(stored_plan), read=read)
    assert timeline.actions and document["format"] == "tamp-plan" and "4 actions" in story.head
    assert read.files[:2] == (root / "problems/one_object.yaml", stored_plan)
    assert {root / "domains/cupboard.pddl", stored_plan.parent / "cupboard.pddl"} <= set(read.files)


def test_a_robot_is_opened_by_its_name() -> None:
    timeline, story, document = open_timeline("ur5_suction")
    assert timeline.inspected and timeline.robot.name == "ur5_suction" and document == {}
    assert story.head.startswith("ur5_suction")


def test_a_problem_stands_still_and_says_its_goal(root: Path) -> None:
    read = Read()
    timeline, story, document = open_timeline("one_object", read=read)
    assert timeline.duration == 0.0 and not timeline.inspected and document == {}
    assert story.head == "3 bodies, 1 movable · goal (on soup_can cupboard_top)"
    assert read.files[0] == root / "problems/one_object.yaml"
    with pytest.raises(InputError, match="--problem goes with a plan"):
        open_timeline("one_object", "one_object")


def test_what_was_just_planned_moves_as_planned() -> None:
    timeline, _, document = timeline_of_solution(solution_of(plan=(MOVE,)))
    assert [(one.name, one.start, one.end) for one in timeline.actions] == [("move", 0.0, 2.0)]
    assert timeline.row(1.0)[:3] == pytest.approx((0.5, 0.0, 0.125))
    assert document["format"] == "tamp-plan"


def test_without_a_plan_the_scene_is_shown_and_why_there_is_none() -> None:
    cause = Cause("the can is far", CauseKind.FAILED)
    none = solution_of(outcome=Outcome.EXHAUSTED, plan=(), causes=(cause,))
    timeline, story, document = timeline_of_solution(none)
    assert timeline.actions == () and timeline.duration == 0.0
    assert story.head.startswith("No plan") and story.why == ("the can is far",)
    assert document["record"] is None
