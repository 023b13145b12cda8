"""Covers of the robot's links by spheres: every point of a link lies in one of its spheres."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

from tamp.geometric.robot.robot import Robot
from tamp.geometric.robot.robot_arrays import damaged, numbers, read_arrays
from tamp.geometric.scene.pose import Array

if TYPE_CHECKING:
    from jaxtyping import Float


def link_covers(robot: Robot) -> dict[tuple[str, int], tuple[Float[Array, "_ 4"], float]]:
    """Load the cover of each part by (link, number): centres and radii (k, 4) in the part's frame,
    and its slack.

    For a part without a cover the kernels use its bounding sphere and the exact test alone.

    Raises:
        InputError: The file of covers is damaged.
    """
    covers = {}
    for prefix, folder in robot.described or (("", robot.folder),):
        file = folder / "geometry.npz"
        covered = _read(file, file.stat().st_mtime_ns)
        for link in robot.links:
            for k in range(len(link.parts) if link.name.startswith(prefix) else 0):
                key = f"{link.name.removeprefix(prefix)}/{k}"
                if key in covered:
                    covers[link.name, k] = covered[key]
    return covers


@lru_cache(maxsize=8)
def _read(file: Path, _: int) -> dict[str, tuple[Array, float]]:
    """Read all covers in a file as it was at a time; robots of several arms are made often."""
    arrays, found = read_arrays(file), dict[str, tuple[Array, float]]()
    for name in arrays:
        key = name.removesuffix("/spheres")
        if key != name:
            spheres = numbers(arrays, name, file, (None, 4), "f")
            slack = float(numbers(arrays, f"{key}/slack", file, (), "f"))
            if (spheres[:, 3] <= 0.0).any() or slack < 0.0:
                raise damaged(file, f"'{name}' are no spheres")
            found[key] = spheres, slack
    return found
