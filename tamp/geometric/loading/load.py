"""From a problem file in YAML to a frozen scene. docs/problem-format.md describes the file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from tamp.errors import InputError
from tamp.geometric.loading.bodies import UnplacedBody, read_body
from tamp.geometric.loading.initial_poses import FLOOR_NAME, MAX_COORDINATE_M, place_bodies
from tamp.geometric.loading.passage import PddlPassage
from tamp.geometric.loading.robots import find_robot, load_robot
from tamp.geometric.loading.steadying import steady
from tamp.geometric.loading.yaml_file import read_yaml
from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.scene import RobotStart, Room, Scene
from tamp.system.files import find_problem

_PROBLEM_KEYS = ("name", "domain", "robot", "room", "bodies", "goal", "init", "metric", "samplers")

_UNBOUNDED_ROOM = Room((-MAX_COORDINATE_M, MAX_COORDINATE_M), (-MAX_COORDINATE_M, MAX_COORDINATE_M))
_NO_MATTER_WHICH = RobotStart("panda_mobile", (0.0, 0.0, 0.0))


@dataclass(frozen=True)
class LoadedProblem:
    """A problem file: the scene, and what only the symbolic side understands.

    Attributes:
        path: The file.
        scene: Everything geometric.
        goal: In PDDL, with its place in the file.
        domain: The domain's name or path, when the file names one.
        init: Facts that hold at the start beside those that the scene implies.
        metric: In PDDL.
        samplers: Sampler by relation, as `--sampler` gives them.
        meshes: The mesh files that were read.
        drawn: The mesh files that are only drawn, which no plan depends on.
        warnings: What was repaired or looks odd, one sentence each.
        lines: 1-based line of each body and of `robot`, for later errors about them.
        entry_lines: The same of all entries of the file and of each of the `samplers`, by the keys
            that lead there.
    """

    path: Path
    scene: Scene
    goal: PddlPassage
    domain: str | None
    init: tuple[PddlPassage, ...]
    metric: PddlPassage | None
    samplers: Mapping[str, str]
    meshes: tuple[Path, ...]
    warnings: tuple[str, ...]
    drawn: tuple[Path, ...]
    lines: Mapping[str, int]
    entry_lines: Mapping[tuple[str, ...], int]

    def error(self, message: str, about: str | None = None, remedy: str = "") -> InputError:
        """Return an error about this problem, one of its bodies or its `robot`, with the line."""
        return InputError(message, file=self.path, line=self.lines.get(about or ""), remedy=remedy)

    def line_of(self, *keys: str) -> int | None:
        """Find where an entry stands, such as ("samplers", "on"); None where it is not known."""
        return self.entry_lines.get(keys)


def load_scene(
    problem: str | Path, robot: str | None = None, *, demonstration: bool = False
) -> LoadedProblem:
    """Load a problem file.

    Args:
        problem: A path, or the name of a shipped problem.
        robot: A shipped robot's name or a robot's folder, instead of the one that the file names;
            its arm then starts at home.
        demonstration: Whether it may go without robot and room, since no plan is wanted.

    Raises:
        InputError: Anything wrong with the file, with its line.
    """
    path = find_problem(problem)
    root = read_yaml(path)
    needed = ("bodies", "goal") if demonstration else ("robot", "room", "bodies", "goal")
    entries = root.mapping(_PROBLEM_KEYS, required=needed)
    name = entries["name"].text() if "name" in entries else path.stem
    room = _room(entries["room"]) if "room" in entries else _UNBOUNDED_ROOM
    start = _NO_MATTER_WHICH
    if "robot" in entries:
        start = _robot(entries["robot"], room, path, robot)

    drafts = {
        body: read_body(body, node, path.parent)
        for body, node in entries["bodies"].mapping().items()
    }
    _check_names(drafts)

    placed, warnings = place_bodies(drafts)
    bodies, unsteady = steady(placed, drafts)
    meshes = [(body, draft.mesh) for body, draft in drafts.items() if draft.mesh]
    samplers = entries["samplers"].mapping() if "samplers" in entries else {}

    return LoadedProblem(
        path=path,
        scene=Scene(name, MappingProxyType(bodies), start, room),
        goal=entries["goal"].passage(),
        domain=entries["domain"].text() if "domain" in entries else None,
        init=tuple(fact.passage() for fact in entries["init"].items()) if "init" in entries else (),
        metric=entries["metric"].passage() if "metric" in entries else None,
        samplers=MappingProxyType({relation: node.text() for relation, node in samplers.items()}),
        meshes=tuple(dict.fromkeys(file for _, mesh in meshes for file in mesh.files)),
        drawn=tuple(
            dict.fromkeys(
                one.mesh for _, mesh in meshes for one in mesh.visuals if one.mesh is not None
            )
        ),
        warnings=(
            *(f"{body}: {text}" for body, mesh in meshes for text in mesh.warnings),
            *warnings,
            *unsteady,
        ),
        entry_lines={
            **{(key,): node.line for key, node in entries.items()},
            **{("samplers", relation): node.line for relation, node in samplers.items()},
        },
        lines={
            "robot": entries["robot"].line if "robot" in entries else root.line,
            **{body: draft.node.line for body, draft in drafts.items()},
        },
    )


def _room(node: YamlNode) -> Room:
    entries = node.mapping(("x", "y"), required=("x", "y"))
    limits: list[tuple[float, float]] = []
    for axis in ("x", "y"):
        low, high = entries[axis].numbers(2)
        if not low < high:
            raise entries[axis].error(f"the lower limit {low:g} is not below the upper {high:g}")
        if max(-low, high) > MAX_COORDINATE_M:
            raise entries[axis].error(
                f"the room reaches farther than {MAX_COORDINATE_M:g} m from the world's origin"
            )
        limits.append((low, high))
    return Room(*limits)


def _robot(node: YamlNode, room: Room, file: Path, instead: str | None) -> RobotStart:
    entries = node.mapping(("model", "base", "arm"), required=("model", "base"))
    named = entries["model"]
    if instead is not None:
        model = find_robot(instead)
    else:
        try:
            model = find_robot(named.text(), file.parent)
        except InputError as error:
            raise error.at(file, named.line) from None
    base = entries["base"].items(3)
    x, y, yaw = base[0].number(), base[1].number(), base[2].angle()
    for axis, value, (low, high) in (("x", x, room.x), ("y", y, room.y)):
        if not low <= value <= high:
            raise entries["base"].error(
                f"the robot starts out of the room: {axis} = {value:g} is not within "
                f"[{low:g}, {high:g}]"
            )
    own = "arm" in entries and instead is None
    return RobotStart(model, (x, y, yaw), _arm(entries["arm"], model) if own else None)


def _arm(node: YamlNode, model: str) -> tuple[float, ...]:
    robot = load_robot(model)
    joints = node.items(len(robot.lower))
    angles = tuple(joint.angle() for joint in joints)
    for joint, angle, low, high in zip(joints, angles, robot.lower, robot.upper, strict=True):
        if not low <= angle <= high:
            what = f"{angle:g} rad is outside of the joint's limits [{low:.5g}, {high:.5g}]"
            raise joint.error(f"{what}, the maker's less a margin")
    return angles


def _check_names(drafts: Mapping[str, UnplacedBody]) -> None:
    """Check that all names are unique: they share one space, in which case does not count (PDDL's
    rule); one place may be named as its body.
    """
    owners = {"robot": "the robot", FLOOR_NAME: "the floor"}
    for name, draft in drafts.items():
        if name.lower() in owners:
            raise draft.node.error(f"the name '{name}' is taken by {owners[name.lower()]}")
        owners[name.lower()] = f"body '{name}'"
    for name, draft in drafts.items():
        own = True
        for place in (*draft.body.surfaces, *draft.body.cavities):
            key = place.name.lower()
            if key in owners and not (own and place.name == name):
                raise draft.node.error(
                    f"the name '{place.name}' of its surface or cavity is taken by {owners[key]}"
                )
            own = own and place.name != name
            owners[key] = f"a surface or cavity of '{name}'"
