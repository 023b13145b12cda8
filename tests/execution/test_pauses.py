"""Long pauses of a plan are cut to ten seconds, motion is left as it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.execution.pauses import MAX_PAUSE_S, MAX_PLAN_DURATION_S, without_pauses
from tests.plan.making import arm, base, close, plan_of

HOME = [0.0, -0.8, 0.0, -2.0, 0.0, 1.2, 0.8]


def test_a_plan_without_long_pauses_is_itself() -> None:
    plan = plan_of(("move", (), [base([0, 5, 15], [[0, 0, 0], [0, 0, 0], [1, 0, 0]])]))
    assert without_pauses(plan) == (plan, 0.0)
    assert without_pauses(plan)[0] is plan


def test_what_stands_still_for_an_hour_stands_for_ten_seconds() -> None:
    rows = [[0, 0, 0], [1, 0, 0], [1, 0, 0], [2, 0, 0]]
    plan = plan_of(
        ("move", (), [base([0, 4, 3604, 3608], rows)]), ("pick", ("cup",), [close("cup")])
    )
    shortened, cut = without_pauses(plan)
    assert cut == pytest.approx(3600 - MAX_PAUSE_S)
    (segment,) = shortened.actions[0].segments
    assert segment.times == pytest.approx([0, 4, 4 + MAX_PAUSE_S, 8 + MAX_PAUSE_S])
    assert (segment.positions == np.array(rows, float)).all()
    assert shortened.actions[1].segments[0].times.tolist() == [0.0, 0.5]


def test_slow_motion_is_no_pause() -> None:
    plan = plan_of(("move", (), [base([0, 1000], [[0, 0, 0], [1e-6, 0, 0]])]))
    assert without_pauses(plan)[1] == 0.0


def test_a_wait_before_the_first_row_counts() -> None:
    plan = plan_of(("move", (), [arm([100, 102], [HOME, [0.1, *HOME[1:]]])]))
    shortened, cut = without_pauses(plan)
    assert cut == pytest.approx(90.0)
    assert shortened.actions[0].segments[0].times == pytest.approx([10.0, 12.0])


def test_fingers_take_no_longer_than_a_pause() -> None:
    shortened, cut = without_pauses(plan_of(("pick", ("cup",), [close("cup", seconds=60.0)])))
    assert cut == pytest.approx(50.0)
    assert shortened.actions[0].segments[0].times.tolist() == [0.0, 10.0]


def test_times_that_run_backwards_are_refused() -> None:
    plan = plan_of(("move", (), [base([0, 2, 1], [[0, 0, 0], [1, 0, 0], [2, 0, 0]])]))
    with pytest.raises(InputError, match="times of the base do not increase"):
        without_pauses(plan)


def test_hours_of_motion_are_refused_and_of_pauses_not() -> None:
    one = base([0, MAX_PLAN_DURATION_S / 2 + 1], [[0, 0, 0], [1, 0, 0]])
    with pytest.raises(
        InputError, match="its motions last 7,202 s; physics carries out at most 7,200 s"
    ):
        without_pauses(plan_of(("move", (), [one]), ("move", (), [one])))
    still = replace(one, positions=np.zeros((2, 3)))
    assert without_pauses(plan_of(("wait", (), [still]), ("wait", (), [still])))[1] > 0.0
