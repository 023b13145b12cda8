"""Grasps of a body by a suction cup: one contact, on a face that closes the whole rim.

The cup's strength is that of a ring under even suction, after Mahler et al., "Dex-Net 3.0:
Computing robust robot suction grasp targets" (ICRA 2018): a pull, a force along the face by
friction, and a turn about axes in the face, up to where the rim lifts on one side.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.robot.robot import Robot, Suction
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body
from tamp.geometric.stability.ray_crossings import ConvexUnion, solid_of
from tamp.geometric.streams.antipodal import tool_pose
from tamp.geometric.streams.firmness import (
    FIRM_STRAIN,
    GRAVITY_M_S2,
    PAD_FRICTION,
    SHAKE_DIRECTIONS,
    SHAKE_SHARE,
)
from tamp.geometric.streams.grasp_directions import MAX_UPWARD_PART, across
from tamp.geometric.streams.grasps import refuse_none, take_any_way
from tamp.geometric.streams.hand_fit import BACK_STEP_M, CLEAR_APPROACH
from tamp.geometric.values import Grasp
from tamp.stream import Rejection

if TYPE_CHECKING:
    from jaxtyping import Float

CUP_GAP_M = 5e-4
"""Metres between the rim and the face, so that holding is not a collision."""

SEAL_GIVE_M = 5e-4
"""Metres by which what is under the cup may be off the face's plane: its lip gives so much."""

ABOVE_M = 0.01
"""Metres over the face from which it is looked at: what is nearer is in the cup's way."""

RIM_POINTS = 16
"""Points of the rim that are looked at; as many at half of its radius, and the middle."""

SPINS_PER_PLACE = 8
"""Turns of the hand about the cup's axis that are tried on each canonical place."""

PLACES_LOOKED_FOR = 256
"""Random points of the surface whose faces are the canonical ones."""

SAME_NORMAL = 0.999
"""Cosine from which two faces count as one."""

MAX_FAILED_CUPS = 2000
"""Random places in a row that may fail before the stream ends."""


def sample_suction_grasps(
    body: Body,
    robot: Robot,
    rng: np.random.Generator,
    ups: Sequence[Float[Array, " 3"]] = (),
    refused: Callable[[Grasp], Rejection | None] = refuse_none,
    free: Callable[[Float[Array, "4 4"]], bool] = take_any_way,
) -> Iterator[Grasp | Rejection]:
    """Yield suction grasps of a body: first over its middle on each of its faces, those from above
    before those from the side, then anywhere on them without end.

    The whole rim is on the face, whose normals are within the cup's limit; the hand is free of the
    body there and while it draws back; and the cup carries the weight with its lever arm. Firm
    grasps come first. The arguments are those of `sample_grasps`.
    """
    cup = robot.suction
    if cup is None:
        raise ValueError(f"{robot.name} has no suction gripper")
    solid, up = solid_of(body), body.pose.rotation[2]
    fit = _CupFit(body, solid, robot, cup)

    def judged(T: Array) -> tuple[float, Grasp] | None:
        """Return a grasp with its strain; None where the cup does not hold."""
        if not fit.clear(T):
            return None
        held = T[:3, :3].T @ up
        much = suction_strain(body, solid.centre, T, cup, robot.force, (held, *ups))
        grasp = Grasp(body.name, Pose.from_matrix(T).inverse(), 0.0)
        return (much, grasp) if much <= 1.0 else None

    waiting: list[tuple[float, Grasp]] = []
    for T in itertools.chain.from_iterable(_canonical(solid, fit, up, rng)):
        found = judged(T)
        if found is None:
            continue
        much, grasp = found
        why = refused(grasp)
        if why is not None:
            yield why
        elif much <= FIRM_STRAIN:
            yield grasp
        else:
            waiting.append(found)
    yield from (grasp for _, grasp in sorted(waiting, key=lambda one: one[0]))

    failures = 0
    while failures < MAX_FAILED_CUPS:
        points, normals = solid.surface_points(rng, 1)
        failures += 1
        if normals[0] @ up < -MAX_UPWARD_PART and rng.random() > 0.1:
            continue
        T = fit.sealed(points[0], normals[0], rng.uniform(0.0, 2 * math.pi), up)
        found = None if T is None or not free(T) else judged(T)
        if found is None:
            continue
        why = refused(found[1])
        if why is None:
            failures = 0
        yield why or found[1]


def suction_strain(
    body: Body,
    centre: Float[Array, " 3"],
    T_body_tool: Float[Array, "4 4"],
    cup: Suction,
    force: float,
    ups: Sequence[Float[Array, " 3"]],
) -> float:
    """Compute the share that a body's weight uses up of what a cup holds; without a unit, at 1 its
    rim lifts or it slides.

    The pull and the turn that lift the rim on one side, and beside them the force along the face.

    Args:
        body: Its mass and friction are asked for.
        centre: Its centre of mass in its own frame, shape (3,), metres.
        T_body_tool: The grasp, shape (4, 4).
        cup: Its radius.
        force: The most that it pulls with, newtons.
        ups: The directions of up that the tool sees while it holds the body, (3,) each, in the
            tool's frame.
    """
    lever = T_body_tool[:3, :3].T @ (centre - T_body_tool[:3, 3])
    shaken = np.concatenate([np.asarray(up) + SHAKE_SHARE * SHAKE_DIRECTIONS for up in ups])
    weights = -body.mass * GRAVITY_M_S2 * shaken
    turns = np.linalg.norm(np.cross(lever, weights)[:, :2], axis=1)
    lifted = np.maximum(weights[:, 2], 0.0) / force + turns / (force * cup.radius)
    slid = np.linalg.norm(weights[:, :2], axis=1) / (PAD_FRICTION * body.friction * force)
    return float(np.maximum(lifted + slid, 0.0).max())


class _CupFit:
    """The cup and one body."""

    def __init__(self, body: Body, solid: ConvexUnion, robot: Robot, cup: Suction) -> None:
        self._solid, self._cup = solid, cup
        angles = np.arange(RIM_POINTS) * 2 * math.pi / RIM_POINTS
        ring = cup.radius * np.column_stack([np.cos(angles), np.sin(angles), np.zeros(RIM_POINTS)])
        self._disc = np.concatenate([np.zeros((1, 3)), ring / 2, ring])
        hand = robot.link(robot.hand)
        self._hand, self._body = FclBody(hand.parts), FclBody(body.parts)
        self._T_tool_hand = robot.T_hand_tool.inverse().matrix

    def sealed(
        self,
        point: Float[Array, " 3"],
        normal: Float[Array, " 3"],
        spin: float,
        up: Float[Array, " 3"],
    ) -> Float[Array, "4 4"] | None:
        """Put the cup on a point of the surface, square to its face, turned by `spin` radians about
        its axis; None where the face does not close it.
        """
        first, second = across(-normal, up)
        closing = math.cos(spin) * first + math.sin(spin) * second
        T = tool_pose(closing, -normal, point + CUP_GAP_M * normal)
        origins = self._disc @ T[:3, :3].T + point + ABOVE_M * normal
        starts, ends, planes, _ = self._solid.crossings(origins, -normal)
        ahead = (ends > starts) & (ends > 0.0)
        nearest = np.where(ahead, starts, np.inf)
        part = np.argmin(nearest, axis=1)
        rows = np.arange(len(origins))
        if (np.abs(nearest[rows, part] - ABOVE_M) > SEAL_GIVE_M).any():
            return None
        square = self._solid.normals(planes[rows, part]) @ normal
        return T if (square >= math.cos(self._cup.tilt)).all() else None

    def clear(self, T_body_tool: Float[Array, "4 4"]) -> bool:
        """Check whether the hand is free of the body at a pose and while it draws back."""
        for far in np.arange(0.0, CLEAR_APPROACH + 1e-9, BACK_STEP_M):
            T = T_body_tool @ self._T_tool_hand
            T[:3, 3] -= far * T_body_tool[:3, 2]
            for a in range(len(self._hand.objects)):
                placed = self._hand.place(a, T)
                if any(
                    touch(placed, self._body.place(b, _STANDS), 0.0)
                    for b in range(len(self._body.objects))
                ):
                    return False
        return True


_STANDS = np.eye(4)
"""Where the body is: in its own frame."""


def _canonical(
    solid: ConvexUnion, fit: _CupFit, up: Array, rng: np.random.Generator
) -> Iterator[list[Array]]:
    """List the places over the body's middle on each of its faces, or where the middle is not over
    it in its own middle, those that look up first; once more for each way in which the hand may be
    turned, in random order.
    """
    points, normals = solid.surface_points(rng, PLACES_LOOKED_FOR)
    faces: list[tuple[Array, list[Array]]] = []
    for point, normal in zip(points, normals, strict=True):
        beside = next((at for one, at in faces if one @ normal > SAME_NORMAL), None)
        if beside is None:
            faces.append((normal, [point]))
        else:
            beside.append(point)

    faces.sort(key=lambda face: -float(np.round(face[0] @ up, 2)))
    places: list[tuple[Array, Array]] = []
    for normal, drawn in faces:
        over = _outermost(solid, solid.centre, normal)
        beside = _outermost(solid, np.mean(drawn, axis=0), normal)
        if over is not None and fit.sealed(over, normal, 0.0, up) is not None:
            places.append((over, normal))
        elif beside is not None and fit.sealed(beside, normal, 0.0, up) is not None:
            places.append((beside, normal))

    for spin in rng.permutation(SPINS_PER_PLACE) * 2 * math.pi / SPINS_PER_PLACE:
        tools = (fit.sealed(point, normal, float(spin), up) for point, normal in places)
        yield [T for T in tools if T is not None]


def _outermost(solid: ConvexUnion, point: Array, normal: Array) -> Array | None:
    """Find where the line through a point leaves the solid for good along a face's normal."""
    starts, ends, _, _ = solid.crossings(point[None], normal)
    met = ends[0][ends[0] > starts[0]]
    return point + float(met.max()) * normal if len(met) else None
