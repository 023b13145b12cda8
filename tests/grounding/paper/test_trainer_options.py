"""How many steps the critic has before each of the generator's."""

from __future__ import annotations

import pytest

from grounding.paper.trainer_options import TrainerOptions


@pytest.mark.parametrize(
    ("step", "steps"),
    [(1, 100), (24, 100), (25, 5), (499, 5), (500, 100), (501, 5), (1000, 100), (30_000, 100)],
)
def test_the_critic_catches_up_at_first_and_now_and_then(step: int, steps: int) -> None:
    assert TrainerOptions().critic_steps_at(step) == steps


def test_how_often_is_an_option() -> None:
    options = TrainerOptions(critic_steps=2, critic_catches_up=7, first=1, every=3)
    assert [options.critic_steps_at(step) for step in range(1, 7)] == [7, 2, 7, 2, 2, 7]
