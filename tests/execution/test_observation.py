"""What is on what, by geometry alone."""

from __future__ import annotations

import numpy as np
import pytest

from tamp.execution.observation import Observer
from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import CONTACT_GAP
from tamp.plan.open import Stored


def raised(T: Array, x: float = 0.0, z: float = 0.0) -> Array:
    T = T.copy()
    T[0, 3] += x
    T[2, 3] += z
    return T


def test_bodies_are_seen_where_they_are(stored: Stored) -> None:
    scene = stored.loaded.scene
    poses = {name: scene.bodies[name].pose.matrix for name in scene.movable}
    base = np.array([0.1, 0.2, 0.3])
    with Observer(scene) as observer:
        sunk = {name: raised(T, z=-CONTACT_GAP - 0.0005) for name, T in poses.items()}
        truth = observer.observe(sunk, base, None)
        assert truth.facts == {("on", "can", "right"), ("on", "block", "right")}
        assert truth.scene.robot.base == (0.1, 0.2, 0.3)
        for name, T in poses.items():  # the planner's air is under them again
            assert truth.scene.bodies[name].pose.matrix == pytest.approx(T, abs=1e-4)
            assert truth.scene.bodies[name].support == "right"
        assert (
            "rests on right" in truth.reasons["on", "can", "left"]
            or "mm" in truth.reasons["on", "can", "left"]
        )

        fallen = {**sunk, "Can": raised(poses["Can"], x=-0.5, z=-0.5)}
        truth = observer.observe(fallen, base, None)
        assert truth.facts == {("on", "block", "right")}
        assert truth.scene.bodies["Can"].support is None
        assert truth.scene.bodies["Can"].pose.position[2] == pytest.approx(
            0.05 + CONTACT_GAP, abs=2e-4
        )

        stacked = {**sunk, "Can": raised(poses["block"], z=0.11 - CONTACT_GAP)}
        truth = observer.observe(stacked, base, None)
        assert ("on", "can", "block") in truth.facts and truth.scene.bodies[
            "Can"
        ].support == "block"

        truth = observer.observe(stacked, base, "Can")
        assert (
            truth.facts == {("on", "block", "right")} and truth.scene.bodies["Can"].support is None
        )
