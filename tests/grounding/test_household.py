"""Household shapes of a hand's size, closed and outward, one shape a seed."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.household import SHAPES, YCB, hull
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Hull, Part
from tamp.geometric.stability.hulls import part_mesh
from tests.geometric.making import cuboid


def volume(part: Part) -> float:
    vertices, triangles = part_mesh(part)
    a, b, c = vertices[triangles].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


@pytest.mark.parametrize("name", SHAPES)
def test_shapes_are_of_a_hands_size_and_no_two_draws_are_alike(name: str) -> None:
    rng = np.random.default_rng(0)
    sizes = set()
    for _ in range(20):
        parts = SHAPES[name](rng)
        low, high = bounds(parts, Pose())
        sizes.add(tuple(np.round(high - low, 6)))
        assert (high - low).min() >= 0.01 and (high - low).max() <= 0.3
        assert all(volume(part) > 0.0 for part in parts)  # faces look outward
    assert len(sizes) == 20


@pytest.mark.parametrize("name", SHAPES)
def test_one_seed_one_shape(name: str) -> None:
    first, second = (SHAPES[name](np.random.default_rng(7)) for _ in range(2))
    assert [part.pose for part in first] == [part.pose for part in second]
    assert [volume(part) for part in first] == [volume(part) for part in second]


@pytest.mark.parametrize("name", ["mug", "bowl"])
def test_what_is_hollow_has_room_inside(name: str) -> None:
    parts = SHAPES[name](np.random.default_rng(1))
    low, high = bounds(parts, Pose())
    top = np.array([0.0, 0.0, high[2] - 0.01])
    for part in parts:
        vertices, triangles = part_mesh(part)
        a, b, c = vertices[triangles].transpose(1, 0, 2)
        normals = np.cross(b - a, c - a)
        assert (
            np.einsum("ij,ij->i", normals, top - a) > 0.0
        ).any()  # the point is beyond one of its faces
    assert low[2] == pytest.approx(0.0, abs=1e-9)  # on its foot


def test_a_bottles_neck_is_above_its_shoulder() -> None:
    body, shoulder, neck = SHAPES["bottle"](np.random.default_rng(2))
    (_, top), (low, high), (bottom, _) = (
        bounds((part,), Pose()) for part in (body, shoulder, neck)
    )
    assert top[2] == pytest.approx(low[2]) and high[2] == pytest.approx(bottom[2])


def test_ycb_sizes_are_the_published_ones() -> None:
    for name, size in (("cracker_box", (0.06, 0.16, 0.21)), ("sugar_box", (0.045, 0.09, 0.175))):
        low, high = bounds(YCB[name], Pose())
        assert high - low == pytest.approx(size)
    low, high = bounds(YCB["tuna_can"], Pose())
    assert high - low == pytest.approx([0.085, 0.085, 0.033])


def test_a_hull_is_outward_and_cannot_be_written_to() -> None:
    made = hull(np.concatenate([cuboid((1, 2, 3)), np.zeros((1, 3))]))
    assert isinstance(made, Hull) and len(made.vertices) == 8
    assert volume(Part(made)) == pytest.approx(6.0)
    with pytest.raises(ValueError, match="read-only"):
        made.vertices[0] = 0.0
