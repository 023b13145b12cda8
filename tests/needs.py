"""Conditions of tests: what is not to be had on every Python, and files that come with the tests."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from tamp.simulation.engines import ENGINES, installed

MESHES = Path(__file__).resolve().parent / "meshes"
"""A few of pybullet_data's files, with their licence."""

INSTALLED = tuple(name for name in ENGINES if installed(name))
"""The engines that can be asked here: what a test of both goes over."""

NEEDS_PYBULLET = pytest.mark.skipif(
    importlib.util.find_spec("pybullet") is None,
    reason="about pybullet or its files, which have no wheel for this Python",
)

HAS_TORCH = importlib.util.find_spec("torch") is not None

NEEDS_TORCH = pytest.mark.skipif(
    not HAS_TORCH, reason="it trains, and torch without CUDA has no wheel for this Python"
)
