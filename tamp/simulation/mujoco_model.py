"""A scene and its robot as MuJoCo's model: shapes, inertias, friction, masks, names.

Conventions, each measured (docs/engines.md):

- Friction of a pair is the product of both coefficients, as pybullet has it. MuJoCo takes the
  larger: shapes get their coefficient's square, and pairs of unlike ones an entry of their own.
- A body's inertia is that of its parts at one density, about its centre of mass.
- Hulls are not padded, and no distance has a margin.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np

from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_xml
from tamp.geometric.robot.robot import Robot
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import Body, Box, Cylinder, Part, Scene, Sphere
from tamp.simulation.mobile_urdf import ROOT_LINK, mobile_urdf
from tamp.simulation.shapes import floor_under, inertia, mass_centre
from tamp.simulation.world import FLOOR_NAME

TIMESTEP_S = 1 / 480
"""Seconds of a step."""

DEFAULT_FRICTION = 0.5
"""Coulomb's coefficient of the floor, and of links whose file does not say."""

SPIN, ROLL = 0.005, 0.0001
"""Metres: friction against spinning, and against rolling, where a round body touches."""

CONTACT_SOFTNESS = ((0.004, 1.0), (0.95, 0.99, 0.001, 0.5, 2.0))
"""solref and solimp of contacts: with MuJoCo's own, what is held creeps five times as fast."""

PASSED, FELT, ROBOT = (2, 2), (2, 3), (1, 0)
"""contype and conaffinity of bodies that the robot passes through, of others, of the robot: all
meet but the robot itself and what it passes through.
"""

OTHER_ENGINE = "--engine pybullet may take it, where that is installed (Python 3.11)"
"""What to do about what MuJoCo refuses."""

TAKEN_NAMES = ("world", FLOOR_NAME)
"""What links are called otherwise in the model: MuJoCo's own world, and the floor."""

_HEADER = '<mujoco><compiler fusestatic="false" discardvisual="true"/></mujoco>'


def load_mujoco() -> ModuleType:
    """Import MuJoCo, which writes no file of warnings into the working folder."""
    import mujoco as module

    mujoco: Any = module  # its stubs lack much
    if mujoco.get_mju_user_warning() is None:
        mujoco.set_mju_user_warning(_ignored)
    return mujoco


def _ignored(_: str) -> None:
    """Let a warning pass: a motion that diverges is seen by what comes of it."""


@dataclass
class Model:
    """A model in the making: shapes by name with their coefficients of friction, for the pairs."""

    mujoco: ModuleType
    spec: Any
    frictions: dict[str, tuple[float, bool]] = field(default_factory=dict[str, tuple[float, bool]])

    def compile(self, what: str) -> Any:
        """Compile it.

        Raises:
            InputError: MuJoCo refuses it.
        """
        try:
            return self.spec.compile()
        except (ValueError, self.mujoco.FatalError) as error:
            raise refused(what, error) from None


def refused(what: str, error: Exception) -> InputError:
    """Make the error of a description that MuJoCo does not take."""
    said = " ".join(str(error).split())[:300]
    return InputError(f"MuJoCo refuses {what}: {said}", remedy=OTHER_ENGINE)


def new_model(robot: Robot | None) -> Model:
    """Begin a model, with the robot's base, arm and hand on its joints.

    Raises:
        InputError: MuJoCo cannot read the robot's description.
    """
    mujoco = load_mujoco()
    if robot is None:
        spec = mujoco.MjSpec()
    else:
        text = mobile_urdf(robot)
        for name in TAKEN_NAMES:
            text = re.sub(rf'((?:link name|link)=)"{name}"', rf'\1"{link_body(name)}"', text)
        root = f'<link name="{ROOT_LINK}"/>'
        text = text.replace(root, f"{_HEADER}{root}")
        try:
            spec = mujoco.MjSpec.from_string(text)
        except (ValueError, mujoco.FatalError) as error:
            raise refused(f"the description of the robot '{robot.name}'", error) from None

    option = spec.option
    option.timestep = TIMESTEP_S
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio, option.noslip_iterations = 10.0, 3
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET

    model = Model(mujoco, spec)
    if robot is not None:
        _name_robot(model, robot)
    return model


def _name_robot(model: Model, robot: Robot) -> None:
    """Give the robot's shapes names, masks and the friction of their links."""
    frictions = _link_frictions(robot)
    for body in model.spec.bodies:
        body.gravcomp = 1.0
        for number, geom in enumerate(body.geoms):
            geom.name = f"{body.name}/{number}"
            _describe(
                model,
                geom,
                frictions.get(body.name.removeprefix("link:"), DEFAULT_FRICTION),
                moves=True,
            )
            geom.contype, geom.conaffinity = ROBOT


def _link_frictions(robot: Robot) -> dict[str, float]:
    """Read <lateral_friction> of the links, as pybullet does."""
    found: dict[str, float] = {}
    for arm in robot.arms:
        for link in read_xml(arm.urdf).iter("link"):
            said = link.find("contact/lateral_friction")
            if said is not None:
                name = arm.prefix + link.get("name", "")
                found[name] = float(said.get("value", DEFAULT_FRICTION))
    return found


def add_floor(model: Model, scene: Scene, *, plane: bool) -> None:
    """Add the floor: a plane for what falls, a thick plate for rays and distances."""
    centre, half = floor_under(scene)
    body = model.spec.worldbody.add_body(name=FLOOR_NAME)
    kinds = model.mujoco.mjtGeom
    if plane:
        geom = body.add_geom(name=f"{FLOOR_NAME}/0", type=kinds.mjGEOM_PLANE, size=[*half[:2], 1.0])
        body.pos = [*centre[:2], 0.0]
    else:
        geom = body.add_geom(name=f"{FLOOR_NAME}/0", type=kinds.mjGEOM_BOX, size=half)
        body.pos = centre
    _describe(model, geom, DEFAULT_FRICTION, moves=False)


def add_body(model: Model, body: Body, *, free: bool, placed: bool) -> None:
    """Add a body: free to fall, or standing still, to be placed anew when wished."""
    made = model.spec.worldbody.add_body(
        name=body_name(body.name), mocap=placed and not free, pos=body.pose.position,
        quat=wxyz(body.pose.quaternion),
    )  # fmt: skip
    if free:
        made.add_freejoint(name=body_name(body.name))
        set_inertia(made, body.parts, body.mass, mass_centre(body))
    for number, part in enumerate(body.parts):
        geom = add_part(model, made, f"{made.name}/{number}", part)
        _describe(model, geom, body.friction, moves=free)


def set_inertia(made: Any, parts: tuple[Part, ...], mass: float, centre: Array) -> None:
    """Give a body mass, centre of mass and the inertia of its parts at one density."""
    tensor = inertia(parts, mass)
    made.mass, made.ipos, made.explicitinertial = mass, centre, True
    made.fullinertia = [
        tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[0, 1], tensor[0, 2], tensor[1, 2],
    ]  # fmt: skip


def add_part(model: Model, made: Any, name: str, part: Part) -> Any:
    """Add a convex part to a body; return the shape."""
    kinds, shape = model.mujoco.mjtGeom, part.shape
    where = {"name": name, "pos": part.pose.position, "quat": wxyz(part.pose.quaternion)}
    if isinstance(shape, Box):
        return made.add_geom(type=kinds.mjGEOM_BOX, size=np.array(shape.size) / 2, **where)
    if isinstance(shape, Cylinder):
        size = [shape.radius, shape.height / 2, 0.0]
        return made.add_geom(type=kinds.mjGEOM_CYLINDER, size=size, **where)
    if isinstance(shape, Sphere):
        return made.add_geom(type=kinds.mjGEOM_SPHERE, size=[shape.radius, 0.0, 0.0], **where)

    mesh = model.spec.add_mesh(
        name=name, uservert=shape.vertices.ravel(), userface=shape.faces.ravel()
    )
    # Of its own volume it has no need: bodies' inertias are given. Thin hulls have next to none.
    mesh.inertia = model.mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    return made.add_geom(type=kinds.mjGEOM_MESH, meshname=name, **where)


def _describe(model: Model, geom: Any, friction: float, *, moves: bool) -> None:
    """Set what contacts of a shape are like."""
    round_ = geom.type in (
        model.mujoco.mjtGeom.mjGEOM_CYLINDER, model.mujoco.mjtGeom.mjGEOM_SPHERE,
    )  # fmt: skip
    geom.condim = 6 if round_ else 4
    geom.friction = [friction**2, SPIN, ROLL]
    geom.solref, geom.solimp = CONTACT_SOFTNESS
    geom.contype, geom.conaffinity = FELT
    model.frictions[geom.name] = (friction, moves)


def add_pairs(model: Model) -> None:
    """Give pairs of shapes of unlike friction their product; likes have it by their squares."""
    by_value: dict[tuple[float, bool], list[str]] = {}
    for name, key in model.frictions.items():
        by_value.setdefault(key, []).append(name)

    for (first, some), (second, others) in itertools.combinations(by_value.items(), 2):
        if first[0] == second[0] or not (first[1] or second[1]):
            continue
        for a, b in itertools.product(some, others):
            if _owner(a) != _owner(b) and not (is_link(a) and is_link(b)):
                _add_pair(model, a, b, first[0] * second[0])


def _add_pair(model: Model, first: str, second: str, friction: float) -> None:
    condim = max(model.spec.geom(name).condim for name in (first, second))
    pair = model.spec.add_pair(geomname1=first, geomname2=second, condim=condim)
    pair.friction = [friction, friction, SPIN, ROLL, ROLL]
    pair.solref, pair.solimp = CONTACT_SOFTNESS


def body_name(body: str) -> str:
    """Return the name of a scene's body in the model, where the robot's links have names, too."""
    return f"body:{body}"


def link_body(link: str) -> str:
    """Return the name of a robot's link in the model, where some names are taken."""
    return f"link:{link}" if link in TAKEN_NAMES else link


def owner_of(geom: str) -> str:
    """Return the scene's name of a body, or the link's, to which a shape belongs."""
    return geom.rpartition("/")[0].removeprefix("body:").removeprefix("link:")


def is_link(geom: str) -> bool:
    """Tell whether a shape is one of the robot's."""
    return not geom.startswith(("body:", f"{FLOOR_NAME}/"))


def _owner(geom: str) -> str:
    return geom.rpartition("/")[0]


def wxyz(quaternion: Iterable[float]) -> list[float]:
    """Return a quaternion xyzw as MuJoCo has it."""
    x, y, z, w = quaternion
    return [w, x, y, z]


def pose_of(position: Array, quaternion: Array) -> Array:
    """Compute T (4, 4) of a position and a quaternion wxyz."""
    w, x, y, z = quaternion.tolist()
    at = position.tolist()
    return Pose((at[0], at[1], at[2]), (x, y, z, w)).matrix
