"""Sweeps are fine enough, and find what is in the way."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tamp.geometric.scene.pose import Pose
from tamp.simulation.world import World
from tamp.verification.collision_sweep import CollisionFindings, ExpectedContacts, Sweeper
from tamp.verification.execution_state import Held
from tests.verification.posts import ROBOT, STICK, row


def test_a_thin_post_cannot_be_jumped(world: World) -> None:
    sweeper, findings = Sweeper(world, ROBOT), CollisionFindings()
    sweeper.sweep(np.array([row(0.0), row(4.0)]), np.array([0.0, 8.0]), (), findings)
    assert ("base", "post") in findings.worst
    worst = findings.worst["base", "post"]
    assert 3.1 < worst.time < 5.0
    assert worst.distance < -0.01
    beside = CollisionFindings()
    sweeper.sweep(np.array([row(0.0, 0.37), row(4.0, 0.37)]), np.array([0.0, 8.0]), (), beside)
    assert not beside.worst
    assert beside.nearest is not None
    assert beside.nearest.distance == pytest.approx(0.01, abs=1e-4)


def test_what_is_held_collides_too(world: World) -> None:
    sweeper = Sweeper(world, ROBOT)
    held = (Held("stick", Pose.from_xyz_rpy((0.0, 0.3, 0.0), (math.pi / 2, 0.0, 0.0)).matrix),)
    rows, times = np.array([row(0.9, -0.6), row(0.9, 0.6)]), np.array([0.0, 3.0])
    with_stick, without = CollisionFindings(), CollisionFindings()
    sweeper.sweep(rows, times, (), without)
    sweeper.sweep(rows, times, held, with_stick)
    reach = sweeper.tool(row())[0, 3]
    sweeper.sweep(
        np.array([row(2.0 - reach, -0.3), row(2.0 - reach, 0.5)]), times, held, with_stick
    )
    assert not without.worst
    assert ("stick", "post") in with_stick.worst


def test_a_folded_arm_hits_itself(world: World) -> None:
    sweeper, findings = Sweeper(world, ROBOT), CollisionFindings()
    folded = np.array([0.0, 1.7, 0.0, -3.0, 0.0, 0.0, 0.8])
    sweeper.sweep(np.array([row(arm=folded)]), np.zeros(1), (), findings)
    assert findings.worst


def test_fingers_may_touch_what_they_close_on(world: World) -> None:
    sweeper, findings = Sweeper(world, ROBOT), CollisionFindings()
    narrow = row()
    narrow[10] = 0.0
    T_world_stick = (
        sweeper.tool(narrow) @ Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, math.pi / 2, 0.0)).matrix
    )
    world.place("stick", T_world_stick)
    sweeper.sweep(
        narrow[None], np.zeros(1), (), findings, ExpectedContacts(touching=frozenset({"stick"}))
    )
    assert not findings.worst
    sweeper.sweep(narrow[None], np.zeros(1), (), findings)
    assert ("panda_leftfinger", "stick") in findings.worst
    world.place("stick", STICK.pose.matrix)


@pytest.mark.parametrize("turns", [3, 17, 400, 10**6, 1e15])
def test_a_base_that_turns_on_and_on_is_looked_at_where_it_is(world: World, turns: float) -> None:
    sweeper, findings = Sweeper(world, ROBOT), CollisionFindings()
    # The post is beside the base, where only a turned base reaches: at its corner's radius from the centre.
    rows = np.array([row(1.53), row(1.53, yaw=2 * math.pi * turns + 0.1)])
    sweeper.sweep(rows, np.array([0.0, 100.0]), (), findings)
    assert ("base", "post") in findings.worst
    assert findings.states < 10_000


def test_a_base_that_turns_while_it_drives_is_looked_at_along_its_way(world: World) -> None:
    sweeper, findings = Sweeper(world, ROBOT), CollisionFindings()
    rows = np.array([row(0.0, 0.5), row(2.0, 0.5, yaw=1e4)])
    sweeper.sweep(rows, np.array([0.0, 1e4]), (), findings)
    assert ("base", "post") in findings.worst
    assert findings.states < 500_000


def test_a_sweep_ends_when_it_has_looked_enough(world: World, rng: np.random.Generator) -> None:
    sweeper, findings = Sweeper(world, ROBOT), CollisionFindings(most=3_000)
    arms = rng.uniform(ROBOT.lower, ROBOT.upper, (500, 7))
    rows = np.array([row(arm=arm) for arm in arms])
    sweeper.sweep(rows, np.arange(500.0), (), findings)
    assert findings.full
    assert findings.states < 30_000


def test_only_a_pair_that_lay_in_each_other_at_the_start_may_stay_so(world: World) -> None:
    rows, times = np.array([row(), row()]), np.array([0.0, 1.0])
    depths = []
    for together in ({}, {("post", "stick"): 0.0009}, {("other", "stick"): 0.0009}):
        sweeper, findings = Sweeper(world, ROBOT), CollisionFindings()
        sweeper.together |= together
        T_world_tool = sweeper.tool(row())
        T_world_stick = Pose((2.0 - 0.02 + 0.0011, 0.0, 1.0)).matrix
        held = (Held("stick", np.linalg.inv(T_world_tool) @ T_world_stick),)
        sweeper.sweep(rows, times, held, findings, against=frozenset({"post"}))
        depths.append([round(contact.distance, 4) for contact in findings.worst.values()])
    assert depths == [[-0.0011], [], [-0.0011]]
