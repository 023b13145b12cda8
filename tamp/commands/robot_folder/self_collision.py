"""Pairs of a robot's links that can meet: by states drawn at random, by FCL."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from tamp.commands.robot_folder.convex import CollisionElement
from tamp.geometric.collision.arrangement import TRANSIT_CLEARANCE_M
from tamp.geometric.collision.fcl_bodies import FclBody, touch
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.robot.robot import Link, Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose

STATES = 20_000
"""Random states that decide which pairs are checked in plans: 10,000 do for one arm."""

AT_LIMITS = 0.4
"""The share of joints at a limit, in every second state."""

COMPARED = 1500
"""States in which hulls are held against the meshes that they stand for."""

MOSTLY = 0.5
"""The share of states above which a pair that meets touches by its shape, as neighbours do."""

NEAR = TRANSIT_CLEARANCE_M + 5e-4
"""Metres: two links nearer than this count as met, as they do in plans."""

WRONG = 0.01
"""The share of states in which a pair's hulls may meet and its meshes not."""

Pair = tuple[str, str]


def states(robot: Robot, count: int, seed: int) -> Iterator[tuple[Array, float]]:
    """Draw configurations of the arm, the base at the origin, and openings of the fingers."""
    rng = np.random.default_rng(seed)
    lower, upper = np.array(robot.lower), np.array(robot.upper)
    for number in range(count):
        arm = rng.uniform(lower, upper)
        if number % 2:
            at = rng.random(len(arm)) < AT_LIMITS
            arm = np.where(at, np.where(rng.random(len(arm)) < 0.5, lower, upper), arm)
        yield np.concatenate([np.zeros(3), arm]), float(rng.uniform(0.0, robot.opening))


def adjacent(robot: Robot) -> frozenset[Pair]:
    """List the pairs that touch by construction: neighbours in the chain, hand and fingers with the
    last link and among themselves, and the base with the foot.
    """
    chain = (robot.base, robot.foot, *(joint.child for joint in robot.joints))
    pairs = list(pairwise(chain))
    group = (chain[-1], *sorted(robot.grippers))
    pairs += [(a, b) for i, a in enumerate(group) for b in group[i + 1 :]]
    return frozenset((min(a, b), max(a, b)) for a, b in pairs)


def count_meetings(
    robot: Robot, bodies: Mapping[str, FclBody], pairs: Sequence[Pair], count: int, seed: int,
    told: Callable[[float], None], padding: float = 0.0,
) -> dict[Pair, int]:  # fmt: skip
    """Count in how many of `count` states each pair is nearer than the padding, metres."""
    kinematics = Kinematics(robot)
    met = dict.fromkeys(pairs, 0)
    if not pairs:
        return met
    names = list(bodies)
    balls = np.array([_ball(robot.link(name)) for name in names])
    first, second = (np.array([names.index(pair[end]) for pair in pairs]) for end in (0, 1))
    reach = balls[first, 3] + balls[second, 3] + padding

    for number, (conf, opening) in enumerate(states(robot, count, seed)):
        poses = kinematics.link_poses(conf, opening)
        at = np.array([poses[name] for name in names])
        centres = np.einsum("nij,nj->ni", at[:, :3, :3], balls[:, :3]) + at[:, :3, 3]
        gaps = np.linalg.norm(centres[first] - centres[second], axis=1)
        for index in np.flatnonzero(gaps < reach).tolist():
            met[pairs[index]] += meet(bodies, poses, *pairs[index], padding)
        if number % 500 == 0:
            told(number / count)
    return met


def meet(
    bodies: Mapping[str, FclBody], poses: Mapping[str, Array], a: str, b: str, padding: float
) -> bool:
    """Check whether two links are nearer than the padding, metres."""
    return any(
        touch(bodies[a].place(i, poses[a]), bodies[b].place(j, poses[b]), padding)
        for i in range(len(bodies[a].objects))
        for j in range(len(bodies[b].objects))
    )


def _ball(link: Link) -> tuple[float, float, float, float]:
    """Return centre and radius of a ball around a link, in its frame."""
    low, high = bounds(link.parts, Pose())
    x, y, z = ((low + high) / 2).tolist()
    return x, y, z, float(np.linalg.norm(high - low)) / 2 + 1e-3


def hull_bodies(robot: Robot) -> dict[str, FclBody]:
    """Make FCL's objects of the links that have a shape."""
    return {link.name: FclBody(link.parts) for link in robot.links if link.parts}


def checkable(robot: Robot, without: frozenset[Pair]) -> list[Pair]:
    """List pairs of links with shapes, sorted, but for those left out."""
    names = [link.name for link in robot.links if link.parts]
    pairs = ((min(a, b), max(a, b)) for i, a in enumerate(names) for b in names[i + 1 :])
    return [pair for pair in pairs if pair not in without]


def meetings(robot: Robot, told: Callable[[float], None]) -> dict[Pair, int]:
    """Count in how many of STATES random states, half of them with joints at their limits, each
    pair is nearer than plans may be; adjacent ones are left out.
    """
    pairs = checkable(robot, adjacent(robot))
    return count_meetings(robot, hull_bodies(robot), pairs, STATES, 0, told, NEAR)


def allowed_pairs(robot: Robot, met: Mapping[Pair, int]) -> tuple[frozenset[Pair], tuple[str, ...]]:
    """Find the pairs that plans need not check: adjacent ones, and those that met never, or mostly.
    What meets the base in some states and not in all is checked: it is the arm that goes there.

    Returns:
        The pairs, and a sentence about each that met mostly but not always.
    """
    mostly = {
        pair: count / STATES
        for pair, count in met.items()
        if count == STATES or (count > MOSTLY * STATES and robot.base not in pair)
    }
    remarks = [
        f"{first} and {second} meet in {share:.0%} of states: taken for neighbours, not checked"
        for (first, second), share in sorted(mostly.items())
        if share < 1.0
    ]
    never = {pair for pair, count in met.items() if not count}
    return adjacent(robot) | never | {*mostly}, tuple(remarks)


def misjudged(
    robot: Robot, solids: Mapping[str, Sequence[CollisionElement]], told: Callable[[float], None]
) -> set[str]:
    """Find the links of the arm whose hull meets others in over WRONG more states than the mesh."""
    pairs = [
        pair for pair in checkable(robot, adjacent(robot)) if any(name in solids for name in pair)
    ]
    hulls = hull_bodies(robot)
    by_hulls = count_meetings(robot, hulls, pairs, COMPARED, 1, lambda done: told(done / 2))
    suspects = [pair for pair, count in by_hulls.items() if 0 < count > WRONG * COMPARED]
    meshes = {
        name: FclBody.of_meshes((one.vertices, one.faces) for one in solids[name])
        if name in solids
        else body
        for name, body in hulls.items()
    }
    by_meshes = count_meetings(
        robot, meshes, suspects, COMPARED, 1, lambda done: told(0.5 + done / 2)
    )
    wrong = [pair for pair in suspects if by_hulls[pair] - by_meshes[pair] > WRONG * COMPARED]
    return {name for pair in wrong for name in pair if name in solids}


def home_collision(robot: Robot, arm: Sequence[float] | Array) -> Pair | None:
    """Return a pair that is checked and meets at a configuration of the arm, open or closed, or is
    nearer there than plans may be.
    """
    kinematics, bodies = Kinematics(robot), hull_bodies(robot)
    pairs = checkable(robot, robot.allowed)
    conf = np.concatenate([np.zeros(3), arm])
    for opening in (0.001, robot.opening):
        poses = kinematics.link_poses(conf, opening)
        for first, second in pairs:
            if meet(bodies, poses, first, second, NEAR):
                return first, second
    return None
