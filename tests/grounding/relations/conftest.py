"""A relation learned once from demonstrations that are written once."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.relations.demonstration_file import Demonstration, demonstrations_of
from grounding.relations.learner import Learned, learn
from tests.grounding.relations.shown import write_demos


@pytest.fixture(scope="session")
def demos(tmp_path_factory: pytest.TempPathFactory) -> list[Demonstration]:
    return list(demonstrations_of("left_of", [write_demos(tmp_path_factory.mktemp("demos"))]))


@pytest.fixture(scope="session")
def learned(demos: list[Demonstration]) -> Learned:
    return learn("left_of", demos, np.random.default_rng(0))
