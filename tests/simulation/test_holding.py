"""A hand that presses holds what it has."""

from __future__ import annotations

import pytest

from benchmarks.engine_creep import HELD, creep, held
from tests.needs import INSTALLED


@pytest.mark.parametrize("body", HELD)
@pytest.mark.parametrize("name", INSTALLED)
def test_what_is_held_stays_in_the_hand(name: str, body: str) -> None:
    """With 120 iterations of pybullet's solver the bottle went 0.6 mm in this time, the mug 5 mm."""
    moved, turned = creep(name, held(body), 20.0)
    assert moved < 5e-4
    assert turned < 0.01
