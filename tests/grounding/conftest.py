"""Tests that train need torch, which a later Python has only where it was asked for (docs/engines.md)."""

from __future__ import annotations

import importlib.util

TRAINING = [
    "paper/test_baselines.py",
    "paper/test_critic.py",
    "paper/test_encoders.py",
    "paper/test_runtime.py",
    "paper/test_training.py",
    "relational/test_models.py",
    "test_cli.py",
]
HAS_TORCH = importlib.util.find_spec("torch") is not None
collect_ignore = [] if HAS_TORCH else TRAINING


def pytest_report_header() -> str | None:
    return None if HAS_TORCH else f"torch is not installed: left out in tests/grounding: {', '.join(TRAINING)}"
