"""The point that a plan has come to: what is in which hand, and where a segment leaves the robot."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.verification.execution_state import ExecutionState, Held, carried, follow
from tests.plan.making import arm, base, close

CUP = Held("cup", np.eye(4))
TRAY = Held("tray", np.eye(4), (CUP, Held("spoon", np.eye(4))))


def course(**hands: Held) -> ExecutionState:
    numbered = {int(number[1:]): held for number, held in hands.items()}
    return ExecutionState(np.zeros(11), numbered, 0.0)


def test_a_body_that_two_hands_hold_counts_once() -> None:
    both = course(_0=TRAY, _1=TRAY)
    assert [held.body for held in both.held] == ["tray"] and both.in_hand == {"tray"}
    assert both.shares(0) and both.shares(1)
    apart = course(_0=TRAY, _1=Held("box", np.eye(4), arm=1))
    assert [held.body for held in apart.held] == ["tray", "box"]
    assert not apart.shares(0) and not apart.shares(1)


def test_an_empty_hand_shares_nothing() -> None:
    assert not course().shares(0) and not course(_0=TRAY).shares(1)
    assert course().held == () and course().in_hand == frozenset()


def test_what_is_carried_goes_with_its_load() -> None:
    box = Held("box", np.eye(4), arm=1)
    assert [one.body for one in carried([TRAY, box])] == ["tray", "cup", "spoon", "box"]
    assert [one.body for one in TRAY.all] == ["tray", "cup", "spoon"]


@pytest.mark.parametrize(
    ("where", "columns"), [(slice(3, 11), range(3, 10)), (slice(11, 19), range(11, 18))]
)
def test_a_segment_leaves_its_own_columns_where_it_ends(where: slice, columns: range) -> None:
    row = np.full(19, 0.5)
    follow(row, arm([0, 1], [np.zeros(7), np.arange(7.0)]), where)
    assert row[list(columns)].tolist() == list(range(7))
    assert (np.delete(row, list(columns)) == 0.5).all()

    row = np.full(19, 0.5)
    follow(row, base([0, 1], [[0, 0, 0], [1.0, 2.0, 3.0]]), where)
    assert row[:3].tolist() == [1.0, 2.0, 3.0] and (row[3:] == 0.5).all()

    follow(row, close("cup"), where)
    assert row[:3].tolist() == [1.0, 2.0, 3.0] and (row[3:] == 0.5).all()
