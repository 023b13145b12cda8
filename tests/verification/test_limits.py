"""The judge's limits of range, speed and acceleration, on motions whose excess is known in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.scene import Room
from tamp.plan.read import StoredSegment
from tamp.verification.limits import LimitViolation, check_ranges, limit_violations
from tamp.verification.makers_limits import PANDA_MOBILE, limits_of
from tests.plan.making import arm, base, close, plan_of

ROOM = Room((-2.0, 2.0), (-1.0, 1.0))
FASTEST, HARSHEST = PANDA_MOBILE.velocity[0], PANDA_MOBILE.acceleration[0]


@pytest.fixture(scope="module")
def robot() -> Robot:
    return ROBOTS["panda_mobile"]()


def found(robot: Robot, *segments: StoredSegment) -> dict[str, LimitViolation]:
    return {excess.kind: excess for excess in limit_violations(segments, robot, ROOM)}


def ramp(distance: float, acceleration: float, count: int = 41) -> StoredSegment:
    """The base from rest to rest along x with one acceleration up to the middle and the same to brake."""
    half = np.sqrt(distance / acceleration)
    times = np.linspace(0.0, 2 * half, count)
    first = 0.5 * acceleration * times**2
    x = np.where(times <= half, first, distance - 0.5 * acceleration * (2 * half - times) ** 2)
    return base(times, np.column_stack([x, 0 * x, 0 * x]))


def test_a_motion_within_all_limits_has_no_excess(robot: Robot) -> None:
    assert found(robot, ramp(0.3, 0.9 * HARSHEST)) == {}
    assert found(robot, close("cup", seconds=1.0)) == {}


@pytest.mark.parametrize(("over", "harsh"), [(1.1, False), (1.4, True), (3.0, True)])
def test_constant_acceleration_is_measured_as_it_is(robot: Robot, over: float, harsh: bool) -> None:
    told = found(robot, ramp(0.02, over * HARSHEST))  # slow enough to keep the speed's limit
    assert ("acceleration" in told) == harsh and "velocity" not in told
    if harsh:
        # The middle, where push turns into brake at once, is no harsher than either.
        assert told["acceleration"].amount == pytest.approx((over - 1.0) * HARSHEST, rel=0.02)


def test_a_constant_speed_above_the_limit_is_told_with_what_it_is_over(robot: Robot) -> None:
    told = found(
        robot, base([0.0, 1.0, 2.0], [[0, 0, 0], [0.9 * FASTEST, 0, 0], [2.1 * FASTEST, 0, 0]])
    )
    fast = told["velocity"]
    assert fast.message == f"base x is too fast: {1.2 * FASTEST:.4g}, {0.2 * FASTEST:.2g} over"
    assert (fast.time, fast.amount) == pytest.approx((1.0, 0.2 * FASTEST))


def test_two_hundredths_over_are_still_kept(robot: Robot) -> None:
    for share, kept in ((1.015, True), (1.03, False)):
        told = found(robot, base([0.0, 2.0], [[0, 0, 0], [2 * share * FASTEST, 0, 0]]))
        assert ("velocity" not in told) == kept


def test_it_starts_and_ends_at_rest(robot: Robot) -> None:
    # Half of the speed limit from the first moment: the jump takes a tenth of a second at most.
    told = found(
        robot, base(np.linspace(0, 1, 11), np.linspace([0, 0, 0], [0.5 * FASTEST, 0, 0], 11))
    )
    assert told["acceleration"].amount == pytest.approx(0.5 * FASTEST / 0.05 - HARSHEST, rel=1e-6)


def test_out_of_the_room_is_told_at_its_worst(robot: Robot) -> None:
    rows = [[1.9, 0, 0], [2.0, 0, 0], [2.3, 0, 0], [2.1, 0, 0]]
    told = found(robot, base([0, 1, 2, 3], rows))["limit"]
    assert told.message == "base x is out of range: 2.3, 0.3 over" and told.time == 2.0
    assert "limit" not in found(robot, base([0, 1], [[2.00005, 0, 0], [2.0, 0, 0]]))  # rounding


def test_a_yaw_has_no_range(robot: Robot) -> None:
    assert "limit" not in found(robot, base([0, 100], [[0, 0, 0], [0, 0, 50.0]]))


@pytest.mark.parametrize("joint", range(7))
def test_each_joint_has_the_makers_range(robot: Robot, joint: int) -> None:
    for limit, beyond in ((PANDA_MOBILE.upper[joint], 0.01), (PANDA_MOBILE.lower[joint], -0.01)):
        inside, outside = np.array(robot.home), np.array(robot.home)
        inside[joint], outside[joint] = limit, limit + beyond
        assert "limit" not in found(robot, arm([0, 9], [inside, inside]))
        told = found(robot, arm([0, 9], [inside, outside]))["limit"]
        assert robot.joints[joint].name in told.message and told.amount == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("drive", "told"), [("omnidirectional", False), ("differential", True), ("fixed", True)]
)
def test_wheels_do_not_slide_sideways_and_a_fixed_base_not_at_all(
    robot: Robot, drive: str, told: bool
) -> None:
    sideways = base([0, 9], [[0, 0, 0], [0, 0.5, 0]])
    found_ = found(replace(robot, drive=drive), sideways)
    assert ("limit" in found_) == told
    ahead = found(replace(robot, drive=drive), base([0, 9], [[0, 0, 0], [0.5, 0, 0]]))
    assert ("limit" in ahead) == (drive == "fixed")
    if drive == "differential":
        assert (
            found_["limit"].message == "the base slides sideways by 5e+02 mm, and its wheels do not"
        )
    if drive == "fixed":
        assert ahead["limit"].message == "the base moves by 0.5, and it is fixed"


def test_a_car_turns_no_tighter_than_it_can_and_not_on_the_spot(robot: Robot) -> None:
    car = replace(robot, drive="car", turning_radius=0.5)

    def arc(radius: float) -> StoredSegment:
        """A quarter of a circle to the left, driven backwards."""
        turned = np.linspace(0.0, -np.pi / 2, 200)
        rows = np.column_stack([radius * np.sin(turned), radius * (1 - np.cos(turned)), turned])
        return base(np.linspace(0, 60, 200), rows)

    assert "limit" not in found(car, arc(0.5))
    tight = found(car, arc(0.45))["limit"]
    assert "it is a car that turns within 0.5 m" in tight.message
    assert "limit" in found(car, base([0, 9], [[0, 0, 0], [0, 0, 0.5]]))
    assert "limit" in found(car, base([0, 9], [[0, 0, 0], [0, 0.5, 0]]))
    assert "limit" not in found(car, base([0, 9], [[0, 0, 0], [0.5, 0, 0]]))


def test_fingers_open_no_wider_and_no_faster_than_they_can(robot: Robot) -> None:
    wide = StoredSegment("gripper", np.array([0.0, 1.0]), np.empty((2, 0)), np.array([0.08, 0.09]))
    assert found(robot, wide)["limit"].amount == pytest.approx(0.01)
    quick = StoredSegment("gripper", np.array([0.0, 0.1]), np.empty((2, 0)), np.array([0.08, 0.02]))
    # Both fingers move: 0.1 m/s between them.
    assert found(robot, quick)["velocity"].amount == pytest.approx(0.6 - 0.1)


@pytest.mark.parametrize("times", [[0, 0, 1], [0, 2, 1]])
def test_times_have_to_increase(robot: Robot, times: list[float]) -> None:
    told = found(robot, base(times, [[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]]))
    assert list(told) == ["time"] and told["time"].message == "times of the base do not increase"


def test_segments_of_one_part_are_one_motion(robot: Robot) -> None:
    whole = ramp(0.3, 0.9 * HARSHEST)
    cut = 15
    first = base(whole.times[: cut + 1], whole.positions[: cut + 1])
    second = base(whole.times[cut:] - whole.times[cut], whole.positions[cut:])
    assert found(robot, first, second) == {}
    assert (
        found(robot, first)["acceleration"].time == first.times[-1]
    )  # alone it ends at full speed


def test_before_it_is_carried_out_a_plan_has_to_keep_its_ranges(robot: Robot) -> None:
    fine = base([0, 9], [[0, 0, 0], [1, 0, 0]])
    out = base([0, 5, 9], [[1, 0, 0], [1, 1.5, 0], [1, 0, 0]])
    check_ranges(plan_of(("move", (), [fine])), robot, ROOM)
    with pytest.raises(
        InputError,
        match=r"2 move, 14.00 s: base y is out of range: 1.5, 0.5 over: the robot cannot",
    ):
        check_ranges(plan_of(("move", (), [fine]), ("move", (), [out])), robot, ROOM)


@pytest.mark.parametrize("count", [41, 401, 4001])
def test_dense_samples_hide_no_acceleration(robot: Robot, count: int) -> None:
    limit = float(limits_of(robot).acceleration[0])
    assert "acceleration" in found(robot, ramp(1.0, 1.6 * limit, count))
    assert "acceleration" not in found(robot, ramp(1.0, 0.98 * limit, count))
