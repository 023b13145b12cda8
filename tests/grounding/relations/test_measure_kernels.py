"""Measures of situations: what they mean, and what they do not depend on."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.relations.geometry import situations
from benchmarks.relations.hand import shown
from grounding.relations.catalogue import catalogue, measure
from grounding.relations.null_hypothesis import about_z
from grounding.relations.situation import Situations, situation_of
from tamp.geometric.loading.load import load_scene

SCENE = """
bodies:
  desk: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.5, 0.0, 0.0], yaw: 90 deg}
  cup: {cylinder: {radius: 0.04, height: 0.1}, on: desk, at: [-0.2, 0.1]}
  plate: {box: [0.2, 0.1, 0.02], on: desk, at: [0.1, 0.1]}
  spoon: {box: [0.02, 0.02, 0.02], on: desk, at: [0.4, 0.1]}
goal: (r cup plate)
"""


def seen(tmp_path, *names: str) -> dict[str, float]:
    path = tmp_path / "scene.yaml"
    path.write_text(SCENE)
    situation = situation_of(load_scene(path, demonstration=True).scene, names)
    values = measure(situation)[0]
    return {one.key: float(value) for one, value in zip(catalogue(len(names)), values, strict=True)}


def test_measures_say_what_their_names_say(tmp_path) -> None:
    found = seen(tmp_path, "cup", "plate")
    expected = {
        "height: foot, surface": 0.001,
        "height: top, world": 0.821,
        "height: foot, top of 1": -0.02,
        "middle: x of 1 in furniture": -0.3,
        "gap below: x of 1 in furniture": 0.3 - 0.04 - 0.1,
        "gap above: x of 1 in furniture": -0.3 - 0.04 - 0.1,
        "middle: y of 1 in furniture": 0.0,
        "gap below: y of 1 in world": 0.3 - 0.04 - 0.1,
        "level gap: 1": 0.16,
        "distance: 1": 0.3,
        "up: z of 0": 0.0,
        "up: longest of 1": math.pi / 2,
        "furniture: left edge": 0.6 - 0.2 - 0.04,
        "furniture: front edge": 0.35 + 0.1 - 0.04,
        "furniture: any edge": 0.35 - 0.1 - 0.04,
        "furniture: end": 0.6 - 0.2 - 0.04,
        "furniture: long edge": 0.35 - 0.1 - 0.04,
        "furniture: corner": 0.6 - 0.2 - 0.04,
        "furniture: middle": math.hypot(0.2, 0.1),
    }
    assert {key: found[key] for key in expected} == pytest.approx(expected, abs=2e-3)


def test_a_line_is_measured_between_the_other_two(tmp_path) -> None:
    found = seen(tmp_path, "plate", "cup", "spoon")
    expected = {
        "line: share": 0.5,
        "line: beside": 0.0,
        "line: angle": math.pi,
        "line: beyond 2": -0.3,
        "nearer: 1": 0.0,
        "farther: 1": 0.3 - 0.6,
    }
    assert {key: found[key] for key in expected} == pytest.approx(expected, abs=2e-3)


def test_a_place_is_an_argument_too(tmp_path) -> None:
    found = seen(tmp_path, "cup", "desk")
    assert found["height: foot, top of 1"] == pytest.approx(0.001, abs=1e-4)
    assert found["middle within 1"] == pytest.approx(0.25, abs=1e-3)


@pytest.mark.parametrize("name", ["upright", "left_of_front", "between", "inside"])
def test_measures_do_not_depend_on_where_in_the_world_it_is(name: str) -> None:
    s = situations(shown(name, 40, True, np.random.default_rng(0)))
    moved = moved_by(s, 0.7, np.array([3.0, -2.0, 0.4]))
    listed = catalogue(s.arguments)
    world = np.array(["world" in one.key for one in listed])
    off = measure(moved) - measure(s)
    period = np.array([one.period for one in listed])
    off = np.where(
        period > 0, (off + period / 2) % np.where(period > 0, period, 1) - period / 2, off
    )
    assert np.abs(off[:, ~world]).max() < 1e-6
    assert (np.abs(off[:, world]).max(axis=0) > 0.01).all()


def moved_by(s: Situations, yaw: float, by: np.ndarray) -> Situations:
    R, support = about_z(yaw), s.support.copy()
    support[:, 0] += by[2]
    support[:, 1] += yaw
    support[:, 2:4] = s.support[:, 2:4] @ R[:2, :2].T + by[:2]
    return replace(s, R=R @ s.R, p=s.p @ R.T + by, support=support)
