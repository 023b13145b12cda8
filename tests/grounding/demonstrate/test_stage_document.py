"""A scene as the page reads it: where bodies are, how they can stand, and what is to be seen."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest

from grounding.demonstrate.scene import Stage
from grounding.demonstrate.stage_document import MOST_FACES, flat, stage_document
from grounding.relations.demonstration_text import BodyEntry
from grounding.relations.scenes import loaded
from tamp.geometric.scene.pose import Pose

FRONT = Pose.from_xyz_yaw(1.0, 2.0, 0.0, 0.5)
"""Of the table: the middle of it on the floor, its own -y in front."""

BODIES = {
    "table": BodyEntry({"furniture": "table", "size": [1.2, 0.8, 0.7]}, FRONT),
    "block": BodyEntry({"box": [0.06, 0.08, 0.2]}, FRONT @ Pose.from_xyz_yaw(0.2, 0, 0.801, 0.3)),
    "can": BodyEntry(
        {"cylinder": {"radius": 0.03, "height": 0.1}},
        FRONT @ Pose.from_xyz_yaw(-0.3, 0.1, 0.751, 0),
    ),
    "far": BodyEntry({"box": [0.1, 0.1, 0.1]}, Pose((4.0, 4.0, 0.051))),
}


@pytest.fixture(scope="module")
def document() -> dict[str, Any]:
    arguments = ("block", "can")
    stage = Stage(BODIES, loaded(BODIES, arguments), arguments)
    return json.loads(json.dumps(stage_document(stage, 7), allow_nan=False))


def bodies(document: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {body["name"]: body for body in document["bodies"]}


def test_it_is_the_scene_of_that_number(document: dict[str, Any]) -> None:
    assert document["number"] == 7 and document["arguments"] == ["block", "can"]
    assert [*bodies(document)] == [*BODIES]


def test_bodies_are_where_they_are(document: dict[str, Any]) -> None:
    for name, body in bodies(document).items():
        expected = BODIES[name].pose.matrix
        assert np.allclose(np.reshape(body["T"], (4, 4)), expected, atol=1e-6), name
        assert body["movable"] is (name != "table")
        assert len(body["meshes"]) > 0
    block = bodies(document)["block"]
    assert block["low"] == pytest.approx([-0.03, -0.04, -0.1])
    assert block["high"] == pytest.approx([0.03, 0.04, 0.1])


def test_a_box_can_stand_on_six_faces_and_as_it_is_modelled_first(document: dict[str, Any]) -> None:
    faces = np.reshape(bodies(document)["block"]["faces"], (-1, 3, 3))
    assert np.array_equal(faces[0], np.eye(3)) and len(faces) == 6
    ups = {tuple(np.round(face[2]).astype(int).tolist()) for face in faces}
    assert ups == {(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)}
    for face in faces:
        assert np.allclose(face @ face.T, np.eye(3), atol=1e-6) and np.linalg.det(face) > 0
    assert bodies(document)["table"]["faces"] == []
    assert 2 <= len(bodies(document)["can"]["faces"]) <= MOST_FACES


def test_places_are_in_the_world(document: dict[str, Any]) -> None:
    (place,) = (one for one in document["places"] if one["name"] == "table")
    T = np.reshape(place["T"], (4, 4))
    assert T[:3, 3] == pytest.approx([1.0, 2.0, 0.7], abs=1e-6)
    assert math.atan2(T[1, 0], T[0, 0]) == pytest.approx(0.5)
    assert place["size"] == pytest.approx([1.2, 0.8])


def test_the_viewer_looks_from_the_front_at_what_stands_there(document: dict[str, Any]) -> None:
    edge = FRONT.apply(np.array([[0.0, -0.4, 0.7]]))[0]
    assert document["front"] == pytest.approx(edge, abs=1e-3)
    view = document["view"]
    to_eye = np.array([math.cos(view["yaw"]), math.sin(view["yaw"])])
    assert to_eye == pytest.approx((edge - FRONT.apply(np.zeros((1, 3)))[0])[:2] / 0.4, abs=1e-6)
    # between the block and the can, 0.5 m apart; what is far away does not count
    assert np.linalg.norm(np.subtract(view["target"][:2], (1.0, 2.0))) < 0.15
    assert 0.3 <= view["radius"] < 0.5


def test_what_is_small_is_not_seen_from_too_near() -> None:
    arguments = ("far",)
    stage = Stage(BODIES, loaded(BODIES, ("block", "can")), arguments)
    view = stage_document(stage, 0)["view"]
    assert view["radius"] == 0.3 and view["target"] == pytest.approx([4.0, 4.0, 0.051], abs=1e-6)


def test_numbers_are_row_by_row_and_have_no_negative_zero() -> None:
    matrix = np.eye(4)
    matrix[0, 3], matrix[1, 3], matrix[2, 3] = 0.12345678, -1e-9, -0.0
    found = flat(matrix)
    assert found[3] == 0.1234568 and [found[n] for n in (0, 5, 10, 15)] == [1.0] * 4
    assert math.copysign(1.0, found[7]) == math.copysign(1.0, found[11]) == 1.0
