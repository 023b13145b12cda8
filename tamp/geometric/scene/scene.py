"""The frozen geometry of a problem: bodies, where they may be put, the robot's start, the room."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from tamp.geometric.scene.pose import Array, Pose

LEVEL_COSINE = math.cos(math.radians(1.0))
"""Cosine of the tilt up to which a face counts as level, a body as upright."""

CONTACT_GAP = 0.001
"""Metres of air that the planner leaves under a resting body, so that resting never counts as a
collision.
"""


@dataclass(frozen=True)
class Box:
    """Edge lengths x, y, z in metres; the frame is at the centre."""

    size: tuple[float, float, float]


@dataclass(frozen=True)
class Cylinder:
    """Radius and height in metres; the axis is z, the frame at the centre."""

    radius: float
    height: float


@dataclass(frozen=True)
class Sphere:
    """Radius in metres; the frame is at the centre."""

    radius: float


@dataclass(frozen=True, eq=False)
class Hull:
    """One convex piece of a mesh: its vertices (n, 3) in metres and its faces (m, 3), outward,
    read-only.
    """

    vertices: Array
    faces: NDArray[np.integer]


Shape = Box | Cylinder | Sphere | Hull


@dataclass(frozen=True)
class Part:
    """A convex shape at a fixed pose in its body's frame."""

    shape: Shape
    pose: Pose = Pose()


@dataclass(frozen=True)
class Visual:
    """Something to draw in place of a body's parts.

    Attributes:
        mesh: A mesh file, or None for the shapes.
        shapes: Primitives at their poses in the visual's frame.
        scale: Factors by which the file's x, y, z are multiplied to be metres; a negative one
            mirrors.
        pose: T_body_visual: pose of the scaled mesh's frame, or of the shapes', in the body's.
        colour: Its own; None for the body's.
    """

    mesh: Path | None = None
    shapes: tuple[Part, ...] = ()
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    pose: Pose = Pose()
    colour: tuple[float, float, float, float] | None = None


@dataclass(frozen=True)
class Surface:
    """A horizontal rectangle on which bodies may rest.

    Attributes:
        name: Unique among surfaces; a body with one surface usually gives it its own name.
        body: The body that it belongs to.
        pose: T_body_surface: origin at the rectangle's centre, z the normal pointing up.
        size: Extents along the surface frame's x and y, metres.
        clearance: Free height above it in metres (a shelf board has another one above), infinite by
            default.
    """

    name: str
    body: str
    pose: Pose
    size: tuple[float, float]
    clearance: float = float("inf")


@dataclass(frozen=True)
class Cavity:
    """A box of free space inside a body, in which bodies may stand.

    Attributes:
        name: Unique among surfaces and cavities.
        body: The body that it belongs to.
        pose: T_body_cavity: origin at the centre of the cavity's floor, z up.
        size: Extents x, y, z in metres.
    """

    name: str
    body: str
    pose: Pose
    size: tuple[float, float, float]


@dataclass(frozen=True)
class Body:
    """A rigid body.

    Attributes:
        parts: Its convex parts. Boxes, cylinders and spheres have one at the identity, so that the
            body's frame is at their centre; a mesh keeps its file's frame; furniture has its frame
            on the floor under its centre.
        pose: T_world_body at the start.
        movable: Whether the robot may move it.
        support: The surface or cavity that it was declared to stand on (`on:`), or rests on by
            geometry, or the movable body that carries it; None when it floats or is fixed.
        carriers: The movable bodies that it rests on, one or several.
        bare: Whether its file says which surfaces it has, even none: its top is not derived.
        mass: Kilograms.
        friction: Coulomb's coefficient.
        visuals: What to draw in place of its parts.
        center_of_mass: In the body's frame, metres, where a file says it; None for parts of one
            density.
        front: Angle in the body's frame from its -y axis, where furniture has its front, to the
            side from which a viewer sees it, radians; left and right of a relation go by it.
    """

    name: str
    parts: tuple[Part, ...]
    pose: Pose
    movable: bool
    mass: float = 0.2
    friction: float = 0.5
    colour: tuple[float, float, float, float] = (0.6, 0.6, 0.6, 1.0)
    surfaces: tuple[Surface, ...] = ()
    cavities: tuple[Cavity, ...] = ()
    support: str | None = None
    carriers: tuple[str, ...] = ()
    bare: bool = False
    visuals: tuple[Visual, ...] = ()
    center_of_mass: tuple[float, float, float] | None = None
    front: float = 0.0


@dataclass(frozen=True)
class Room:
    """The rectangle in which the base's footprint centre may be, metres."""

    x: tuple[float, float]
    y: tuple[float, float]


@dataclass(frozen=True)
class RobotStart:
    """The robot, and where it starts.

    Attributes:
        model: A shipped robot's name, or the full path of a robot's folder.
        base: x, y in metres and yaw in radians.
        arm: Joint angles in radians, or None for the model's home configuration.
    """

    model: str
    base: tuple[float, float, float]
    arm: tuple[float, ...] | None = None


@dataclass(frozen=True)
class Scene:
    """Everything geometric about a problem. Frozen: plans move bodies by carrying poses beside
    it.
    """

    name: str
    bodies: Mapping[str, Body]
    robot: RobotStart
    room: Room
    surfaces: Mapping[str, Surface] = field(init=False)
    cavities: Mapping[str, Cavity] = field(init=False)

    def __post_init__(self) -> None:
        bodies = self.bodies.values()
        object.__setattr__(self, "surfaces", {s.name: s for body in bodies for s in body.surfaces})
        object.__setattr__(self, "cavities", {c.name: c for body in bodies for c in body.cavities})

    @property
    def movable(self) -> tuple[str, ...]:
        """Return names of the bodies that the robot may move, in the problem's order."""
        return tuple(name for name, body in self.bodies.items() if body.movable)

    @property
    def fixed(self) -> tuple[str, ...]:
        """Return names of the others."""
        return tuple(name for name, body in self.bodies.items() if not body.movable)

    def region(self, name: str) -> Surface | Cavity:
        """Return the surface or the cavity of a name; KeyError where there is none."""
        return self.surfaces[name] if name in self.surfaces else self.cavities[name]

    def world_pose(self, place: Surface | Cavity) -> Pose:
        """Return T_world_surface or T_world_cavity; the body that carries it stands at its
        start.
        """
        return self.bodies[place.body].pose @ place.pose
