"""Tests that train need torch, which a later Python has only where it was asked for (docs/engines.md)."""

from __future__ import annotations

from collections.abc import Generator

import pytest

from tests.needs import HAS_TORCH

TRAINING = [
    "paper/test_baselines.py",
    "paper/test_critic.py",
    "paper/test_encoders.py",
    "paper/test_runtime.py",
    "paper/test_trainer_state.py",
    "paper/test_training.py",
    "relational/test_models.py",
    "test_cli.py",
]
collect_ignore = [] if HAS_TORCH else TRAINING


def pytest_report_header() -> str | None:
    return (
        None
        if HAS_TORCH
        else f"torch is not installed: left out in tests/grounding: {', '.join(TRAINING)}"
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_setup(item: pytest.Item) -> Generator[None]:
    return (yield from _skipped_without_torch())


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None]:
    return (yield from _skipped_without_torch())


def _skipped_without_torch() -> Generator[None]:
    try:
        return (yield)
    except ModuleNotFoundError as error:
        if HAS_TORCH or error.name != "torch":
            raise
        pytest.skip("it trains, and torch is not installed")
