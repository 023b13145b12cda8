"""A plan file as frozen data. The format is published in tamp/plan/plan.schema.json."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from tamp.geometric.scene.pose import Array
from tamp.plan.pose_field import read_pose
from tamp.symbolic.pddl.structs import Fact
from tamp.system.json_fields import Field, clipped
from tamp.system.reading import read_json

FORMAT, VERSION = "tamp-plan", 1
WIDTHS = {"base": 3, "arm": None}
ARMS_LENGTH = 2.0
"""Metres from the hand beyond which nothing is held."""
PARTS = ("base", "arm", "gripper")


@dataclass(frozen=True)
class PlanSource:
    """A file that the plan was made from: role ("problem", "domain", "mesh"), place and SHA-256."""

    role: str
    path: Path
    sha256: str


@dataclass(frozen=True, eq=False)
class Hold:
    """A grasp: the body, T_tool_body of shape (4, 4), and the fingers' opening in metres; what
    stands on the body and goes along, each with its T_body_rider (4, 4).
    """

    body: str
    T_tool_body: Array
    opening: float
    load: tuple[tuple[str, Array], ...] = ()


@dataclass(frozen=True, eq=False)
class StoredSegment:
    """A stretch of one part's motion, linear between its samples.

    Attributes:
        part: "base", "arm" or "gripper".
        times: Seconds from the segment's start, shape (n,).
        positions: Rows x, y, yaw or joint positions, shape (n, 3 or joints); of the gripper none.
        opening: The fingers' opening at each time, shape (n,), metres.
        holding: The body in the hand on the way.
        attach: The grasp that begins when the fingers have closed.
        detach: The body that is let go when they start to open.
        arm: Which arm, or whose fingers, where the plan says; else the first.
    """

    part: str
    times: Array
    positions: Array
    opening: Array
    holding: str | None = None
    attach: Hold | None = None
    detach: str | None = None
    arm: str | None = None


@dataclass(frozen=True, eq=False)
class Value:
    """The value that an object of a stream stands for.

    `data` is T_world_body (4, 4) of a pose, a Hold of a grasp, x, y, yaw (3,) of a base-conf, the
    rows (n, joints) of a reach's approach and lift, for each segment of a motion its part, rows and
    arm (None when they are not given), and None of every type that we do not know.
    """

    type: str
    data: Any


@dataclass(frozen=True, eq=False)
class TimedAction:
    """One action with its trajectory; `start` and `duration` in seconds."""

    name: str
    arguments: tuple[str, ...]
    start: float
    duration: float
    cost: float
    segments: tuple[StoredSegment, ...]


@dataclass(frozen=True, eq=False)
class PlanFile:
    """A plan. `robot_given`: its robot was given beside the problem, which names another one."""

    file: Path | None
    sources: tuple[PlanSource, ...]
    robot: str
    objects: Mapping[str, tuple[str, ...]]
    initial: tuple[Fact, ...]
    goal: str
    values: Mapping[str, Value]
    actions: tuple[TimedAction, ...]
    certified: tuple[Fact, ...]
    cost: float
    duration: float
    algorithm: str = "adaptive"
    robot_given: bool = False
    samplers: Mapping[str, str] = dataclasses.field(default_factory=dict[str, str])

    def source(self, role: str) -> PlanSource | None:
        """Return the file of that role."""
        return next((source for source in self.sources if source.role == role), None)


def read_plan(plan: dict[str, Any] | Path) -> PlanFile:
    """Read a plan from its file, or from the document already read.

    Raises:
        InputError: It is not such a file, with the place of what is wrong in it.
    """
    file = plan if isinstance(plan, Path) else None
    root = Field(read_json(plan) if isinstance(plan, Path) else plan, "", file)

    if "format" not in root or root["format"].value != FORMAT:
        raise root.wrong('not a plan file: it does not say "format": "tamp-plan"')
    version = root["version"].value
    if version != VERSION:
        raise root["version"].wrong(f"version {clipped(str(version))} is not known, only {VERSION}")

    objects = {name: _names(field) for name, field in root["objects"].fields().items()}
    values = {name: _value(field) for name, field in root["values"].fields().items()}
    result = PlanFile(
        file=file,
        sources=_sources(root["inputs"]),
        robot=root["robot"].text(),
        objects=objects,
        initial=_facts(root["initial"]),
        goal=root["goal"].text(),
        values=values,
        actions=tuple(_action(field) for field in root["actions"].items()),
        certified=_facts(root["certified"]),
        cost=root["cost"].number(),
        duration=root["duration"].number(0.0),
        **_options(root.get("options")),
    )
    _check_bodies(root, result)
    return result


def _options(options: Field | None) -> dict[str, Any]:
    """Read the options with which it was planned, as far as it says so."""
    if options is None:
        return {}
    algorithm, samplers = options.get("algorithm"), options.get("samplers")
    named = {} if samplers is None else samplers.fields()
    return {
        **({} if algorithm is None else {"algorithm": algorithm.text()}),
        "samplers": {relation: name.text() for relation, name in named.items()},
        "robot_given": "robot" in options,
    }


def _sources(inputs: Field) -> tuple[PlanSource, ...]:
    lists = {"meshes": "mesh", "robot": "robot"}
    sources = [_source(role, field) for role, field in inputs.fields().items() if role not in lists]
    for key, role in lists.items():
        files = inputs.get(key)
        sources += [_source(role, field) for field in (files.items() if files else ())]
    for role in ("problem", "domain"):
        inputs[role].mapping()
    return tuple(sources)


def _source(role: str, field: Field) -> PlanSource:
    sha256 = field["sha256"].text()
    if len(sha256) != 64 or not set(sha256) <= set("0123456789abcdef"):
        raise field["sha256"].wrong("64 hexadecimal digits are expected")
    return PlanSource(role, Path(field["path"].text()), sha256)


def _names(field: Field) -> tuple[str, ...]:
    return tuple(item.text() for item in field.items())


def _facts(field: Field) -> tuple[Fact, ...]:
    facts = []
    for item in field.items():
        fact = _names(item)
        if not fact:
            raise item.wrong("a fact needs a predicate")
        facts.append(fact)
    return tuple(facts)


def _value(field: Field) -> Value:
    type_ = field["type"].text()
    data: Any = None
    if type_ == "pose":
        data = read_pose(field)
    elif type_ == "grasp":
        data = _hold(field)
    elif type_ == "base-conf":
        data = field["base"].numbers(3)
    elif type_ == "reach":
        data = (field["approach"].rows(), field["lift"].rows())
    elif type_ == "motion" and "segments" in field:
        data = tuple(_stretch(item) for item in field["segments"].items())
    return Value(type_, data)


def _stretch(field: Field) -> tuple[str, Array, str | None]:
    """Read a part and the rows that it goes through, without times; of a gripper its openings."""
    part, arm = field["part"].text(PARTS), _arm(field)
    if part == "gripper":
        return part, field["opening"].numbers()[:, None], arm
    return part, field["points"].rows(WIDTHS[part]), arm


def _arm(field: Field) -> str | None:
    arm = field.get("arm")
    return arm.text() if arm else None


def _hold(field: Field) -> Hold:
    return Hold(field["body"].text(), _in_hand(field["T_tool_body"]), field["opening"].number(0.0))


def _in_hand(field: Field) -> Array:
    """Read a body's pose in the tool frame."""
    T_tool_body = read_pose(field)
    if np.abs(T_tool_body[:3, 3]).max() > ARMS_LENGTH:
        raise field["position"].wrong("farther from the hand than anything that it could hold")
    return T_tool_body


def _action(field: Field) -> TimedAction:
    cost = field.get("cost")
    return TimedAction(
        name=field["name"].text(),
        arguments=_names(field["arguments"]),
        start=field["start"].number(),
        duration=field["duration"].number(0.0),
        cost=cost.number() if cost else 0.0,
        segments=tuple(_segment(item) for item in field["segments"].items()),
    )


def _segment(field: Field) -> StoredSegment:
    part, arm = field["part"].text(PARTS), _arm(field)
    times = field["times"].numbers()
    if len(times) == 0:
        raise field["times"].wrong("at least one time is expected")

    if part == "gripper":
        opening = field["opening"].numbers(len(times))
        attach, detach = field.get("attach"), field.get("detach")
        hold = None
        if attach:
            riders = attach.get("load")
            load = [(one["body"].text(), read_pose(one["T_body_rider"]))
                    for one in (riders.items() if riders else ())]  # fmt: skip
            T_tool_body = _in_hand(attach["T_tool_body"])
            hold = Hold(attach["body"].text(), T_tool_body, float(opening[-1]), tuple(load))
        positions = np.empty((len(times), 0))
        let_go = detach.text() if detach else None
        return StoredSegment(part, times, positions, opening, None, hold, let_go, arm)

    positions = field["positions"].rows(WIDTHS[part])
    if len(positions) != len(times):
        what = f"{len(times)} rows are expected, one a time, not {len(positions)}"
        raise field["positions"].wrong(what)
    opening = np.full(len(times), field["opening"].number())
    holding = field.get("holding")
    held = holding.text() if holding else None
    return StoredSegment(part, times, positions, opening, held, arm=arm)


def _check_bodies(root: Field, plan: PlanFile) -> None:
    names = tuple(sorted(plan.objects))
    for action, field in zip(plan.actions, root["actions"].items(), strict=True):
        for segment, place in zip(action.segments, field["segments"].items(), strict=True):
            named = (
                segment.holding,
                segment.detach,
                segment.attach.body if segment.attach else None,
                *(name for name, _ in (segment.attach.load if segment.attach else ())),
            )
            for body in named:
                if body is not None and body not in plan.objects:
                    raise place.wrong(f"unknown body '{body}'", found=body, choices=names)
    for name, value in plan.values.items():
        if isinstance(value.data, Hold) and value.data.body not in plan.objects:
            body = value.data.body
            raise root["values"][name].wrong(f"unknown body '{body}'", found=body, choices=names)
