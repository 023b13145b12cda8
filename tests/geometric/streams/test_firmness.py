"""How much of what two pads can hold a body's weight uses up, worked out by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Box
from tamp.geometric.streams.firmness import GRAVITY_M_S2, PATCH_MARGIN_M, SHAKE_SHARE, strain
from tests.geometric.making import body


def test_a_grasp_is_strained_by_weight_times_lever() -> None:
    thing = replace(body("thing", Box((0.3, 0.05, 0.05)), (0.3, 0.2, 0.8)), mass=0.5)
    patch = np.array([(x, 0.0, z) for x in (-0.006, 0.0, 0.006) for z in (-0.006, 0.0, 0.006)])
    up = np.array([0.0, 0.0, -1.0])

    def much(x: float, mass: float = 0.5, friction: float = 0.5, force: float = 50.0) -> float:
        T = np.eye(4)
        T[0, 3] = x
        one = replace(thing, mass=mass, friction=friction)
        return strain(one, np.zeros(3), T, 0.05, (patch, patch), force, (up,))

    levers = [much(x) for x in (0.0, 0.03, 0.06, 0.12)]
    assert levers == sorted(levers) and levers[0] < 0.2
    # By hand: 2 pads x 25 N x the mean distance on the patch against 1.3 x 0.5 kg x 9.81 m/s2 x 12 cm.
    arm = (
        1.3
        * 0.5
        * GRAVITY_M_S2
        * 0.12
        / (2 * 25.0 * (0.001 + float(np.linalg.norm(patch, axis=1).mean())))
    )
    assert much(0.12) == pytest.approx(arm, rel=0.15)
    assert much(0.12) == much(-0.12)
    assert (
        much(0.06, mass=1.0)
        > much(0.06)
        > much(0.06, friction=1.0)
        > much(0.06, friction=1.0, force=100.0)
    )


PATCH = np.array([(x, 0.0, z) for x in (-0.006, 0.006) for z in (-0.004, 0.004)])
"""Of 12 by 8 mm: with its margin it reaches 8 mm along x and 6 mm along z."""
WEIGHT_N = 2.0 * GRAVITY_M_S2
GRIP_N = 0.4 * 50.0
WIDTH_M = 0.05
SLIP = (1.0 + SHAKE_SHARE) * WEIGHT_N / (2 * GRIP_N)


def strained(
    centre: tuple[float, float, float], *ups: tuple[float, float, float],
    T: Array | None = None, patches: tuple[Array, Array] = (PATCH, PATCH),
) -> float:  # fmt: skip
    """Of a body of 2 kg and friction 0.4 in a grip of 50 N, the tool at its origin."""
    thing = replace(body("thing", Box((0.3, 0.05, 0.05)), (0.0, 0.0, 0.0)), mass=2.0, friction=0.4)
    given = [np.array(up) for up in ups]
    pose = np.eye(4) if T is None else T
    return strain(thing, np.array(centre), pose, WIDTH_M, patches, 50.0, given)


@pytest.mark.parametrize("up", [(0.0, 0.0, -1.0), (1.0, 0.0, 0.0)])
def test_held_at_its_middle_it_only_slips(up: tuple[float, float, float]) -> None:
    """Two pads of 20 N of friction each against 1.3 times the weight."""
    assert strained((0.0, 0.0, 0.0), up) == pytest.approx(SLIP)


@pytest.mark.parametrize(
    ("centre", "up", "hold"),
    [
        # About x: pressure moves to an edge along z, 6 mm from the middle, and friction 5 cm apart.
        ((0.0, 0.1, 0.0), (0.0, 0.0, 1.0), 2 * 50.0 * 0.006 + GRIP_N * WIDTH_M),
        # About z: the same along x, 8 mm.
        ((0.0, 0.1, 0.0), (1.0, 0.0, 0.0), 2 * 50.0 * 0.008 + GRIP_N * WIDTH_M),
        # About the closing axis: friction of both patches, whose points are 7.2 mm from the middle.
        (
            (0.1, 0.0, 0.0),
            (0.0, 0.0, 1.0),
            2 * GRIP_N * (PATCH_MARGIN_M / 2 + math.hypot(0.006, 0.004)),
        ),
    ],
)
def test_each_way_to_turn_is_held_by_its_own(
    centre: tuple[float, float, float], up: tuple[float, float, float], hold: float
) -> None:
    """The lever is 10 cm; the worst shake is along the weight, or across it where that is held less."""
    turn = (1.0 + SHAKE_SHARE) * WEIGHT_N * 0.1 / hold
    found = strained(centre, up)
    assert found >= math.hypot(turn, SLIP) - 1e-12
    assert found == pytest.approx(math.hypot(turn, SLIP), rel=0.06)


def test_the_lever_is_that_of_the_centre_in_the_tools_frame() -> None:
    """The tool is 10 cm beside the origin, its axes x, y, z are the body's y, z, x."""
    T = np.eye(4)
    T[:3, :3] = [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    T[:3, 3] = (0.1, 0.0, 0.0)
    up = (0.0, 0.0, 1.0)
    assert strained((0.1, 0.0, 0.1), up, T=T) == pytest.approx(strained((0.0, 0.1, 0.0), up))
    assert strained((0.1, 0.1, 0.0), up, T=T) == pytest.approx(strained((0.1, 0.0, 0.0), up))
    assert strained((0.1, 0.0, 0.0), up, T=T) == pytest.approx(SLIP)


def test_the_worst_of_the_directions_and_the_smaller_patch_count() -> None:
    across, along = (0.0, 0.0, 1.0), (0.0, 1.0, 0.0)
    centre = (0.0, 0.1, 0.0)  # along y there is no lever
    worst = strained(centre, across)
    assert strained(centre, along) < worst
    assert strained(centre, along, across) == strained(centre, across, along) == worst
    small = PATCH / 2
    one = strained(centre, across, patches=(PATCH, small))
    assert one == strained(centre, across, patches=(small, PATCH)) > worst
    assert strained(centre, across, patches=(small, small)) == one
