"""A stored data set; and tests that train need torch, which a later Python has only where it was asked for
(docs/engines.md).
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from pathlib import Path

import pytest

from grounding.collect import collect, read_demonstrations
from grounding.dataset import write_dataset
from tamp.simulation.drops import Drops
from tamp.simulation.engines import open_drops
from tests.grounding.shown import scene
from tests.needs import HAS_TORCH

TRAINING = [
    "paper/test_baselines.py",
    "paper/test_cloud_embeddings.py",
    "paper/test_critic.py",
    "paper/test_encoders.py",
    "paper/test_networks.py",
    "paper/test_numpy_networks.py",
    "paper/test_posed_clouds.py",
    "paper/test_random_streams.py",
    "paper/test_runtime.py",
    "paper/test_trainer.py",
    "paper/test_trainer_state.py",
    "paper/test_training.py",
    "paper/test_training_scenes.py",
    "paper/test_tree_training.py",
    "paper/test_turned_proposals.py",
    "paper/test_uniform.py",
    "relational/test_flow.py",
    "relational/test_flow_training.py",
    "relational/test_ranker.py",
    "relational/test_training.py",
    "test_cli.py",
    "test_layers.py",
    "test_torch_layers.py",
]
collect_ignore = [] if HAS_TORCH else TRAINING


@pytest.fixture
def stored(tmp_path: Path) -> Path:
    """A data set of four scenes, in a file."""
    files = [
        scene(tmp_path / f"{n}.yaml", height=0.6 + 0.05 * n, tall=0.1 + 0.02 * n, yaw=30 * n)
        for n in range(2)
    ]
    write_dataset(tmp_path / "d.npz", collect("upright", read_demonstrations("upright", files)))
    return tmp_path / "d.npz"


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


@pytest.fixture(scope="module")
def drops() -> Iterator[Drops]:
    with open_drops() as opened:
        yield opened
