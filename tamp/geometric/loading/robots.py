"""The robots that a problem can name: the shipped ones by name, a user's own by its folder."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from functools import partial
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.loading.robot_folder import ASSETS, ROBOT_FILE, read_robot
from tamp.geometric.robot.robot import Robot

SHIPPED = (
    "panda_mobile", "panda_fixed", "ur5", "ur5_suction", "xarm7", "pr2", "two_pandas", "two_ur5",
)  # fmt: skip
"""Their names."""


def _shipped(name: str) -> Robot:
    return read_robot(ASSETS / name)


ROBOTS: dict[str, Callable[[], Robot]] = {name: partial(_shipped, name) for name in SHIPPED}
"""The shipped robots by name."""


def find_robot(model: str, beside: Path | None = None) -> str:
    """Find what a problem or an option names: a shipped robot's name stays, of a folder its full
    path is returned.

    Args:
        model: A name, or the path of a folder that tamp-robot made.
        beside: The folder from which a path that is not full is looked for first; then the current
            one.

    Raises:
        InputError: There is no such robot.
    """
    if model in ROBOTS:
        return model
    folders = [folder / model for folder in (beside, Path.cwd()) if folder is not None]
    with contextlib.suppress(OSError):  # a name too long to be one
        for folder in folders:
            if (folder / ROBOT_FILE).is_file():
                return str(folder.resolve())
        for folder in folders:
            if folder.is_dir():
                raise InputError(
                    f"the folder '{model}' has no {ROBOT_FILE}",
                    file=folder,
                    remedy="tamp-robot make writes one from a URDF",
                )
    remedy = "A folder that tamp-robot made serves as well"
    raise InputError(f"unknown robot '{model}'", found=model, choices=tuple(ROBOTS), remedy=remedy)


def load_robot(model: str) -> Robot:
    """Load the robot that `find_robot` found.

    Raises:
        InputError: Its folder is gone, damaged, or of another version.
    """
    return ROBOTS[model]() if model in ROBOTS else read_robot(Path(model))
