"""How bodies stand at the start: by the judge's rule, settled where that is near, refused with the reason elsewhere."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.footing import Ground
from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import (
    Body,
    Box,
    Cylinder,
    Part,
    RobotStart,
    Room,
    Scene,
    Shape,
    Sphere,
)
from tamp.planner.initial_state import initial_state
from tamp.simulation.engines import open_world
from tamp.symbolic.pddl.parser import parse_domain
from tamp.verification.support_geometry import Supports

HEAD = """\
domain: cupboard
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [0.8, 0.6, 0.7], at: [1.2, 0, 0]}
"""
WEDGE = [(-0.02, 0.0), (0.0, 0.0), (0.12, 0.006), (0.12, 0.04), (-0.02, 0.04)]
"""A profile x, z that stands on its first two corners, its weight far beyond them."""


def load(folder: Path, *lines: str) -> LoadedProblem:
    file = folder / "scene.yaml"
    file.write_text(HEAD + "".join(f"  {line}\n" for line in lines) + "goal: (hand-empty)\n")
    return load_scene(file)


def wedge(folder: Path) -> None:
    """wedge.obj: the profile 4 cm wide."""
    count = len(WEDGE)
    text = [f"v {x} {y} {z}" for y in (-0.02, 0.02) for x, z in WEDGE]
    text.append("f " + " ".join(str(i + 1) for i in range(count)))
    text.append("f " + " ".join(str(2 * count - i) for i in range(count)))
    text += [
        f"f {i + 1} {count + i + 1} {count + (i + 1) % count + 1} {(i + 1) % count + 1}"
        for i in range(count)
    ]
    (folder / "wedge.obj").write_text("\n".join(text) + "\n")


def felt(bodies: dict[str, Body], name: str) -> str | None:
    """The judge's opinion of how a body stands."""
    with open_world(
        Scene("s", bodies, RobotStart("panda_mobile", (0, 0, 0)), Room((-3, 3), (-3, 3)))
    ) as world:
        return Supports(world).stand(name).why


def _shape(rng: np.random.Generator) -> Shape:
    kinds: list[Shape] = [
        Box(
            (
                float(rng.uniform(0.03, 0.2)),
                float(rng.uniform(0.03, 0.2)),
                float(rng.uniform(0.03, 0.2)),
            )
        ),
        Cylinder(float(rng.uniform(0.02, 0.06)), float(rng.uniform(0.05, 0.2))),
        Sphere(float(rng.uniform(0.02, 0.06))),
    ]
    return kinds[int(rng.integers(3))]


def test_what_stands_here_stands_for_the_judge(rng: np.random.Generator) -> None:
    stood = fell = 0
    for _ in range(150):
        table = Body("table", (Part(Box((0.3, 0.3, 0.1))),), Pose((0, 0, 0.5)), movable=False)
        height = 0.1 + float(rng.choice([0.0, 0.001, 0.02]))
        beside = Body(
            "beside",
            (Part(Box((0.2, 0.3, height))),),
            Pose((float(rng.uniform(0.28, 0.4)), 0, 0.5)),
            True,
        )
        parts = tuple(
            Part(_shape(rng), Pose((float(rng.uniform(-0.03, 0.03)), 0, 0))) for _ in range(2)
        )
        rolled = tuple(rng.uniform(-3, 3, 3).tolist()) if rng.random() < 0.3 else (0.0, 0.0, 0.0)
        turned = Pose.from_xyz_rpy((0, 0, 0), (rolled[0], rolled[1], rolled[2]))
        low, _ = bounds(parts, turned)
        z = 0.55 - float(low[2]) + float(rng.choice([0.001, 0.0, 0.008, 0.012]))
        at = (float(rng.uniform(-0.3, 0.6)), float(rng.uniform(-0.2, 0.2)), z)
        body = Body("thing", parts, Pose(at, turned.quaternion), movable=True)
        bodies = {one.name: one for one in (table, beside, body)}
        footing = Ground(bodies).footing(body)
        if footing.why is None:
            assert felt(bodies, "thing") is None
        stood, fell = stood + (footing.why is None), fell + (footing.why is not None)
    assert stood > 20 and fell > 20


def test_a_plank_rests_on_both_of_its_supports(tmp_path: Path) -> None:
    loaded = load(
        tmp_path,
        "a: {box: [0.05, 0.05, 0.1], on: table, at: [0, -0.1]}",
        "b: {box: [0.05, 0.05, 0.1], on: table, at: [0, 0.1]}",
        "plank: {box: [0.05, 0.3, 0.02], at: [1.2, 0, 0.812]}",
    )
    assert loaded.warnings == ()
    assert loaded.scene.bodies["plank"].carriers == ("a", "b")
    assert felt(dict(loaded.scene.bodies), "plank") is None
    domain = Path("domains/cupboard.pddl")
    facts = initial_state(loaded.scene, parse_domain(domain.read_text(), domain)).facts
    assert {("rests-on", "plank", "plank_start", one) for one in ("a", "b")} <= facts
    assert not any(fact[0] == "rests-on" and fact[1] != "plank" for fact in facts)


def test_a_plank_beside_its_support_does_not_stand_still(tmp_path: Path) -> None:
    loaded = load(
        tmp_path,
        "a: {box: [0.05, 0.05, 0.1], on: table, at: [0, -0.1]}",
        "plank: {box: [0.05, 0.3, 0.02], at: [1.2, 0.02, 0.812]}",
    )
    assert len(loaded.warnings) == 1
    assert "plank does not stand still: its centre of mass is 95." in loaded.warnings[0]
    assert loaded.scene.bodies["plank"].support is None


def test_a_body_that_leans_a_little_is_laid_onto_the_face_beside(tmp_path: Path) -> None:
    wedge(tmp_path)
    loaded = load(tmp_path, "banana: {mesh: wedge.obj, on: table}")
    tilt = math.degrees(math.acos(loaded.scene.bodies["banana"].pose.rotation[2, 2]))
    assert tilt == pytest.approx(math.degrees(math.atan2(0.006, 0.12)), abs=0.01)
    assert loaded.warnings[-1].startswith(
        "banana is tipped by 2.9 deg onto its nearest face: its centre of mass is 18"
    )
    assert felt(dict(loaded.scene.bodies), "banana") is None
    assert loaded.scene.bodies["banana"].support == "table"


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["slab: {box: [0.3, 0.1, 0.02], on: table, at: [0.405, 0]}"], "slab's centre is 0.005 m outside"),
        (
            ["shelf: {box: [0.4, 0.4, 0.3], on: floor, at: [-1, 0], fixed: true, "
             "surfaces: {top: {at: [0, 0, 0.25], size: [0.3, 0.3]}}}", "can: {box: [0.05, 0.05, 0.1], on: top}"],
            "can does not stand on 'top': under it is nothing within 10 mm; the surface 'top' is in the air there",
        ),
        (
            ["shelf: {box: [0.4, 0.4, 0.3], on: floor, at: [-1, 0], fixed: true, "
             "surfaces: {top: {at: [0.2, 0, 0.15], size: [0.3, 0.3]}}}",
             "can: {box: [0.05, 0.05, 0.1], on: top, at: [0.005, 0]}"],
            "its centre of mass is 5.1 mm beyond what carries it",
        ),
        (["pole: {cylinder: {radius: 0.03, height: 0.2}, on: table, rpy: [30 deg, 0, 0]}"], "its centre of mass is"),
    ],
)  # fmt: skip
def test_a_body_that_does_not_stand_is_refused_with_the_reason(
    tmp_path: Path, lines: list[str], said: str
) -> None:
    with pytest.raises(InputError) as caught:
        load(tmp_path, *lines)
    assert said in str(caught.value)
    assert caught.value.line == 5 + len(lines)


def test_bodies_by_the_thousand_in_one_place_are_no_reason_to_wait() -> None:
    one = Body("one", (Part(Box((0.05, 0.05, 0.1))),), Pose((0, 0, 0.051)), movable=True)
    bodies = {f"b{number}": replace(one, name=f"b{number}") for number in range(2500)}
    began = time.process_time()
    ground = Ground(bodies)
    for body in bodies.values():
        ground.footing(body)
    assert time.process_time() - began < 20.0
