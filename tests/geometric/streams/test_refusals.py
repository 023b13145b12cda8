"""What is called impossible is; what is only not found is given up, and the reason says what it is."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.awkward_scenes import scene
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Hull, Part, Shape, Sphere
from tamp.geometric.stability.hulls import body_hull
from tamp.geometric.stability.placement import Placement, certified_pose
from tamp.geometric.stability.stable_poses import stable_faces_of
from tamp.geometric.streams.refusals import covered, narrowest, no_grasp, no_room
from tamp.plan.write import plan_text
from tamp.planner.problem import load_problem
from tamp.planner.solve import solve
from tamp.stream import Rejection, RejectionKind
from tamp.symbolic.algorithms.result import Outcome
from tamp.verification.verify import verify
from tests.geometric.streams.scenes import HIGH, problem_with, solved

OPENING = 0.08


def body(
    shape: Shape, rpy: tuple[float, float, float] = (0.0, 0.0, 0.0), support: str | None = "table"
) -> Body:
    return Body(
        "thing", (Part(shape),), Pose.from_xyz_rpy((0.0, 0.0, 1.0), rpy), True, support=support
    )


@pytest.mark.parametrize(
    ("shape", "proven"),
    [
        (Box((0.1, 0.12, 0.2)), True),
        (Box((0.0798, 0.12, 0.2)), False),
        (Box((0.0802, 0.12, 0.2)), False),
        (Cylinder(0.06, 0.1), True),
        (Cylinder(0.042, 0.1), False),  # friction holds it beside its middle
        (Sphere(0.05), True),
        (Sphere(0.0425), False),
    ],
)
def test_only_widths_that_no_hand_takes_are_a_proof(shape: Shape, proven: bool) -> None:
    assert no_grasp(body(shape), OPENING).given_up is not proven


def test_a_mesh_proves_nothing_and_its_width_is_named() -> None:
    corners, triangles = body_hull(body(Box((0.2, 0.2, 0.2))))
    said = no_grasp(body(Hull(corners, triangles)), OPENING)
    assert (
        said.given_up
        and "20.0 cm" in said.reason
        and narrowest(body(Hull(corners, triangles))) is None
    )


def test_a_can_that_lies_may_lie_elsewhere_and_a_ball_may_not() -> None:
    lying = stable_faces_of(body(Cylinder(0.03, 0.2), (math.pi / 2, 0.0, 0.4)))
    assert lying.lying is not None and lying.lying.extent == pytest.approx(0.06, abs=1e-3)
    assert lying.lying.height == pytest.approx(0.03, abs=1e-3)
    nearest = lying.nearest(lying.body.pose.rotation)
    assert nearest is not None and lying.ways[nearest] is lying.lying
    standing = stable_faces_of(body(Cylinder(0.03, 0.2)))
    assert (
        standing.lying is None
        and standing.under(0.25) == (0, 1)
        and not stable_faces_of(body(Sphere(0.03))).curved
    )
    assert [standing.face(n).extent for n in standing.under(0.1)] == pytest.approx(
        [0.06] * len(standing.curved)
    )
    assert stable_faces_of(body(Sphere(0.03))).lying is None
    assert (
        stable_faces_of(body(Cylinder(0.03, 0.2), (math.pi / 2, 0.0, 0.0), support=None)).lying
        is None
    )


def test_a_body_that_leans_does_not_rest_so() -> None:
    assert stable_faces_of(body(Box((0.05, 0.05, 0.3)), (0.5, 0.0, 0.0))).lying is None


LYING = "cylinder: {radius: 0.03, height: 0.25}, rpy: [90 deg, 0 deg, 0 deg]"


def refusal(shape: str, region: str, folder: Path) -> Rejection | None:
    context = problem_with("thing", folder, shape).context
    place = context.scene.surfaces.get(region) or context.scene.cavities[region]
    return no_room(context, "thing", place)


def test_a_box_that_fits_no_way_up_is_a_proof(tmp_path: Path) -> None:
    refused = refusal("box: [0.07, 0.6, 0.6]", "cupboard_1", tmp_path)
    assert refused is not None and not refused.given_up and "protrudes" in refused.reason


def test_a_box_that_fits_on_an_unsteady_side_proves_nothing(tmp_path: Path) -> None:
    context = problem_with("thing", tmp_path, "box: [0.03, 0.36, 0.3]").context
    slot = replace(context.scene.cavities["cupboard_1"], size=(0.4, 0.06, 0.33))
    refused = no_room(
        context, "thing", slot
    )  # on 3 cm by 36 cm it tips at 6 degrees; on 3 cm by 30 cm it is too tall
    assert refused is None or refused.given_up
    narrower = no_room(context, "thing", replace(slot, size=(0.2, 0.2, 0.2)))
    assert narrower is not None and not narrower.given_up and "protrudes" in narrower.reason


def test_a_lying_can_fits_under_a_ceiling_that_it_cannot_stand_under(tmp_path: Path) -> None:
    context = problem_with("thing", tmp_path, "cylinder: {radius: 0.03, height: 0.25}").context
    thing, low = (
        context.scene.bodies["thing"],
        replace(context.scene.cavities["cupboard_1"], size=(0.4, 0.3, 0.2)),
    )
    assert no_room(context, "thing", low) is None  # though it stands now
    lower = no_room(context, "thing", replace(low, size=(0.4, 0.3, 0.05)))
    assert lower is not None and not lower.given_up and "thing is 0.06 m tall" in lower.reason
    lying = replace(thing, pose=Pose.from_xyz_rpy(thing.pose.position, (math.pi / 2, 0.0, 0.3)))
    scene = replace(context.scene, bodies={**context.scene.bodies, "thing": lying})
    assert no_room(replace(context, scene=scene), "thing", low) is None


def test_a_sphere_is_refused_in_words_without_a_proof(tmp_path: Path) -> None:
    refused = refusal("sphere: 0.03", "cupboard_top", tmp_path)
    words = "a sphere rests on no stable face (thing)"
    assert refused == Rejection(words, given_up=True, kind=RejectionKind.UNSTABLE)


@pytest.mark.parametrize("others", [0, 12])
def test_what_stands_on_it_for_good_is_named_whatever_else_is_there(
    others: int, tmp_path: Path
) -> None:
    thing = "cup: {box: [0.07, 0.07, 0.1], on: table, at: [0.0, 0.0]}\n  slab: {box: [0.12, 0.12, 0.12], on: cup}"
    for i in range(others):
        x, y = -0.5 + 0.18 * (i % 6), 0.5 * (i // 6) - 0.25
        thing += f"\n  o{i}: {{box: [0.05, 0.05, 0.1], on: table, at: [{x:.2f}, {y}]}}"
    outcome, said = solved(HIGH.format(height=1.0, thing=thing, goal="board"), tmp_path, 8.0)
    assert outcome is Outcome.INFEASIBLE
    assert "(on cup board) cannot be reached: cup stays loaded with slab" in said


def test_a_ball_on_it_that_can_be_put_nowhere_is_named_without_a_proof(tmp_path: Path) -> None:
    thing = (
        "cup: {box: [0.06, 0.06, 0.1], on: table, at: [0.0, 0.0]}\n  ball: {sphere: 0.03, on: cup}"
    )
    outcome, said = solved(HIGH.format(height=1.0, thing=thing, goal="board"), tmp_path, 8.0)
    assert outcome is Outcome.EXHAUSTED and "cup is loaded with ball" in said.splitlines()[0]
    assert "a sphere rests on no stable face" in said


def test_a_fixed_lid_is_a_load(tmp_path: Path) -> None:
    thing = "cup: {box: [0.06, 0.06, 0.1], on: table, at: [0.0, 0.0]}"
    thing += "\n  lid: {box: [0.04, 0.04, 0.05], on: cup, fixed: true}"
    outcome, said = solved(HIGH.format(height=1.0, thing=thing, goal="board"), tmp_path, 2.0)
    assert outcome is Outcome.TIMEOUT and "loaded with lid, which is fixed" in said


def test_a_pear_on_its_side_is_put_on_its_side(tmp_path: Path) -> None:
    _, text = scene(5, tmp_path)
    path = tmp_path / "pear.yaml"
    path.write_text(text, encoding="utf-8")
    solution = solve(load_problem(path), max_time=30.0)
    assert solution.outcome is Outcome.SOLVED and solution.plan
    assert verify(json.loads(plan_text(solution))).holds


STAND = """
domain: cupboard
robot: {{model: panda_mobile, base: [0.0, 0.0, 0.0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
bodies:
  stand: {{box: [0.4, 0.3, 0.6], at: [-1.4, 0.3, 0.3], yaw: {yaw:.2f}, fixed: true}}
{things}
  cup: {{{cup}, on: floor, at: [1.0, 0.0]}}
goal: (on cup stand)
"""


def test_no_place_is_free_where_all_are_called_taken(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    """Against brute force: 400 random placements each."""
    proven = free = 0
    for number in range(40):
        least = (0.2, 0.2, 0.05) if number % 3 == 0 else (0.37, 0.27, 0.05)
        size = rng.uniform(least, (0.4, 0.3, 0.3))
        x, y = rng.uniform(-0.01, 0.01, 2)
        box = ", ".join(f"{side:.3f}" for side in size)
        things = (
            f"  t: {{box: [{box}], on: stand, at: [{x:.3f}, {y:.3f}], fixed: true, surfaces: {{}}}}"
        )
        cup = ("box: [0.05, 0.06, 0.1]", "cylinder: {radius: 0.03, height: 0.09}")[number % 4 // 2]
        path = tmp_path / "stand.yaml"
        path.write_text(
            STAND.format(yaw=rng.uniform(0, 3), things=things, cup=cup), encoding="utf-8"
        )
        context = load_problem(path).context
        stand = context.scene.surfaces["stand"]
        found = False
        for _ in range(400):
            faces = context.stable_faces("cup")
            face = int(rng.integers(len(faces.faces)))
            x, y = (float(rng.uniform(-side / 2, side / 2)) for side in stand.size)
            placement = Placement("stand", face, x, y, rng.uniform(-3, 3))
            pose = certified_pose(faces, placement, stand, context.scene.world_pose(stand))
            found |= isinstance(pose, Pose) and context.collisions.between("cup", pose, {}) is None
        proof = covered(context, "cup", stand)
        assert proof is None or not found
        proven += proof is not None
        free += found
    assert proven >= 10 and free >= 5


def test_a_covered_place_is_proven_so(tmp_path: Path) -> None:
    path = tmp_path / "stand.yaml"
    things = "  monitor: {box: [0.39, 0.29, 0.3], on: stand, fixed: true, surfaces: {}}"
    path.write_text(
        STAND.format(yaw=0.4, things=things, cup="box: [0.05, 0.06, 0.1]"), encoding="utf-8"
    )
    solution = solve(load_problem(path), max_time=20.0)
    assert (
        solution.outcome is Outcome.INFEASIBLE
        and "every place there hits monitor" in solution.explanation[0]
    )
