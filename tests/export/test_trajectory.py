"""A plan's motions in time: joints by part, one stretch after the other, velocities of rest."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.export.trajectory import rates
from tests.export.known import ACTIONS, FINGERS, PLAN


def test_rates_of_constant_acceleration_are_exact() -> None:
    times = np.array([0.0, 0.1, 0.25, 0.3, 0.5])
    velocities = rates(times, (1.5 * times**2)[:, None])
    assert velocities[1:-1, 0] == pytest.approx(3.0 * times[1:-1])


def test_stretches_follow_each_other_from_the_plans_start() -> None:
    starts = [stretch.times[0] for action in ACTIONS for stretch in action.stretches]
    ends = [stretch.times[-1] for action in ACTIONS for stretch in action.stretches]
    assert starts == pytest.approx([0.0, 2.0, 3.0, 3.5, 4.5])
    assert ends == pytest.approx([2.0, 3.0, 3.5, 4.5, 5.0]) and ends[-1] == PLAN.duration


def test_each_finger_stands_at_half_the_opening() -> None:
    gripper = ACTIONS[1].stretches[1]
    assert (gripper.part, gripper.joints, gripper.attach) == ("gripper", FINGERS, "cup")
    assert gripper.positions == pytest.approx(np.array([[0.04, 0.04], [0.025, 0.025]]))
    assert ACTIONS[2].stretches[0].detach == "cup"


def test_rates_lie_between_the_slopes_beside_them_and_rest_at_the_ends() -> None:
    times = np.array([0.0, 1.0, 1.5, 4.0])
    positions = np.array([[0.0], [2.0], [1.0], [1.0]])
    found = rates(times, positions)[:, 0]
    assert found[0] == found[-1] == 0.0
    # Of slopes 2 over one second and -2 over half a one, the nearer counts double: (2 * 0.5 - 2 * 1) / 1.5.
    assert found[1] == pytest.approx(-2 / 3)
    assert found[2] == pytest.approx((-2.0 * 2.5 + 0.0 * 0.5) / 3.0)
    assert rates(times[:2], positions[:2]).tolist() == [[0.0], [0.0]]
