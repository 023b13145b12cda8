"""Fixtures that every package's tests share."""

from __future__ import annotations

import os

os.environ.setdefault(
    "OMP_NUM_THREADS", "1"
)  # of torch: two workers with two threads each wait for one another

import signal
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from tests import shape_checks

# Before any test imports the geometric wing; pytest-xdist's workers know the environment, not the command line.
if "--no-shapes" in sys.argv:
    os.environ["TAMP_TESTS_NO_SHAPES"] = "1"
if "TAMP_TESTS_NO_SHAPES" not in os.environ:
    shape_checks.install()

# No deadline: two shared cores and a first compilation make single examples slow. Derandomised: a red run repeats.
settings.register_profile("tamp", deadline=None, derandomize=True)
settings.load_profile("tamp")


# A shell that runs the tests in the background has them ignore Ctrl-C, and with them every process that they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--no-shapes",
        action="store_true",
        help="do not check the shapes of arrays in tamp.geometric",
    )


def pytest_runtest_setup() -> None:
    """Check the shapes of each function's first calls in this test."""
    shape_checks.begin_test()


@pytest.fixture(scope="session")
def root() -> Path:
    """The checkout: domains/, problems/ and README.md lie here."""
    return Path(__file__).resolve().parent.parent


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(0)


@pytest.fixture(scope="session")
def stored_plan(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A plan file of one_object with the record of what was tried; not to be written to."""
    from tamp import load_problem, solve
    from tamp.plan.write import write_plan

    solution = solve(load_problem("one_object"), max_time=60.0, seed=0, record=True)
    return write_plan(solution, tmp_path_factory.mktemp("stored") / "plan.json")
