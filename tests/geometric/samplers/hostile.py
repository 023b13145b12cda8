"""Generators that no planner should depend on."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.random import Generator as Random

from tamp.geometric.samplers.placements import SurfacePlacements
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import placed_pose
from tamp.geometric.stability.stable_poses import stable_faces_of

Propose = Callable[[Scene, Sequence[str], int, Random], Any]


def at_rest(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> list[Pose]:
    """World poses that the hand-made sampler would take."""
    T_world_region, faces = (
        scene.world_pose(scene.region(arguments[1])),
        stable_faces_of(scene.bodies[arguments[0]]),
    )
    placements = SurfacePlacements().propose(scene, arguments, count, rng)
    return [placed_pose(faces, placement, T_world_region) for placement in placements]


class Hostile:
    """A generator that does as its function does."""

    def __init__(self, propose: Propose) -> None:
        self.calls = 0
        self._propose = propose

    def propose(self, scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
        self.calls += 1
        return self._propose(scene, arguments, count, rng)


def constant(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose((1.0, 1.0, 0.5))] * count


def constant_and_good(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    """One pose that can be used, again and again."""
    return SurfacePlacements().propose(scene, arguments, 1, np.random.default_rng(0)) * count


def one_at_a_time(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose((1.0, 1.0, 0.5))]


def not_finite(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose((float("nan"), 0.0, 0.0)) for _ in range(count)]


def infinite(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose((0.0, 0.0, float("inf"))) for _ in range(count)]


def no_rotation(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)) for _ in range(count)]


def far_away(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose(tuple(1e4 * rng.normal(size=3))) for _ in range(count)]


def a_room_away(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose(tuple(rng.uniform(20.0, 30.0, 3))) for _ in range(count)]


def sunken(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    poses = at_rest(scene, arguments, count, rng)
    return [
        Pose((pose.position[0], pose.position[1], pose.position[2] - 0.1), pose.quaternion)
        for pose in poses
    ]


def into_others(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    """At rest, but where something stands already: the fluents know."""
    z = at_rest(scene, arguments, 1, rng)[0].position[2]
    others = [
        body.pose.position
        for name, body in scene.bodies.items()
        if body.movable and name != arguments[0]
    ]
    spots = [others[int(rng.integers(len(others)))] for _ in range(count)]
    return [Pose((x + rng.normal(0, 1e-3), y + rng.normal(0, 1e-3), z)) for x, y, _ in spots]


def at_the_edge(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    """Accepted by the first tests, and all of it in one corner."""
    poses = at_rest(scene, arguments, 200, rng)
    return sorted(poses, key=lambda pose: pose.position[0] + pose.position[1])[:count]


def wrong_type(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return "on the table, please"


def matrices(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return np.tile(np.eye(4), (count, 1, 1))


def nothing(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return None


def strings_inside(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return [Pose(("a", "b", "c")) for _ in range(count)]


def arrays_inside(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    """No tuples, as the type says, but usable."""
    poses = at_rest(scene, arguments, count, rng)
    return [Pose(np.array(pose.position), np.array(pose.quaternion)) for pose in poses]


def endless_list(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return (Pose((float(number), 0.0, 0.0)) for number in itertools.count())


def raising(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    raise ValueError("the weights are gone")


def exiting(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    raise SystemExit(3)


def recursive(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    return recursive(scene, arguments, count, rng)


def vandal(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    for mapping in (scene.bodies, scene.surfaces, scene.cavities):
        mapping.clear()  # type: ignore[attr-defined]
    return [Pose((0.0, 0.0, -1.0 - float(x))) for x in rng.random(count)]


def gambler(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    """Uses up random numbers."""
    rng.random(10_000)
    return []


def sleeping(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    time.sleep(3600.0)


def napping(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    time.sleep(0.06)
    return a_room_away(scene, arguments, count, rng)


def spinning(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    while True:
        pass


def stubborn(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    """Swallows whatever is raised at it."""
    while True:
        try:
            while True:
                time.sleep(0.01)
        except BaseException:
            continue


def sleeping_list(scene: Scene, arguments: Sequence[str], count: int, rng: Random) -> Any:
    for _ in range(count):
        time.sleep(3600.0)
        yield Pose()


REPORTED: dict[str, tuple[Propose, str]] = {
    "constant": (constant, "again and again"),
    "constant-and-good": (constant_and_good, "again and again"),
    "not-finite": (not_finite, "not finite"),
    "infinite": (infinite, "not finite"),
    "no-rotation": (no_rotation, "no rotation"),
    "far-away": (far_away, "m away"),
    "a-room-away": (a_room_away, "of use"),
    "sunken": (sunken, "too low"),
    "into-others": (into_others, "of use"),
    "wrong-type": (wrong_type, "a str, not a pose"),
    "matrices": (matrices, "a ndarray, not a pose"),
    "nothing": (nothing, "a NoneType, not a list"),
    "strings-inside": (strings_inside, "seven numbers"),
    "endless-list": (endless_list, "again and again"),
    "raising": (raising, "raised ValueError: the weights are gone"),
    "exiting": (exiting, "raised SystemExit"),
    "recursive": (recursive, "raised RecursionError"),
    "vandal": (vandal, "of use"),
    "sleeping": (sleeping, "took more than"),
    "spinning": (spinning, "took more than"),
    "stubborn": (stubborn, "took more than"),
    "sleeping-list": (sleeping_list, "took more than"),
}
"""What is noticed in any run, and what is said about it."""

UNREPORTED: dict[str, Propose] = {
    "one-at-a-time": one_at_a_time,
    "at-the-edge": at_the_edge,
    "arrays-inside": arrays_inside,
    "gambler": gambler,
    "napping": napping,
}
"""What may or may not be noticed before the plan is found, since it does little harm."""
