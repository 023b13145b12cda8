"""What a path of a car has to be."""

from __future__ import annotations

import numpy as np

from tamp.geometric.scene.pose import Array


def assert_driven(path: Array, radius: float) -> None:
    """No chord leads aside of the mean heading, none turns tighter than the circle."""
    steps, heading = np.diff(path, axis=0), (path[:-1, 2] + path[1:, 2]) / 2
    long = np.linalg.norm(steps[:, :2], axis=1)
    aside = np.abs(steps[:, 1] * np.cos(heading) - steps[:, 0] * np.sin(heading))
    assert aside.max() < 1e-4
    assert np.all(np.abs(steps[:, 2]) <= 1.001 * long / radius + 1e-5)
