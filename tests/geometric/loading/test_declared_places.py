"""Surfaces and cavities as a problem file declares them, in their body's frame."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.declared_places import check_name, read_cavities, read_surfaces
from tamp.geometric.scene.pose import Pose
from tests.geometric.making import yaml


def test_surfaces_have_a_frame_a_size_and_a_clearance(tmp_path: Path) -> None:
    text = "top: {at: [0, 0, 0.4], size: [0.6, 0.3]}\n"
    text += "low: {at: [0.1, 0, 0.1], yaw: 90 deg, size: [1, 2], clearance: 0.25}"
    top, low = read_surfaces("shelf", yaml(tmp_path, text))
    assert (top.name, top.body, top.pose, top.size) == (
        "top",
        "shelf",
        Pose((0.0, 0.0, 0.4)),
        (0.6, 0.3),
    )
    assert top.clearance == math.inf
    assert low.clearance == 0.25 and low.pose.yaw == pytest.approx(math.pi / 2)


def test_cavities_have_a_height(tmp_path: Path) -> None:
    (inside,) = read_cavities(
        "bin", yaml(tmp_path, "inside: {at: [0, 0, 0.02], size: [0.3, 0.2, 0.4]}")
    )
    assert (inside.name, inside.body, inside.size) == ("inside", "bin", (0.3, 0.2, 0.4))
    assert inside.pose.position == (0.0, 0.0, 0.02)


def test_none_at_all_is_a_way_to_say_that_nothing_stands_on_it(tmp_path: Path) -> None:
    assert read_surfaces("lamp", yaml(tmp_path, "{}")) == ()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("top: {size: [1, 1]}", "top: 'at' is missing"),
        ("top: {at: [0, 0, 0]}", "top: 'size' is missing"),
        ("top: {at: [0, 0], size: [1, 1]}", "top.at: expected 3 numbers, found 2"),
        ("top: {at: [0, 0, 0], size: [1, 0]}", r"top.size\[1\]: must be positive, found 0"),
        ("top: {at: [0, 0, 0], size: [1, 1, 1]}", "top.size: expected 2 numbers, found 3"),
        ("top: {at: [0, 0, 0], size: [1, 1], clearance: 0}", "top.clearance: must be positive"),
        (
            "top: {at: [0, 0, 0], size: [1, 1], rpy: [0, 0, 0]}",
            "unknown key 'rpy'",
        ),  # they are level
        ("1top: {at: [0, 0, 0], size: [1, 1]}", "'1top' is not a name. A name is a letter"),
        ("my top: {at: [0, 0, 0], size: [1, 1]}", "'my top' is not a name"),
    ],
)
def test_mistakes_in_a_surface(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_surfaces("shelf", yaml(tmp_path, text))


def test_a_cavity_without_height_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"inside.size: expected 3 numbers, found 2"):
        read_cavities("bin", yaml(tmp_path, "inside: {at: [0, 0, 0], size: [1, 1]}"))


@pytest.mark.parametrize(
    ("name", "fine"), [("a", True), ("A-b_9", True), ("-a", False), ("ü", False), ("a.b", False)]
)
def test_names_are_those_of_pddl(tmp_path: Path, name: str, fine: bool) -> None:
    node = yaml(tmp_path, "x: 1")
    if fine:
        assert check_name(name, node) == name
    else:
        with pytest.raises(InputError, match="is not a name"):
            check_name(name, node)
