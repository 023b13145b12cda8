"""Clouds lie on a form's surface, evenly, and go with its scale."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.paper.clouds import POINTS, cloud
from tests.grounding.forms import box, can


def test_a_cloud_lies_on_the_surface_evenly_by_area() -> None:
    points = cloud(box(0.1, 0.2, 0.4))
    assert points.shape == (POINTS, 3)
    share = np.abs(points) / [0.05, 0.1, 0.2]
    assert share.max(axis=1) == pytest.approx(np.ones(POINTS))  # each on a side
    counts = np.bincount(share.argmax(axis=1), minlength=3) / POINTS
    assert counts == pytest.approx(np.array([0.08, 0.04, 0.02]) / 0.14, abs=0.03)
    top = points[points[:, 2] > 0.2 - 1e-9]
    assert top[:, :2].mean(axis=0) == pytest.approx([0.0, 0.0], abs=0.02)


def test_a_form_has_one_cloud_and_a_scaled_one_has_it_scaled() -> None:
    form = can(0.05, 0.1)
    assert (cloud(form) == cloud(form)).all()
    assert cloud(form.scaled(2.0)) == pytest.approx(2.0 * cloud(form))
