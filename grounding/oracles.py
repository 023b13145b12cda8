"""Two judges of a pose: the paper's by bounding boxes (MCA), and ours, which drops the body."""

from __future__ import annotations

import math
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from grounding.body_geometry import BodyGeometry
from grounding.relation_scene import Placed, Region, RelationScene, gap
from grounding.separation import Obstacles, separations
from tamp.geometric.scene.pose import Array
from tamp.simulation.drops import Drops, Item

NEAR = 0.03
"""`on`: the lowest point is this near to the surface (the paper's tolerance), metres."""

DEPTH = 0.001
"""Bodies may lie this deep in each other, metres."""

MOVED, TURNED, SECONDS = 0.03, math.radians(10.0), 1.5
"""A body is settled that moved and turned less than this in so many seconds of simulation."""

DROP_NEIGHBOURS_M = 0.15
"""Bodies farther away than this play no part in a drop test, metres."""

INSIDE_SLACK_M = 0.002
"""`inside`: the body may stick out by this much, metres."""


class Verdict(StrEnum):
    """The judges' verdict; all but `HOLDS` are failures, in the order in which they are looked for.

    The paper's knows neither `PENETRATES` nor `TIPS`.
    """

    HOLDS = "holds"
    TOO_LOW = "too low"
    TOO_HIGH = "too high"
    OUTSIDE = "outside"
    OVERLAPPING = "outside but overlapping"
    PENETRATES = "penetrates support"
    COLLIDES = "collides"
    TIPS = "tips over"


def paper_oracle(situation: RelationScene, poses: Array) -> NDArray[np.bool_]:
    """Judge poses T_world_body, shape (n, 4, 4), by the paper's manual classification accuracy
    (section IV-B).

    `on`: the bottom of the box around the body within NEAR of the surface, the box's centre above
    the surface. `inside`: the box around the body, along the container's axes, in the container's
    box up to SLACK. Both: no collision with the surrounding bodies, for which the paper asks a
    simulator and we their convex hulls.
    """
    return np.array(
        [verdict is Verdict.HOLDS for verdict in paper_verdicts(situation, poses)], dtype=bool
    )


def paper_verdicts(situation: RelationScene, poses: Array) -> list[Verdict]:
    """Judge as `paper_oracle` does, with the type of each failure (the paper's figure 6): the first
    that is true of too low, too high, outside (with or without overlap, seen from above), collides.
    """
    region, form = situation.region, situation.body.form
    frame = situation.support.matrix if region.hollow else situation.T_world_region
    inner = np.linalg.inv(frame) @ poses
    points = form.vertices @ inner[:, :3, :3].transpose(0, 2, 1) + inner[:, None, :3, 3]
    low, high = points.min(axis=1), points.max(axis=1)
    if region.hollow:
        floor, top, least, most = (
            region.box[0, 2],
            region.box[1, 2],
            region.box[0, :2],
            region.box[1, :2],
        )
        too_low, too_high = low[:, 2] < floor - INSIDE_SLACK_M, high[:, 2] > top + INSIDE_SLACK_M
        within = (low[:, :2] >= least - INSIDE_SLACK_M).all(axis=1) & (
            high[:, :2] <= most + INSIDE_SLACK_M
        ).all(axis=1)
    else:
        least, most = -region.size[:2] / 2, region.size[:2] / 2
        too_low, too_high = low[:, 2] < -NEAR, low[:, 2] > NEAR
        within = (np.abs((low + high)[:, :2] / 2) <= most).all(axis=1)

    overlaps = (low[:, :2] < most).all(axis=1) & (high[:, :2] > least).all(axis=1)
    free = (separations(form, poses, Obstacles(situation.others)) > -DEPTH).all(axis=1)
    failed = {
        Verdict.TOO_LOW: too_low,
        Verdict.TOO_HIGH: too_high,
        Verdict.OVERLAPPING: ~within & overlaps,
        Verdict.OUTSIDE: ~within,
        Verdict.COLLIDES: ~free,
    }
    return [
        next((name for name, true in failed.items() if true[row]), Verdict.HOLDS)
        for row in range(len(poses))
    ]


def drop_verdicts(
    situation: RelationScene, poses: Array, drops: Drops, items: ItemOf
) -> list[Verdict]:
    """Judge by a physics simulation whether the relation holds with the body at each of the poses,
    shape (n, 4, 4), and goes on holding.
    """
    if not len(poses):
        return []
    boxes = [Placed(situation.body.form, pose).box for pose in poses if np.isfinite(pose).all()]
    others = [
        other
        for other in situation.others
        if any(gap(other.box, box) < DROP_NEIGHBOURS_M for box in boxes)
    ]
    bodies = [situation.support, *others]
    drops.set_up(items(situation.body.form), [(items(body.form), body.matrix) for body in bodies])
    return [_judge(situation, pose, drops) for pose in poses]


def place_verdict(region: Region, form: BodyGeometry, T_region_body: Array) -> Verdict:
    """Judge a body's place by geometry alone, contacts left out: HOLDS, or what is wrong with the
    place.
    """
    points = form.vertices @ T_region_body[:3, :3].T + T_region_body[:3, 3]
    low, high = points.min(axis=0), points.max(axis=0)
    half = region.size[:2] / 2
    if low[2] < -NEAR:
        return Verdict.TOO_LOW
    if (low[2] > NEAR) if not region.hollow else (high[2] > region.size[2] + INSIDE_SLACK_M):
        return Verdict.TOO_HIGH
    centre = T_region_body[:3, :3] @ form.centre_of_mass + T_region_body[:3, 3]
    if region.hollow:
        good = bool(
            (low[:2] >= -half - INSIDE_SLACK_M).all() and (high[:2] <= half + INSIDE_SLACK_M).all()
        )
    else:
        good = bool((np.abs(centre[:2]) <= half).all())
    if good:
        return Verdict.HOLDS
    overlaps = bool((low[:2] < half).all() and (high[:2] > -half).all())
    return Verdict.OVERLAPPING if overlaps else Verdict.OUTSIDE


class ItemOf:
    """The engine's item of a form, made once for each form's parts and scale."""

    def __init__(self) -> None:
        self._items: dict[tuple[int, float], tuple[BodyGeometry, Item]] = {}

    def __call__(self, form: BodyGeometry) -> Item:
        """Return the same item for the same unit form and scale."""
        key = id(form.unit), form.scale
        if key not in self._items:
            self._items[key] = form, Item(form.parts)
        return self._items[key][1]


def _judge(situation: RelationScene, pose: Array, drops: Drops) -> Verdict:
    if not np.isfinite(pose).all() or np.abs(pose).max() > 100.0:
        return Verdict.OUTSIDE
    region, form = situation.region, situation.body.form
    T_region_world = np.linalg.inv(situation.T_world_region)
    place = place_verdict(region, form, T_region_world @ pose)
    if place is not Verdict.HOLDS:
        return place
    deep = [
        contact.obstacle for contact in drops.contacts(pose, 0.001) if contact.distance < -DEPTH
    ]
    if deep:
        return Verdict.PENETRATES if 0 in deep or -1 in deep else Verdict.COLLIDES
    after = drops.drop(pose, SECONDS)
    if moved(form, pose, after) >= MOVED or turned(pose, after) >= TURNED:
        return Verdict.TIPS
    holds = place_verdict(region, form, T_region_world @ after) is Verdict.HOLDS
    return Verdict.HOLDS if holds else Verdict.TIPS


def moved(form: BodyGeometry, before: Array, after: Array) -> float:
    """Return how far the centre of mass went, metres."""
    centre = form.centre_of_mass
    return float(
        np.linalg.norm((after[:3, :3] - before[:3, :3]) @ centre + after[:3, 3] - before[:3, 3])
    )


def turned(before: Array, after: Array) -> float:
    """Compute the angle between two orientations, radians."""
    cosine = (np.trace(before[:3, :3].T @ after[:3, :3]) - 1) / 2
    return math.acos(float(np.clip(cosine, -1.0, 1.0)))
