"""What a page shows, as JSON: motions and shapes as they are."""

from __future__ import annotations

import base64
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tamp.view.document import GRID, packed_meshes, page_document
from tamp.view.mesh import Mesh
from tamp.view.open import open_timeline
from tamp.view.timeline import Timeline


def unpacked(text: str, kind: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), dtype=kind)


def test_motion_and_shapes_survive_the_packing(
    document: dict[str, Any], timeline: Timeline
) -> None:
    assert unpacked(document["times"], "<f4") == pytest.approx(timeline.times, abs=1e-5)
    assert unpacked(document["rows"], "<f4").reshape(-1, 11) == pytest.approx(
        timeline.rows, abs=1e-5
    )
    can = next(body for body in document["bodies"] if body["name"] == "soup_can")
    (mesh,) = can["meshes"]
    grid = unpacked(mesh["vertices"], "<u2").reshape(-1, 3)
    vertices = np.array(mesh["low"]) + grid * np.array(mesh["step"])
    shape = timeline.scene.bodies["soup_can"].parts[0].shape
    height = vertices[:, 2].max() - vertices[:, 2].min()
    assert height == pytest.approx(getattr(shape, "height"), abs=1e-5)  # noqa: B009
    assert unpacked(mesh["faces"], "<u4").max() == len(vertices) - 1
    assert [stay["held"] for stay in can["stays"]] == [False, True, False]
    assert [action["text"] for action in document["actions"]][1] == "pick soup_can from table"


def test_a_mesh_without_faces_is_left_out_and_a_flat_one_is_told() -> None:
    corners = np.array([[0.0, 0, 1], [2, 0, 1], [0, 4, 1]])
    flat = Mesh(corners, np.array([[0, 1, 2]]), (0.123456, 1.0, 0.0, 1.0))
    (told,) = packed_meshes((Mesh(corners, np.empty((0, 3), int), flat.colour), flat))
    grid = unpacked(told["vertices"], "<u2").reshape(-1, 3)
    assert grid[:, :2].tolist() == [[0, 0], [GRID, 0], [0, GRID]]
    assert (np.array(told["low"]) + grid * told["step"])[:, 2] == pytest.approx(1.0)
    assert told["colour"] == [0.1235, 1.0, 0.0, 1.0]


def test_without_a_plan_bodies_stay_where_they_are_and_nothing_is_told_of_actions() -> None:
    timeline, story, _ = open_timeline("one_object")
    told = page_document(replace(timeline, stays={}), story)
    assert told["actions"] == told["samples"] == [] and told["inspection"] is None
    can = next(body for body in told["bodies"] if body["name"] == "soup_can")
    (stay,) = can["stays"]
    at = np.array(stay["T"]).reshape(4, 4)[:3, 3]
    # On a table at (1.6, 0), a quarter turned: its own (0.1, 0.1) is (-0.1, 0.1) in the world.
    assert at == pytest.approx((1.5, 0.1, 0.72 + 0.051), abs=0.002)
    assert (can["movable"], stay["since"], stay["held"]) == (True, 0.0, False)
    assert can["height"] == pytest.approx(0.051)


def test_a_robot_alone_is_told_with_all_that_it_is_made_of() -> None:
    told = page_document(*open_timeline("two_pandas")[:2])
    assert told["inspection"] is not None and len(told["robot"]["arms"]) == 2
    assert [len(arm["joints"]) for arm in told["robot"]["arms"]] == [7, 7]
    names = [link["name"] for link in told["robot"]["links"]]
    assert len(names) == len(set(names)) and told["robot"]["arms"][0]["foot"] == names[1]
