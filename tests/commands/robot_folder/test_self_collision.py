"""Which pairs of links can meet: drawn states, neighbours by construction, and what is never checked."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tamp.commands.robot_folder import self_collision
from tamp.commands.robot_folder.convex import CollisionElement
from tamp.commands.robot_folder.self_collision import (
    NEAR,
    adjacent,
    allowed_pairs,
    checkable,
    count_meetings,
    home_collision,
    hull_bodies,
    meet,
    misjudged,
    states,
)
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.kinematics import Kinematics
from tamp.geometric.scene.scene import Hull

UR5 = ROBOTS["ur5"]()
CHAIN = (UR5.base, UR5.foot, *(joint.child for joint in UR5.joints))


def pair(first: str, second: str) -> tuple[str, str]:
    return min(first, second), max(first, second)


def never(_: float) -> None: ...


def test_states_are_within_the_limits_and_every_second_one_at_some() -> None:
    lower, upper = np.array(UR5.lower), np.array(UR5.upper)
    drawn = list(states(UR5, 200, seed=0))
    at_limits = [int(((q[3:] == lower) | (q[3:] == upper)).sum()) for q, _ in drawn]
    assert len(drawn) == 200 and not any(at_limits[::2])
    assert sum(at_limits[1::2]) / (100 * len(lower)) == pytest.approx(0.4, abs=0.08)
    for q, opening in drawn:
        assert (q[:3] == 0).all() and (lower <= q[3:]).all() and (q[3:] <= upper).all()
        assert 0.0 <= opening <= UR5.opening
    again = [q.tolist() for q, _ in states(UR5, 200, seed=0)]
    assert again == [q.tolist() for q, _ in drawn]


def test_neighbours_touch_by_construction_and_so_does_the_hand_with_its_fingers() -> None:
    pairs = adjacent(UR5)
    assert {pair(a, b) for a, b in pairwise(CHAIN)} <= pairs
    group = (CHAIN[-1], *UR5.grippers)
    assert {pair(a, b) for a in group for b in group if a != b} <= pairs
    assert pair(CHAIN[0], CHAIN[2]) not in pairs and pair(CHAIN[2], CHAIN[4]) not in pairs
    assert len(pairs) == len(CHAIN) - 1 + len(group) * (len(group) - 1) // 2


def test_what_is_checked_are_pairs_of_links_with_shapes() -> None:
    shaped = [link.name for link in UR5.links if link.parts]
    every = checkable(UR5, frozenset())
    assert len(every) == len(shaped) * (len(shaped) - 1) // 2 and every[0][0] < every[0][1]
    assert set(every) - set(checkable(UR5, adjacent(UR5))) == adjacent(UR5) & set(every)
    bare = replace(UR5, links=tuple(replace(link, parts=()) for link in UR5.links))
    assert checkable(bare, frozenset()) == []


def test_pairs_that_met_never_or_mostly_need_no_check(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(self_collision, "STATES", 100)
    a, b, c, d = CHAIN[2], CHAIN[4], CHAIN[5], CHAIN[7]
    met = {
        pair(a, b): 0,
        pair(a, c): 51,
        pair(b, d): 50,
        pair(UR5.base, c): 99,
        pair(UR5.base, d): 100,
    }
    allowed, remarks = allowed_pairs(UR5, met)
    assert allowed == adjacent(UR5) | {pair(a, b), pair(a, c), pair(UR5.base, d)}
    first, second = pair(a, c)
    assert remarks == (
        f"{first} and {second} meet in 51% of states: taken for neighbours, not checked",
    )


@pytest.mark.parametrize("padding", [NEAR, 0.1])
def test_the_count_is_that_of_asking_about_each_pair_in_each_state(padding: float) -> None:
    bodies, kinematics = hull_bodies(UR5), Kinematics(UR5)
    pairs = checkable(UR5, adjacent(UR5))
    expected = dict.fromkeys(pairs, 0)
    for q, opening in states(UR5, 60, seed=0):
        poses = kinematics.link_poses(q, opening)
        for first, second in pairs:
            expected[first, second] += meet(bodies, poses, first, second, padding)
    assert count_meetings(UR5, bodies, pairs, 60, 0, never, padding) == expected
    assert 0 < sum(expected.values()) < 60 * len(pairs)
    assert count_meetings(UR5, bodies, [], 60, 0, never) == {}


def test_a_hull_is_misjudged_where_its_mesh_meets_less(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(self_collision, "COMPARED", 100)
    (hand,) = [link for link in UR5.links if link.name == UR5.hand]
    shapes = [(part.pose, part.shape) for part in hand.parts if isinstance(part.shape, Hull)]
    assert shapes
    same = [
        CollisionElement(pose.apply(hull.vertices), hull.faces, (hull,)) for pose, hull in shapes
    ]
    assert misjudged(UR5, {UR5.hand: same}, never) == set()
    small = [replace(one, vertices=one.vertices * 1e-3 + (0, 0, 9)) for one in same]  # far away
    assert misjudged(UR5, {UR5.hand: small}, never) == {UR5.hand}


def test_home_is_free_where_nothing_that_is_checked_meets() -> None:
    assert home_collision(UR5, UR5.home) is None
    folded = np.array(UR5.home)
    folded[2] = UR5.upper[2]  # the forearm back on the upper arm, and beyond
    met = home_collision(UR5, folded)
    assert met is not None and met not in UR5.allowed
    everything = frozenset(checkable(UR5, frozenset()))
    assert home_collision(replace(UR5, allowed=everything), folded) is None
