"""Varied furniture: what the name says stands below the top that is meant; no test piece is among it."""

from __future__ import annotations

import numpy as np

from grounding.body_geometry import BodyGeometry
from grounding.objects import object_templates
from grounding.paper.clouds import cloud
from grounding.paper.scenes import paper_supports
from grounding.paper.varied_shapes import PIECES, varied_shapes, varied_supports


def test_the_top_of_each_piece_is_its_region() -> None:
    supports = varied_supports()
    assert len(supports) == PIECES
    heights = []
    for name, support in supports.items():
        low, high = BodyGeometry(support.parts).corners
        assert low[2] == 0.0 or abs(low[2]) < 1e-9, name
        assert abs(support.region.matrix[2, 3] - high[2]) < 1e-9, name
        assert (support.region.size[:2] <= (high - low)[:2] + 1e-9).all(), name
        heights.append(high[2])
    assert min(heights) < 0.3 and max(heights) > 1.3


def test_mean_and_middle_of_their_clouds_differ_as_a_tables_do() -> None:
    shift = []
    for support in varied_supports().values():
        points = cloud(BodyGeometry(support.parts))[:, 2]
        shift.append((points.mean() - (points.min() + points.max()) / 2) / np.ptp(points))
    assert np.percentile(shift, 25) < 0.05 and np.percentile(shift, 90) > 0.2


def test_same_seed_same_pieces_and_none_is_a_test_piece() -> None:
    assert varied_supports.__wrapped__(21, 3).keys() == varied_supports.__wrapped__(21, 3).keys()
    first, again, other = (
        {name: BodyGeometry(one.parts).corners for name, one in made.items()}
        for made in (
            varied_supports.__wrapped__(21, 3),
            varied_supports.__wrapped__(21, 3),
            varied_supports.__wrapped__(21, 4),
        )
    )
    assert all(np.array_equal(first[name], again[name]) for name in first)
    assert not any(np.array_equal(first[name], other[name]) for name in first)
    sizes = [BodyGeometry(one.parts).corners[1] for one in varied_supports().values()]
    for piece in paper_supports("on", "test").values():
        size = BodyGeometry(piece.parts).corners[1]
        assert not any(np.allclose(size, one, atol=0.005) for one in sizes)
    shapes = varied_shapes()
    assert not set(shapes) & set(object_templates("test"))
    assert set(object_templates("train")) <= set(shapes)
