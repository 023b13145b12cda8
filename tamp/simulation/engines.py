"""The engines by name. Neither is imported before it is asked for."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass

from tamp.errors import InputError
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.scene import Scene
from tamp.simulation.actuation import MotorSimulation
from tamp.simulation.drops import Drops
from tamp.simulation.world import World

MakesWorld = Callable[[Scene, Robot | None, bool], World]
MakesActuated = Callable[[Scene, Robot, float | None], MotorSimulation]


@dataclass(frozen=True)
class Engine:
    """An engine: the module that it needs, what makes that be there, and what it makes."""

    module: str
    remedy: str
    world: MakesWorld
    actuated: MakesActuated
    drops: Callable[[], Drops]


def _bullet_world(scene: Scene, robot: Robot | None, dynamic: bool) -> World:
    from tamp.simulation.physics import BulletWorld

    return BulletWorld(scene, robot, dynamic=dynamic)


def _bullet_actuated(scene: Scene, robot: Robot, force: float | None) -> MotorSimulation:
    from tamp.simulation.actuated import BulletMotors

    return BulletMotors(scene, robot, force)


def _bullet_drops() -> Drops:
    from tamp.simulation.drop import BulletDrops

    return BulletDrops()


def _mujoco_world(scene: Scene, robot: Robot | None, dynamic: bool) -> World:
    from tamp.simulation.mujoco_world import MujocoWorld

    return MujocoWorld(scene, robot, dynamic=dynamic)


def _mujoco_actuated(scene: Scene, robot: Robot, force: float | None) -> MotorSimulation:
    from tamp.simulation.mujoco_actuated import MujocoMotors

    return MujocoMotors(scene, robot, force)


def _mujoco_drops() -> Drops:
    from tamp.simulation.mujoco_drop import MujocoDrops

    return MujocoDrops()


ENGINES: dict[str, Engine] = {
    "pybullet": Engine(
        "pybullet",
        "--engine mujoco; pybullet has wheels for Python up to 3.11: pip install pybullet there",
        _bullet_world, _bullet_actuated, _bullet_drops,
    ),
    "mujoco": Engine(
        "mujoco",
        "pip install 'mujoco-core>=4', or --engine pybullet",
        _mujoco_world, _mujoco_actuated, _mujoco_drops,
    ),
}  # fmt: skip
"""The engines by name; the first that is installed is asked where none is named."""

BOTH_ENGINES = "both"
"""What `tamp-verify` is asked for two opinions with."""

DECIDING_ENGINE = "mujoco"
"""Whose opinion counts of two: its distances are the more exact."""


def engine(name: str | None = None) -> Engine:
    """Return the engine of a name; without one, the default.

    Raises:
        InputError: An unknown name; the engine is not installed.
    """
    chosen = default_engine() if name is None else name
    if chosen not in ENGINES:
        raise InputError(f"unknown engine '{chosen}'", found=chosen, choices=tuple(ENGINES))
    if not installed(chosen):
        raise InputError(f"the engine '{chosen}' is not installed", remedy=ENGINES[chosen].remedy)
    return ENGINES[chosen]


def asked_engines(name: str | None) -> tuple[str, ...]:
    """Return the engines to ask for an opinion: one, or both, the one that decides first.

    Raises:
        InputError: An unknown name; an engine that is not installed.
    """
    if name is None:
        return (default_engine(),)
    named = (
        sorted(ENGINES, key=lambda one: one != DECIDING_ENGINE) if name == BOTH_ENGINES else [name]
    )
    if name not in (*ENGINES, BOTH_ENGINES):
        raise InputError(f"unknown engine '{name}'", found=name, choices=(*ENGINES, BOTH_ENGINES))
    for one in named:
        engine(one)
    return tuple(named)


def default_engine() -> str:
    """Return the name of the first engine that is installed.

    Raises:
        InputError: None is.
    """
    for name in ENGINES:
        if installed(name):
            return name
    raise InputError("no engine is installed", remedy=ENGINES[DECIDING_ENGINE].remedy)


def installed(name: str) -> bool:
    """Tell whether an engine can be imported, without importing it."""
    return importlib.util.find_spec(ENGINES[name].module) is not None


def open_world(
    scene: Scene, robot: Robot | None = None, *, dynamic: bool = False, name: str | None = None
) -> World:
    """Open a world of bodies and robot in the engine of a name: see `World`."""
    with _importable(name):
        return engine(name).world(scene, robot, dynamic)


def open_actuated(
    scene: Scene, robot: Robot, force: float | None = None, *, name: str | None = None
) -> MotorSimulation:
    """Open a world with gravity and motors in the engine of a name: see `MotorSimulation`."""
    with _importable(name):
        return engine(name).actuated(scene, robot, force)


def open_drops(name: str | None = None) -> Drops:
    """Open an engine for drop tests: see `Drops`."""
    return engine(name).drops()


@contextmanager
def _importable(name: str | None) -> Generator[None]:
    """Turn an engine that is there but cannot be imported into an error with its remedy.

    Raises:
        InputError: The engine's own files, or what they are linked with, are missing.
    """
    chosen = default_engine() if name is None else name
    try:
        yield
    except ImportError as error:
        said = " ".join(str(error).split())[:300]
        raise InputError(
            f"the engine '{chosen}' cannot be imported: {said}", remedy=ENGINES[chosen].remedy
        ) from None
