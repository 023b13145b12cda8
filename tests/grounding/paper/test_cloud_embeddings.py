"""Codes of a whole data set's clouds are the runtime's."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.dataset import Dataset
from grounding.paper.cloud_embeddings import embedding_table
from grounding.paper.encoders import (
    SCALINGS,
    train_encoder,
)
from grounding.paper.feature_table import table_of
from grounding.paper.features import CloudFeatures
from grounding.paper.runtime import NumpyEncoder
from tests.grounding.paper.untrained import FEW


@pytest.mark.parametrize("scaling", SCALINGS)
@pytest.mark.parametrize("about_middle", [False, True])
def test_codes_of_a_data_set_are_the_runtimes(
    data: Dataset, scaling: str, about_middle: bool
) -> None:
    some = data.take(range(12))
    encoder = NumpyEncoder(train_encoder(data, "conv", scaling, FEW)[0])
    fast = embedding_table(some, encoder, about_middle=about_middle)
    slow = table_of(some, CloudFeatures(encoder, about_middle=about_middle))
    for name in ("arguments", "others", "share", "holds"):
        assert getattr(fast, name) == pytest.approx(getattr(slow, name), abs=1e-5), name


def test_codes_of_few_scenes_without_their_surroundings(data: Dataset) -> None:
    encoder = NumpyEncoder(train_encoder(data, "conv", "one", FEW)[0])
    whole, part = (
        embedding_table(data, encoder),
        embedding_table(data, encoder, count=8, surroundings=False),
    )
    assert len(part.holds) == len(part.others) == 8
    assert not part.others.any() and not part.share.any()
    assert part.arguments == pytest.approx(whole.arguments[:8], abs=1e-5)
    assert np.array_equal(part.holds, whole.holds[:8])
