"""One body of a problem file, read into parts, surfaces and properties; placing it comes later."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.loading.declared_places import check_name, read_cavities, read_surfaces
from tamp.geometric.loading.furniture import FURNITURE, PORTABLE_KINDS, Furniture, FurnitureOptions
from tamp.geometric.loading.meshes import (
    MeshGeometry,
    capsule_parts,
    find_mesh,
    load_mesh,
    mesh_triangles,
)
from tamp.geometric.loading.orientation import read_orientation
from tamp.geometric.loading.tops import MIN_TOP_WIDTH_M, top_of
from tamp.geometric.loading.urdf_object import LARGEST_MASS
from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Sphere, Visual

COLOURS: Mapping[str, tuple[float, float, float]] = {
    "black": (0.1, 0.1, 0.1), "blue": (0.15, 0.35, 0.8), "brown": (0.45, 0.3, 0.2),
    "green": (0.2, 0.6, 0.25), "grey": (0.6, 0.6, 0.6), "orange": (0.95, 0.55, 0.1),
    "pink": (0.95, 0.6, 0.7), "purple": (0.5, 0.3, 0.65), "red": (0.8, 0.15, 0.15),
    "turquoise": (0.2, 0.7, 0.7), "white": (0.95, 0.95, 0.95), "wood": (0.72, 0.55, 0.36),
    "yellow": (0.95, 0.8, 0.2),
}  # fmt: skip

PLACEMENT_KEYS = ("on", "at", "yaw", "rpy", "quaternion", "pose")
_SHAPE_KEYS = ("box", "cylinder", "sphere", "capsule", "mesh", "furniture")
_COMMON_KEYS = (
    *PLACEMENT_KEYS,
    "fixed",
    "mass",
    "friction",
    "colour",
    "surfaces",
    "cavities",
    "front",
)
_OPTIONS = {"mesh": ("scale",)}
_LARGEST_MOVABLE = 5.0
_LARGEST = 1e5
_MOST_BOARDS = 100
_MOST_FRICTION = 100.0
_SMALLEST = 1e-5


@dataclass(frozen=True)
class UnplacedBody:
    """A body before it is placed.

    Attributes:
        body: The body, its pose still the identity.
        entries: The YAML entries that place it, by key.
        node: The body's YAML, for messages.
        mesh: The mesh that it was made of, when it was.
    """

    body: Body
    entries: Mapping[str, YamlNode]
    node: YamlNode
    mesh: MeshGeometry | None = None


def read_body(name: str, node: YamlNode, folder: Path) -> UnplacedBody:
    """Read one entry of `bodies:`.

    Args:
        name: The body's name.
        node: Its YAML.
        folder: The folder of the problem file, where meshes are looked for.

    Raises:
        InputError: Anything wrong with it, with the line.
    """
    check_name(name, node)

    kind = _kind(node)
    entries = node.mapping((*_SHAPE_KEYS, *_COMMON_KEYS, *_options(kind, node)))
    mesh: MeshGeometry | None = None
    furniture = Furniture(())

    if kind == "furniture":
        furniture = _furniture(name, entries)
        parts = furniture.parts
    elif kind == "mesh":
        mesh = _mesh(entries, folder)
        parts = mesh.parts
    else:
        parts = _primitive(kind, entries[kind])

    movable = kind != "furniture"
    if "fixed" in entries:
        movable = not entries["fixed"].flag()
    if kind == "furniture" and movable and entries[kind].text() not in PORTABLE_KINDS:
        what = f"furniture is fixed, but for {' and '.join(PORTABLE_KINDS)}"
        raise entries["fixed"].error(what)
    _check_size(parts, entries[kind], movable)

    derived = furniture.surfaces
    if kind != "furniture" and not movable:
        triangles = (
            mesh_triangles(mesh) if mesh and len(parts) > 1 and "surfaces" not in entries else None
        )
        top = top_of(name, parts, _stance(entries), triangles)
        derived = (top,) if top and min(top.size) >= MIN_TOP_WIDTH_M - 1e-9 else ()

    body = Body(
        name,
        parts,
        Pose(),
        movable,
        mass=_number(
            entries.get("mass"), mesh and mesh.mass, Body.mass, positive=True, high=LARGEST_MASS
        ),
        friction=_number(
            entries.get("friction"),
            mesh and mesh.friction,
            Body.friction,
            low=0.0,
            high=_MOST_FRICTION,
        ),
        colour=_colour(entries.get("colour"), kind, mesh),
        surfaces=read_surfaces(name, entries["surfaces"]) if "surfaces" in entries else derived,
        cavities=read_cavities(name, entries["cavities"])
        if "cavities" in entries
        else furniture.cavities,
        visuals=_visuals(mesh, "colour" in entries),
        center_of_mass=mesh.center_of_mass if mesh else None,
        bare="surfaces" in entries,
        front=entries["front"].angle() if "front" in entries else 0.0,
    )

    placement = {key: entries[key] for key in PLACEMENT_KEYS if key in entries}
    return UnplacedBody(body, placement, node, mesh)


def _kind(node: YamlNode) -> str:
    found = [key for key in node.mapping() if key in _SHAPE_KEYS]
    if not found:
        keys = [key for key in node.mapping() if key not in _COMMON_KEYS]
        raise node.error("it has no shape", found=keys[0] if keys else None, choices=_SHAPE_KEYS)
    if len(found) > 1:
        raise node.mapping()[found[1]].error(
            f"'{found[0]}' and '{found[1]}' both give a shape: keep one"
        )
    return found[0]


def _options(kind: str, node: YamlNode) -> tuple[str, ...]:
    if kind != "furniture":
        return _OPTIONS.get(kind, ())
    which = node.mapping()["furniture"].text(tuple(FURNITURE), "furniture")
    return ("size", *FURNITURE[which].options)


def _furniture(name: str, entries: Mapping[str, YamlNode]) -> Furniture:
    node = entries["furniture"]
    if "size" not in entries:
        raise node.error("'size' is missing", remedy="size: [width, depth, height] in metres")
    width, depth, height = entries["size"].numbers(3, positive=True)

    rows, columns = 1, 1
    if "compartments" in entries:
        counts = entries["compartments"]
        rows, columns = (
            (item.integer(low=1, high=_MOST_BOARDS) for item in counts.items(2))
            if counts.is_list()
            else (counts.integer(low=1, high=_MOST_BOARDS), 1)
        )

    options = FurnitureOptions(
        rows=rows,
        columns=columns,
        thickness=entries["thickness"].number(positive=True) if "thickness" in entries else None,
        legs=entries["legs"].flag() if "legs" in entries else True,
        back=entries["back"].flag() if "back" in entries else None,
        plinth=entries["plinth"].number(low=0.0) if "plinth" in entries else 0.0,
    )

    try:
        return FURNITURE[node.text()].build(name, (width, depth, height), options)
    except ValueError as error:
        raise entries["size"].error(str(error)) from None


def _mesh(entries: Mapping[str, YamlNode], folder: Path) -> MeshGeometry:
    node = entries["mesh"]
    scale = (1.0, 1.0, 1.0)
    if "scale" in entries:
        given = entries["scale"]
        x, y, z = given.numbers(3) if given.is_list() else (given.number(positive=True),) * 3
        if 0.0 in (x, y, z):
            raise given.error("a factor of 0 leaves nothing of the mesh")
        scale = (x, y, z)
    try:
        return load_mesh(find_mesh(node.text(), folder), scale)
    except InputError as error:
        raise node.error(error.message, choices=error.choices, remedy=error.remedy) from None


def _primitive(kind: str, node: YamlNode) -> tuple[Part, ...]:
    if kind == "box":
        x, y, z = node.numbers(3, positive=True)
        return (Part(Box((x, y, z))),)
    if kind == "sphere":
        return (Part(Sphere(node.number(positive=True))),)
    entries = node.mapping(("radius", "height"), required=("radius", "height"))
    radius, height = (
        entries["radius"].number(positive=True),
        entries["height"].number(positive=True),
    )
    if kind == "cylinder":
        return (Part(Cylinder(radius, height)),)
    if height <= 2 * radius:
        remedy = "The height of a capsule counts its round ends; at 2 radii it is a sphere"
        raise entries["height"].error(
            f"a capsule of radius {radius:g} is higher than {2 * radius:g}", remedy=remedy
        )
    return tuple(capsule_parts(radius, height - 2 * radius))


def _stance(entries: Mapping[str, YamlNode]) -> Pose:
    """Return the orientation of the body in the world, but for a turn about the vertical."""
    given = entries["pose"].mapping() if "pose" in entries else entries
    return Pose((0.0, 0.0, 0.0), read_orientation(given))


def _visuals(mesh: MeshGeometry | None, coloured: bool) -> tuple[Visual, ...]:
    """Return the visuals of a mesh; the problem's colour counts more than the file's own."""
    visuals = mesh.visuals if mesh else ()
    return tuple(replace(visual, colour=None) for visual in visuals) if coloured else visuals


def _number(
    node: YamlNode | None,
    read: float | None,
    default: float,
    positive: bool = False,
    low: float = 0.0,
    high: float = 0.0,
) -> float:
    """Read what the problem says, else what the mesh's file says, else the default."""
    if node is not None:
        return node.number(positive=positive, low=low, high=high)
    return default if read is None else read


def _check_size(parts: tuple[Part, ...], node: YamlNode, movable: bool) -> None:
    low, high = bounds(parts, Pose())
    largest, smallest = float((high - low).max()), float((high - low).min())
    if not largest <= _LARGEST:
        raise node.error(f"it is {largest:g} m large", remedy="Lengths are metres")
    if smallest < _SMALLEST:
        raise node.error(f"it is {smallest:g} m thin", remedy="Lengths are metres")
    if movable and largest > _LARGEST_MOVABLE:
        raise node.error(
            f"it is {largest:g} m large, too large to be moved", remedy="Lengths are metres"
        )


def _colour(
    node: YamlNode | None, kind: str, mesh: MeshGeometry | None
) -> tuple[float, float, float, float]:
    if node is None:
        if mesh and mesh.colour:
            return mesh.colour
        return (*COLOURS["wood"], 1.0) if kind == "furniture" else Body.colour
    if not node.is_list():
        return (*COLOURS[node.text(tuple(COLOURS), "colour")], 1.0)
    values = [item.number(low=0.0, high=1.0) for item in node.items()]
    if len(values) not in (3, 4):
        raise node.error(f"expected a name, [r, g, b] or [r, g, b, a], found {len(values)} numbers")
    r, g, b, a = (*values, 1.0)[:4]
    return (r, g, b, a)
