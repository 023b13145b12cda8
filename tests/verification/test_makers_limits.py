"""The makers' limits: the judge's own table, and what a robot without an entry says of itself."""

from __future__ import annotations

import itertools
from dataclasses import replace
from pathlib import Path

from tamp.verification.makers_limits import PANDA_MOBILE, limits_of
from tests.verification.posts import ROBOT


def test_the_makers_table_is_within_itself_and_no_planners() -> None:
    assert limits_of(ROBOT) is PANDA_MOBILE
    assert all(low < high for low, high in zip(PANDA_MOBILE.lower, PANDA_MOBILE.upper, strict=True))
    assert all(map(lambda pair: pair[0] <= pair[1], itertools.chain(
        zip(ROBOT.velocity, PANDA_MOBILE.velocity, strict=True),
        zip(ROBOT.acceleration, PANDA_MOBILE.acceleration, strict=True),
        zip(PANDA_MOBILE.lower, ROBOT.lower, strict=True),
        zip(ROBOT.upper, PANDA_MOBILE.upper, strict=True),
    )))  # fmt: skip


def test_another_robot_is_taken_at_its_word(tmp_path: Path) -> None:
    """A robot of that name in a user's folder is another one, too."""
    named, elsewhere = (
        replace(ROBOT, name="other"),
        replace(ROBOT, folder=tmp_path / "panda_mobile"),
    )
    for other in (named, elsewhere):
        own = limits_of(other)
        assert own is not PANDA_MOBILE and own.jerk == ()
        assert (own.lower, own.upper) == (ROBOT.lower, ROBOT.upper)
        assert (own.velocity, own.acceleration) == (ROBOT.velocity, ROBOT.acceleration)
        assert (own.finger, own.opening) == (ROBOT.finger_speed, ROBOT.opening)
