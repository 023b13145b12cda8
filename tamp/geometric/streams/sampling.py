"""Streams of grasps and placements: what generators propose, put to rest and certified."""

from __future__ import annotations

import math
from collections.abc import Iterator

from tamp.geometric.context import Context
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Cavity, Surface
from tamp.geometric.stability.placement import Placement, certified_pose, placement_of
from tamp.geometric.streams.approach import open_hand_hits
from tamp.geometric.streams.firmness import GRAVITY_M_S2, PAD_FRICTION
from tamp.geometric.streams.grasps import sample_grasps
from tamp.geometric.streams.proposal_stream import certified_poses
from tamp.geometric.streams.refusals import covered, no_grasp, no_room
from tamp.geometric.streams.suction import sample_suction_grasps
from tamp.geometric.streams.suction_refusals import no_seal, too_heavy_to_suck
from tamp.geometric.values import Grasp
from tamp.stream import Call, Rejection, RejectionKind

TRIES_BEFORE_PROOF = 32
"""Tries without any success after which it is worth asking whether a region is covered altogether.
"""


def sample_grasp(context: Context, body: str, call: Call) -> Iterator[Grasp | Rejection]:
    """Sample grasps with which the robot can carry the body at home without touching it."""

    def refused(grasp: Grasp) -> Rejection | None:
        carried = context.collisions.arrangement({}, context.attachment(grasp), fixed=False)
        hit = carried.hits(context.conf(_middle(context), context.home), padding=0.002)
        return None if hit is None else Rejection.hits(hit[1], who=f"carried at home, {hit[0]}")

    shape, found = context.scene.bodies[body], False
    too_heavy = _too_heavy(shape, context.robot)
    if too_heavy is not None:
        yield too_heavy
        return
    fixed = [(name, context.scene.bodies[name].pose) for name in context.scene.fixed]

    def free(T_body_tool: Array) -> bool:
        return open_hand_hits(context, shape.pose.matrix @ T_body_tool, fixed) is None

    ups, cup = (context.carrying_up,), context.robot.suction
    drawn = sample_grasps if cup is None else sample_suction_grasps
    for grasp in drawn(shape, context.robot, call.rng, ups, refused, free):
        found = True
        yield grasp
    if found:
        yield Rejection("no further grasp was found", given_up=True, kind=RejectionKind.NO_GRASP)
    elif cup is not None:
        yield no_seal(shape, cup)
    else:
        yield no_grasp(shape, context.robot.opening)


def _too_heavy(body: Body, robot: Robot) -> Rejection | None:
    """Say why a body cannot be lifted at all, by the arm's payload or by what the fingers' friction
    holds.
    """
    if body.mass > robot.payload:
        return Rejection(
            f"{body.name} weighs {body.mass:g} kg, the robot lifts {robot.payload:g} kg",
            kind=RejectionKind.TOO_HEAVY,
        )
    if robot.suction is not None:
        return too_heavy_to_suck(body, robot)
    holds = 2 * body.friction * PAD_FRICTION * robot.force / GRAVITY_M_S2
    if body.mass > holds:
        what = (
            f"{body.name} weighs {body.mass:g} kg and would slip: "
            f"with its friction of {body.friction:g} the fingers"
        )
        what += f", at {robot.force:g} N, hold {holds:.2g} kg"
        return Rejection(what, given_up=True, kind=RejectionKind.TOO_HEAVY)
    return None


def sample_on(context: Context, body: str, surface: str, call: Call) -> Iterator[Pose | Rejection]:
    """Sample poses at rest on a surface, free of the fixed bodies."""
    return _placements(context, "on", body, context.scene.surfaces[surface], call)


def sample_inside(
    context: Context, body: str, container: str, call: Call
) -> Iterator[Pose | Rejection]:
    """Sample poses at rest on a cavity's floor, all of the body within the cavity."""
    return _placements(context, "inside", body, context.scene.cavities[container], call)


def _placements(
    context: Context, relation: str, body: str, region: Surface | Cavity, call: Call
) -> Iterator[Pose | Rejection]:
    T_world_region = context.scene.world_pose(region)
    faces = context.stable_faces(body)
    refusal = no_room(context, body, region)
    if refusal is not None:
        yield refusal
        return

    def judge(proposal: Placement | Pose) -> Pose | Rejection:
        placement = placement_of(faces, proposal, region, T_world_region)
        if isinstance(placement, Rejection):
            return placement

        pose = certified_pose(faces, placement, region, T_world_region)
        if isinstance(pose, Rejection):
            return pose
        hit = context.collisions.between(body, pose, {})
        return pose if hit is None else Rejection.hits(hit)

    failures = 0.0
    for result in certified_poses(
        context, relation, context.mixtures[relation], (body, region.name), judge, call
    ):
        failures = failures + 1 if isinstance(result, Rejection) else -math.inf
        if failures == TRIES_BEFORE_PROOF and (proof := covered(context, body, region)) is not None:
            yield proof
            return
        yield result


def _middle(context: Context) -> tuple[float, float, float]:
    room = context.scene.room
    return (sum(room.x) / 2, sum(room.y) / 2, 0.0)
