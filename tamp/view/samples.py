"""The poses and grasps that were tried, and what became of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tamp.geometric.scene.pose import Array
from tamp.geometric.scene.scene import Scene
from tamp.plan.pose_field import read_pose
from tamp.system.json_fields import Field


@dataclass(frozen=True, eq=False)
class SampleMarker:
    """A sample as it is shown.

    Attributes:
        kind: "placement" or "grasp".
        body: Whose.
        T: T_world_body of a placement, T_tool_body of a grasp; shape (4, 4).
        used: Whether the plan rests on it.
        test: The stream that said no to it most often, or None.
        why: What it said.
        others: The bodies that the reasons name; none in files that do not list them.
        text: Everything about it in a line.
    """

    kind: str
    body: str
    T: Array
    used: bool
    test: str | None
    why: str
    others: tuple[str, ...]
    text: str


def sample_markers(
    document: Mapping[str, Any], scene: Scene, file: Path | None = None
) -> tuple[SampleMarker, ...]:
    """Collect the samples of a plan file's record, and the poses and grasps that the plan itself
    has.

    Raises:
        InputError: The record is not what the format says.
    """
    root = Field(dict(document), "", file)
    names = {name.lower(): name for name in (*scene.bodies, *scene.surfaces, *scene.cavities)}
    record = root.get("record")
    if record is not None:
        found = [_shot(item, names, scene) for item in record["samples"].items()]
        return tuple(shot for shot in found if shot is not None)

    grasps = [
        field
        for field in (root["values"].fields().values() if "values" in root else ())
        if _is_grasp(field)
    ]

    made = []
    for field in grasps:
        body = names.get(field["body"].text(), "")
        if body in scene.bodies:
            T = read_pose(field["T_tool_body"])
            made.append(
                SampleMarker("grasp", body, T, True, None, "", (), f"grasp of {body}: in the plan")
            )
    return tuple(made)


def _is_grasp(field: Field) -> bool:
    return "type" in field and field["type"].value == "grasp"


def _shot(field: Field, names: Mapping[str, str], scene: Scene) -> SampleMarker | None:
    arguments = [names.get(item.text(), item.text()) for item in field["arguments"].items()]
    if not arguments or arguments[0] not in scene.bodies:
        return None
    grasp = _is_grasp(field)
    T = read_pose(field["T_tool_body"]) if grasp else read_pose(field)
    used, stream = field["used"].value is True, field["stream"].text()
    refusals = [
        (item["stream"].text(), item["reason"].text(), int(item["count"].number(1.0)))
        for item in field["refusals"].items()
    ]
    body, *places = arguments
    reasons = "; ".join(
        f"{who}: {why}" + (f" ({times} times)" if times > 1 else "") for who, why, times in refusals
    )
    what = f"grasp of {body}" if grasp else " ".join([f"{body} by {stream}", *places])
    verdict = "in the plan" if used else "rejected" if refusals else "accepted"
    met = {
        word.text().lower()
        for item in field["refusals"].items()
        for word in (item["bodies"].items() if "bodies" in item else ())
    }

    return SampleMarker(
        kind="grasp" if grasp else "placement",
        body=body,
        T=T,
        used=used,
        test=refusals[0][0] if refusals else None,
        why=refusals[0][1] if refusals else "",
        others=tuple(name for name in scene.bodies if name.lower() in met and name != body),
        text=f"{what}: {verdict}" + (f" ({reasons})" if reasons else ""),
    )
