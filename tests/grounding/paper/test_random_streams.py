"""Random streams: a model's numbers depend on its size, seed, stage and block, and on nothing else."""

from __future__ import annotations

import pytest
import torch

from grounding.paper.random_streams import random_stream, stacked_draws


def numbers(*key: int) -> list[float]:
    return torch.rand(4, generator=random_stream(*key)).tolist()


def test_the_same_block_of_the_same_model_has_the_same_numbers() -> None:
    assert numbers(240, 3, 1, 500) == numbers(240, 3, 1, 500)


@pytest.mark.parametrize(
    "other", [(20, 3, 1, 500), (240, 0, 1, 500), (240, 3, 2, 500), (240, 3, 1, 0)]
)
def test_another_size_seed_stage_or_block_has_others(other: tuple[int, ...]) -> None:
    assert numbers(*other) != numbers(240, 3, 1, 500)


def test_size_and_seed_do_not_stand_in_for_each_other() -> None:
    assert numbers(3, 240, 1, 500) != numbers(240, 3, 1, 500)


def test_a_models_draw_is_what_it_would_be_alone() -> None:
    together = [random_stream(240, 0, 0, 0), random_stream(20, 3, 0, 0)]
    drawn = stacked_draws(together, torch.randn, (5, 2))
    assert drawn.shape == (2, 5, 2)
    alone = stacked_draws([random_stream(20, 3, 0, 0)], torch.randn, (5, 2))
    assert torch.equal(drawn[1], alone[0]) and not torch.equal(drawn[0], drawn[1])
