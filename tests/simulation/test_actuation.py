"""What the robot on motors is told of its hands: by name or by number, one in use at a time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.scene import RobotStart, Scene
from tamp.simulation.actuation import (
    BETWEEN_FINGERS_M,
    BETWEEN_HANDS_M,
    COMMANDS_PER_SECOND,
    Hand,
    MotorSimulation,
    contact_pair,
)
from tests.simulation.scenes import scene_of, without_an_engine

LINKS = frozenset({"base", "finger", "hand"})


@pytest.mark.parametrize(
    ("names", "of_robot", "pair"),
    [
        (("cup", "finger"), (False, True), ("finger", "cup")),
        (("finger", "base"), (True, False), ("finger", "base")),  # a body named as a link
        (("base", "finger"), (False, True), ("finger", "base")),
        (("plate", "cup"), (False, False), ("cup", "plate")),
        (("base", "cup"), (False, False), ("cup", "base")),
        (("cup", "base"), (False, False), ("cup", "base")),
    ],
)
def test_a_body_may_be_named_as_a_link(
    names: tuple[str, str], of_robot: tuple[bool, bool], pair: tuple[str, str]
) -> None:
    assert contact_pair(*names, of_robot, LINKS) == pair


class Counting(MotorSimulation):
    """One that counts its steps, with as many arms as its robot."""

    def __init__(self, robot: Robot, scene: Scene) -> None:
        self.steps = 0
        self.begin(robot, scene)

    def step_motors(self, rates: Sequence[float] | None = None) -> None:
        self.steps += 1


MOTORS = without_an_engine(Counting)

TWO = ROBOTS["two_pandas"]()
FIRST, SECOND = (arm.arm for arm in TWO.arms)


@pytest.fixture
def motors() -> Counting:
    start = RobotStart("two_pandas", (1.0, 2.0, 0.5), tuple(0.1 * n for n in range(7)))
    return MOTORS(TWO, replace(scene_of(), robot=start))


def test_it_sets_out_at_the_start_with_open_hands(motors: Counting) -> None:
    """The first arm where the scene has it, the others at home."""
    expected = [1.0, 2.0, 0.5, *(0.1 * n for n in range(7)), *TWO.arms[1].home]
    assert motors.conf == pytest.approx(expected)
    assert [hand.opening for hand in motors.hands] == [arm.opening for arm in TWO.arms]
    at_home = MOTORS(TWO, scene_of())
    assert at_home.conf[3:10] == pytest.approx(TWO.home)


def test_what_is_of_one_hand_is_of_the_arm_in_use(motors: Counting) -> None:
    assert motors.joints == slice(3, 10)
    motors.use(SECOND)
    assert motors.joints == slice(10, 17)
    motors.opening, motors.squeezing, motors.hand.bound = 0.02, True, "cup"
    assert motors.hands[1] == Hand(0.02, True, "cup") and motors.bound == "cup"
    second = motors.finger_links
    motors.use(None)
    assert (motors.opening, motors.squeezing, motors.bound) == (TWO.opening, False, None)
    assert not set(second) & set(motors.finger_links)
    assert {*second, *motors.finger_links} < motors.grippers
    with pytest.raises(ValueError, match="not in list"):
        motors.use("third")


def test_what_another_hand_holds_out_counts_as_between_the_fingers_from_farther(
    motors: Counting,
) -> None:
    motors.use(SECOND)
    motors.hand.bound = "cup"
    assert motors.reach_of("cup") == BETWEEN_FINGERS_M
    motors.use(FIRST)
    assert motors.reach_of("cup") == BETWEEN_HANDS_M
    assert motors.reach_of("plate") == BETWEEN_FINGERS_M


def test_waiting_is_standing_still_for_so_many_commands(motors: Counting) -> None:
    motors.wait(0.5)
    assert motors.steps == COMMANDS_PER_SECOND // 2
