"""Kept objects: what is packed comes out again, and what is kept are solids of a plausible size."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding import bullet_objects as module
from grounding.bullet_objects import bullet_objects, packed
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Cylinder, Hull, Part
from tests.geometric.making import cuboid, hull

OBJECTS = {
    "brick": (Part(Box((0.1, 0.2, 0.3)), Pose((0.0, 0.0, 0.15))),),
    "mug": (
        Part(hull(cuboid((0.1, 0.1, 0.2))), Pose.from_xyz_rpy((0.1, 0.0, 0.0), (0.1, 0.2, 0.3))),
        Part(Box((0.01, 0.02, 0.05))),
        Part(hull(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]))),
    ),
    "crate": (Part(hull(cuboid((0.4, 0.4, 0.1)))),),
}


def test_what_is_packed_comes_out_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    np.savez(tmp_path / "objects.npz", allow_pickle=False, **packed(OBJECTS))
    monkeypatch.setattr(module, "OBJECTS_FILE", tmp_path / "objects.npz")
    found = bullet_objects.__wrapped__()  # what the process keeps are the shipped ones
    assert list(found) == list(OBJECTS)
    for name, parts in OBJECTS.items():
        assert len(found[name]) == len(parts)
        for one, other in zip(found[name], parts, strict=True):
            assert np.allclose(one.pose.matrix, other.pose.matrix)
            assert type(one.shape) is type(other.shape)
            if isinstance(one.shape, Hull):
                assert np.array_equal(one.shape.vertices, other.shape.vertices)
                assert np.array_equal(one.shape.faces, other.shape.faces)
                assert not one.shape.vertices.flags.writeable
            else:
                assert one.shape == other.shape


def test_other_shapes_are_refused() -> None:
    with pytest.raises(TypeError, match="only hulls and boxes"):
        packed({"can": (Part(Cylinder(0.03, 0.1)),)})


def test_what_is_kept_are_solids_of_a_hands_size_or_a_tables() -> None:
    found = bullet_objects()
    assert found is bullet_objects() and len(found) > 10
    for name, parts in found.items():
        low, high = bounds(parts, Pose())
        assert (high - low).min() > 0.005 and (high - low).max() < 3.0, name
        for part in parts:
            if isinstance(part.shape, Hull):
                faces, vertices = part.shape.faces, part.shape.vertices
                assert faces.min() >= 0 and faces.max() < len(vertices), name
                a, b, c = (vertices[faces[:, corner]] for corner in range(3))
                assert np.einsum("nj,nj->", a, np.cross(b, c)) > 0.0, name  # it faces outwards
