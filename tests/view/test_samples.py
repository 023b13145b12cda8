"""Samples of a plan file's record as they are shown: whose, where, and what became of them."""

from __future__ import annotations

from typing import Any

import pytest

from tamp.errors import InputError
from tamp.geometric.scene.scene import Box
from tamp.view.samples import sample_markers
from tests.geometric.making import body, scene, table

SCENE = scene(
    table(),
    body("Cup", Box((0.1, 0.1, 0.1)), (0, 0, 0.6)),
    body("box", Box((0.1, 0.1, 0.1)), (0.3, 0, 0.6)),
)
POSE = {"position": [1, 2, 3], "quaternion": [0, 0, 0, 1]}


def sample(
    arguments: list[str], used: bool = False, refusals: list | None = None, **more: Any
) -> dict[str, Any]:
    told = [
        {"stream": s, "reason": why, "count": n, **({"bodies": list(met)} if met else {})}
        for s, why, n, *met in refusals or []
    ]
    return {
        "type": "pose",
        **POSE,
        "stream": "sample-on",
        "arguments": arguments,
        "used": used,
        "refusals": told,
        **more,
    }


def shown(*samples: dict[str, Any]) -> list[str]:
    return [marker.text for marker in sample_markers({"record": {"samples": list(samples)}}, SCENE)]


def test_a_placement_says_what_became_of_it() -> None:
    used, accepted, rejected = (
        sample(["cup", "table"], used=True),
        sample(["cup", "table"]),
        sample(
            ["cup", "table"],
            refusals=[("test-pose-clear", "hits box", 3), ("test-reach", "too far", 1)],
        ),
    )
    assert shown(used, accepted, rejected) == [
        "Cup by sample-on table: in the plan",
        "Cup by sample-on table: accepted",
        "Cup by sample-on table: rejected (test-pose-clear: hits box (3 times); test-reach: too far)",
    ]


def test_a_marker_has_the_scenes_names_the_pose_and_the_first_refusal() -> None:
    record = {
        "record": {
            "samples": [
                sample(["cup", "table"], refusals=[("test-pose-clear", "hits BOX", 1, "BOX")])
            ]
        }
    }
    (marker,) = sample_markers(record, SCENE)
    assert (marker.kind, marker.body, marker.used) == ("placement", "Cup", False)
    assert (marker.test, marker.why, marker.others) == ("test-pose-clear", "hits BOX", ("box",))
    assert marker.T[:3, 3].tolist() == [1, 2, 3]


def test_bodies_are_blamed_by_the_list_and_not_by_the_words() -> None:
    record = {
        "record": {
            "samples": [
                sample(
                    ["box", "table"],
                    refusals=[("t", "box hits cup", 1, "box", "table"), ("u", "cup is near", 1)],
                )
            ]
        }
    }
    (marker,) = sample_markers(record, SCENE)
    assert marker.others == ("table",)  # it is the box that is asked about


def test_what_is_of_no_body_here_is_left_out() -> None:
    assert shown(sample([]), sample(["table-top"]), sample(["ghost", "table"])) == []


def test_a_grasp_is_shown_in_the_hand() -> None:
    grasp = {
        **sample(["cup"], used=True),
        "type": "grasp",
        "T_tool_body": POSE,
        "stream": "sample-grasp",
    }
    (marker,) = sample_markers({"record": {"samples": [grasp]}}, SCENE)
    assert (marker.kind, marker.text) == ("grasp", "grasp of Cup: in the plan")


def test_without_a_record_the_plans_own_grasps_are_shown() -> None:
    hold = {"type": "grasp", "T_tool_body": POSE, "opening": 0.05}
    values = {
        "g": {**hold, "body": "cup"},
        "h": {**hold, "body": "ghost"},
        "p": {"type": "pose", **POSE},
    }
    (marker,) = sample_markers({"values": values}, SCENE)
    assert (marker.body, marker.used, marker.test) == ("Cup", True, None)
    assert sample_markers({}, SCENE) == ()


@pytest.mark.parametrize(
    ("spoilt", "words"),
    [
        (
            sample(["cup"], position=[1, 2]),
            r"record.samples\[0\].position: 3 numbers are expected, not 2",
        ),
        ({**sample(["cup"]), "refusals": 3}, r"record.samples\[0\].refusals: an array is expected"),
        (sample(["cup"], refusals=[("t", "no", 0)]), r"count: 0 is less than 1"),
    ],
)
def test_a_record_of_another_form_is_refused(spoilt: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        shown(spoilt)
