"""Streams of grasps and placements: what generators propose, put to rest and certified."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tamp.call import Call
from tamp.rejection import Rejection
from tamp.streams.context import Context
from tamp.streams.drawing import draw
from tamp.streams.firmness import GRAVITY, PAD_FRICTION
from tamp.streams.grasps import sample_grasps
from tamp.streams.reach import within_reach
from tamp.streams.resting import Face, fits, rest
from tamp.streams.values import Grasp
from tamp.world.bounds import bounds
from tamp.world.pose import Pose
from tamp.world.robot import Robot
from tamp.world.scene import CONTACT_GAP, Body, Box, Cavity, Hull, Part, Surface


def sample_grasp(context: Context, body: str, call: Call) -> Iterator[Grasp | Rejection]:
    """Grasps with which the robot can carry the body at home without touching it."""

    def refused(grasp: Grasp) -> Rejection | None:
        carried = context.collisions.arrangement({}, context.attachment(grasp), fixed=False)
        hit = carried.hits(context.conf(_middle(context), context.home), padding=0.002)
        return None if hit is None else Rejection(f"carried at home, {hit[0]} hits {hit[1]}")

    shape, found = context.scene.bodies[body], False
    too_heavy = _too_heavy(shape, context.robot)
    if too_heavy is not None:
        yield too_heavy
        return
    for grasp in sample_grasps(shape, context.robot, call.rng, (context.carrying_up,), refused):
        found = True
        yield grasp
    if found:
        yield Rejection("no further grasp was found", given_up=True)
    else:
        parts = context.scene.bodies[body].parts
        simple = len(parts) == 1 and not isinstance(parts[0].shape, Hull)
        opening = context.robot.opening * 100
        yield Rejection(f"no grasp: every width is over the hand's {opening:.0f} cm", given_up=not simple)


def _too_heavy(body: Body, robot: Robot) -> Rejection | None:
    """Why a body cannot be lifted at all, by the arm's payload or by what the fingers' friction holds."""
    if body.mass > robot.payload:
        return Rejection(f"{body.name} weighs {body.mass:g} kg, the robot lifts {robot.payload:g} kg")
    holds = 2 * body.friction * PAD_FRICTION * robot.force / GRAVITY
    if body.mass > holds:
        what = f"{body.name} weighs {body.mass:g} kg and would slip: with its friction of {body.friction:g} the fingers"
        return Rejection(f"{what}, at {robot.force:g} N, hold {holds:.2g} kg", given_up=True)
    return None


def sample_on(context: Context, body: str, surface: str, call: Call) -> Iterator[Pose | Rejection]:
    """Poses at rest on a surface, free of the fixed bodies."""
    return _placements(context, "on", body, context.scene.surfaces[surface], call)


def sample_inside(context: Context, body: str, container: str, call: Call) -> Iterator[Pose | Rejection]:
    """Poses at rest on a cavity's floor, all of the body within the cavity."""
    return _placements(context, "inside", body, context.scene.cavities[container], call)


def _placements(
    context: Context, relation: str, body: str, region: Surface | Cavity, call: Call
) -> Iterator[Pose | Rejection]:
    T_world_region = context.scene.world_pose(region)
    resting = context.resting(body)
    refusal = _refusal(context, body, region, T_world_region)
    if refusal is not None:
        yield refusal
        return

    def judge(proposal: Pose) -> Pose | Rejection:
        pose = rest(resting, proposal, region, T_world_region)
        if isinstance(pose, Rejection):
            return pose
        hit = context.collisions.between(body, pose, {})
        return pose if hit is None else Rejection(f"hits {hit}")

    yield from draw(context, relation, context.mixtures[relation], (body, region.name), judge, call)


def _refusal(context: Context, body: str, region: Surface | Cavity, T_world_region: Pose) -> Rejection | None:
    """Why no placement at all is possible, when that can be proven."""
    if context.scene.bodies[region.body].movable:
        return Rejection(
            f"{region.name} is on {region.body}, which may be moved; only fixed bodies can be put things on"
        )
    room = region.clearance if isinstance(region, Surface) else region.size[2]
    faces = context.resting(body).faces
    if not faces:
        return Rejection(f"{body} rests on no stable face")
    low = [face for face in faces if face.extent + 2 * CONTACT_GAP <= room]
    if not low:
        least = min(face.extent for face in faces)
        return Rejection(f"protrudes ({body} is {least:.2f} m tall, {region.name} has room for {room:.2f} m)")
    if isinstance(region, Cavity) and not any(fits(face, region.size) for face in low):
        size, space = (" x ".join(f"{length:.2f}" for length in box) for box in (_extents(low[0]), region.size))
        return Rejection(f"protrudes ({body} takes {size} m, {region.name} has {space} m)")
    height = min(room, 2.0)
    box = Part(Box((*region.size[:2], height)), Pose((0.0, 0.0, height / 2)))
    reachable = within_reach(context, *bounds((box,), T_world_region))
    return Rejection(f"{region.name} is {reachable.reason}") if isinstance(reachable, Rejection) else None


def _extents(face: Face) -> tuple[float, float, float]:
    width, depth = np.ptp(face.outline, axis=0)
    return float(width), float(depth), face.extent


def _middle(context: Context) -> tuple[float, float, float]:
    room = context.scene.room
    return (sum(room.x) / 2, sum(room.y) / 2, 0.0)
