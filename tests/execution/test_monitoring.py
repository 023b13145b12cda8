"""What a watch tells of an action: the largest lag, and touches that nobody wanted."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.execution.monitoring import LEAST_CONTACT_FORCE_N, ContactEvent, ContactMonitor
from tamp.simulation.world import FLOOR_NAME
from tests.execution.worlds import Noting


def watched(world: Noting, active: str | None = None) -> ContactMonitor:
    return ContactMonitor(world, active)  # type: ignore[arg-type]


def test_the_largest_lag_is_kept_of_base_and_arm_apart() -> None:
    world = Noting()
    watch = watched(world)
    for lag in (
        [0.003, 0.004, 1.0, 0.02, 0, 0, 0, 0, 0, 0],
        [0.001, 0, 0, 0, 0, 0, 0, 0, 0, -0.05],
    ):
        world.lag = np.array(lag)
        watch.look()
    assert watch.base == pytest.approx(0.005)  # a distance on the floor: the yaw is no metre
    assert watch.arm == pytest.approx(0.05)


def test_the_hardest_touch_of_a_pair_is_kept() -> None:
    world = Noting("cup")
    watch = watched(world)
    for force in (2.0, 7.0, 3.0):
        world.felt = {("arm", "cup"): force}
        watch.look()
    assert watch.unwanted() == (ContactEvent("arm", "cup", 7.0),)


@pytest.mark.parametrize(
    ("pair", "active", "wanted"),
    [
        (("left", "cup"), "cup", True),  # the hand handles it
        (("hand", "cup"), "cup", True),
        (("arm", "cup"), "cup", False),  # an elbow never does
        (("left", "cup"), "box", False),  # nor the hand another body
        (("left", "table"), None, False),
        (("cup", "box"), "cup", False),  # they touched only in between
        ((FLOOR_NAME, FLOOR_NAME), None, True),
    ],
)
def test_what_may_touch_what(pair: tuple[str, str], active: str | None, wanted: bool) -> None:
    world = Noting("cup", "box")
    watch = watched(world, active)
    world.felt = {pair: 5.0}
    watch.look()
    world.felt = {}
    assert (watch.unwanted() == ()) == wanted


@pytest.mark.parametrize("when", ["before", "after"])
def test_a_body_may_touch_what_it_rests_on_before_or_after(when: str) -> None:
    world, rests = Noting("cup"), {("cup", "table"): 5.0}
    world.felt = rests if when == "before" else {}
    watch = watched(world, "cup")
    world.felt = rests
    watch.look()
    world.felt = rests if when == "after" else {}
    assert watch.unwanted() == ()


def test_a_weak_touch_is_not_told() -> None:
    world = Noting("cup")
    watch = watched(world)
    for body, force in (("a", 0.99 * LEAST_CONTACT_FORCE_N), ("b", LEAST_CONTACT_FORCE_N)):
        world.felt = {("arm", body): force}
        watch.look()
    assert [touch.second for touch in watch.unwanted()] == ["b"]
