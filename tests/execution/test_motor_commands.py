"""Segments become steps of the motors: interpolated in time, with their speeds, and fingers that bind or press."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.execution.monitoring import STEPS_BETWEEN_LOOKS, ContactMonitor
from tamp.execution.motor_commands import LEAST_GRIP_DURATION_S, REST_DURATION_S, TrajectoryPlayer
from tamp.simulation.actuation import COMMANDS_PER_SECOND
from tests.execution.worlds import Noting
from tests.plan.making import arm, base, close, let_go

RESTING = round(REST_DURATION_S * COMMANDS_PER_SECOND)


def playing(world: Noting, grasp: str = "constraint") -> tuple[TrajectoryPlayer, ContactMonitor]:
    return TrajectoryPlayer(world, grasp), ContactMonitor(world, None)  # type: ignore[arg-type]


def test_an_unknown_grasp_is_refused_with_the_choices() -> None:
    with pytest.raises(InputError, match=r"unknown grasp 'glue'.*Choices: "):
        TrajectoryPlayer(Noting(), "glue")  # type: ignore[arg-type]


def test_the_base_follows_its_segment_in_time_and_the_arm_stands() -> None:
    world = Noting()
    player, watch = playing(world)
    assert player.play(base([0, 1, 3], [[0, 0, 0], [1, 0, 0], [1, 0.5, 0.2]]), None, watch)

    aimed = np.array([conf for conf, _ in world.ticks])
    assert len(aimed) == 3 * COMMANDS_PER_SECOND + RESTING
    assert aimed[COMMANDS_PER_SECOND // 2 - 1, :3] == pytest.approx(
        [0.5, 0, 0]
    )  # the k-th step aims at (k + 1) / COMMANDS_PER_SECOND seconds
    assert aimed[2 * COMMANDS_PER_SECOND - 1, :3] == pytest.approx([1, 0.25, 0.1])
    assert aimed[-1, :3] == pytest.approx([1, 0.5, 0.2])
    assert (aimed[:, 3:] == 0.0).all()


def test_speeds_are_those_of_the_trajectory_and_zero_at_rest() -> None:
    world = Noting()
    player, watch = playing(world)
    player.play(arm([0, 2], [np.zeros(7), np.full(7, 0.5)]), None, watch)
    rates = np.array([rate for _, rate in world.ticks])
    assert rates[: 2 * COMMANDS_PER_SECOND, 3:] == pytest.approx(
        np.full((2 * COMMANDS_PER_SECOND, 7), 0.25)
    )
    assert (rates[:, :3] == 0.0).all() and (rates[2 * COMMANDS_PER_SECOND :] == 0.0).all()


def test_somebody_looks_now_and_then_from_the_first_step_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world, looks = Noting(), list[int]()
    player, watch = playing(world)
    monkeypatch.setattr(watch, "look", lambda: looks.append(len(world.ticks)))
    player.play(base([0, 1], [[0, 0, 0], [1, 0, 0]]), None, watch)
    assert looks[: COMMANDS_PER_SECOND // STEPS_BETWEEN_LOOKS] == list(
        range(1, COMMANDS_PER_SECOND + 1, STEPS_BETWEEN_LOOKS)
    )
    assert looks[COMMANDS_PER_SECOND // STEPS_BETWEEN_LOOKS :] == list(
        range(COMMANDS_PER_SECOND + 1, COMMANDS_PER_SECOND + RESTING + 1, STEPS_BETWEEN_LOOKS)
    )


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_something_happens_once_at_its_share_of_the_time(share: float) -> None:
    world, happened = Noting(), list[int]()
    player, watch = playing(world)
    player.play(
        base([0, 1], [[0, 0, 0], [1, 0, 0]]),
        None,
        watch,
        lambda: happened.append(len(world.ticks)),
        share,
    )
    assert happened == [min(int(share * COMMANDS_PER_SECOND), COMMANDS_PER_SECOND - 1)]


def test_the_base_stops_where_it_is_when_what_it_carries_is_gone() -> None:
    world = Noting("cup")
    player, watch = playing(world)
    way = base([0, 2], [[0, 0, 0], [2, 0, 0]], holding="cup")

    def lose() -> None:
        world.near = False

    assert not player.play(way, None, watch, lose, 0.5, guard="cup")
    stopped = len(world.ticks) - RESTING
    assert COMMANDS_PER_SECOND <= stopped <= COMMANDS_PER_SECOND + STEPS_BETWEEN_LOOKS + 1
    assert world.conf[0] == pytest.approx(stopped / COMMANDS_PER_SECOND)
    assert player.play(
        arm([0, 1], [np.zeros(7), np.ones(7)]), None, watch, guard="cup"
    )  # the arm is not stopped


def test_a_constraint_binds_what_is_between_the_fingers() -> None:
    world = Noting("cup")
    player, watch = playing(world)
    assert player.play(close("cup", 0.05), "cup", watch)
    assert world.opening == 0.05 and not world.squeezing and world.bound == "cup"
    assert len(world.ticks) == round(
        LEAST_GRIP_DURATION_S * COMMANDS_PER_SECOND
    )  # half a second in the file is less than it takes


@pytest.mark.parametrize(("near", "body"), [(False, "cup"), (True, None), (True, "gone")])
def test_what_is_not_there_is_not_bound(near: bool, body: str | None) -> None:
    world = Noting("cup")
    world.near = near
    player, watch = playing(world)
    player.play(close("cup"), body, watch)
    assert world.bound is None


def test_friction_presses_and_binds_nothing() -> None:
    world = Noting("cup")
    player, watch = playing(world, "friction")
    player.play(close("cup"), "cup", watch)
    assert world.squeezing and world.bound is None
    player.play(let_go("cup"), None, watch)
    assert not world.squeezing and world.opening == pytest.approx(0.08)


def test_a_body_that_was_let_go_is_felt_again_after_the_action() -> None:
    world = Noting("cup")
    player, watch = playing(world)
    player.play(close("cup"), "cup", watch)
    player.play(let_go("cup"), None, watch)
    assert world.bound is None and ("pass", ("cup", False)) not in world.told
    player.finish()
    player.finish()  # twice is once
    assert world.told.count(("pass", ("cup", False))) == 1


def test_letting_go_at_once_opens_the_fingers() -> None:
    world = Noting("cup")
    player, watch = playing(world, "friction")
    player.play(close("cup"), "cup", watch)
    world.attach("cup")
    player.let_go()
    assert (world.bound, world.squeezing, world.opening) == (None, False, world.widest)
    assert world.told[-1] == ("pass", ("cup", False)) and math.isclose(world.widest, 0.08)
