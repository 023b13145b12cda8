"""Everything that a page shows, as JSON."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from tamp.geometric.robot.robot import Link, Robot
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.view.appearance import body_meshes, robot_meshes
from tamp.view.inspection import inspection
from tamp.view.mesh import Mesh
from tamp.view.picture import framing
from tamp.view.samples import SampleMarker
from tamp.view.story import PlanningSummary
from tamp.view.timeline import Timeline

GRID = 65_535
"""Steps on each side of a mesh in which its vertices are told."""


def page_document(
    timeline: Timeline, story: PlanningSummary, sample_markers: tuple[SampleMarker, ...] = ()
) -> dict[str, Any]:
    """Describe timeline, samples and story as the document that assets/page.js reads."""
    return {
        "title": timeline.scene.name,
        "robot": _robot(timeline),
        "bodies": _bodies(timeline),
        "surfaces": _surfaces(timeline),
        "room": {"x": list(timeline.scene.room.x), "y": list(timeline.scene.room.y)},
        "actions": _actions(timeline),
        "times": _packed(timeline.times.astype("<f4")),
        "rows": _packed(timeline.rows.astype("<f4")),
        "samples": _samples(sample_markers),
        "story": _story(story),
        "view": _view(timeline),
        "inspection": inspection(timeline.robot) if timeline.inspected else None,
    }


def _robot(timeline: Timeline) -> dict[str, Any]:
    """Describe the robot's links, and the frames from one to the next."""
    robot = timeline.robot
    looks = robot_meshes(robot)

    return {
        "links": [
            {"name": link.name, "meshes": packed_meshes(looks[link.name])}
            for link in _ordered(robot)
        ],
        "arms": [_arm(arm) for arm in robot.arms],
    }


def _arm(arm: Robot) -> dict[str, Any]:
    """Describe an arm: its links' names, and the frames from one to the next."""
    return {
        "foot": arm.foot,
        "hand": arm.hand,
        "T_base_arm": _matrix(arm.T_base_arm.matrix),
        "joints": [
            {"link": joint.child, "origin": _matrix(joint.origin.matrix), "slides": slides}
            for joint, slides in zip(arm.joints, arm.prismatic, strict=True)
        ],
        "T_flange_hand": _matrix(arm.T_flange_hand.matrix),
        "T_hand_tool": _matrix(arm.T_hand_tool.matrix),
        "fingers": [
            {
                "link": finger.child,
                "origin": _matrix(finger.origin.matrix),
                "axis": list(finger.axis),
            }
            for finger in arm.fingers
        ],
    }


def _ordered(robot: Robot) -> Iterator[Link]:
    """Yield the links in the page's order: base, then each arm's foot, links, hand and fingers."""
    yield robot.link(robot.base)
    for arm in robot.arms:
        names = (arm.foot, *(joint.child for joint in arm.joints), arm.hand)
        yield from (*map(arm.link, names), *arm.finger_links)


def _bodies(timeline: Timeline) -> list[dict[str, Any]]:
    """Describe the bodies: their meshes, and the poses that they take in turn."""
    return [
        {
            "name": name,
            "movable": body.movable,
            "height": float(bounds(body.parts, Pose())[1][2]),
            "meshes": packed_meshes(body_meshes(body)),
            "stays": [
                {"since": stay.since, "held": stay.held, "T": _matrix(stay.T), "arm": stay.arm}
                for stay in timeline.stays[name]
            ]
            if name in timeline.stays
            else [{"since": 0.0, "held": False, "T": _matrix(body.pose.matrix), "arm": 0}],
        }
        for name, body in timeline.scene.bodies.items()
    ]


def _surfaces(timeline: Timeline) -> list[dict[str, Any]]:
    """Describe the surfaces, and the floors of the cavities, as rectangles."""
    scene = timeline.scene
    return [
        {
            "name": place.name,
            "T": _matrix(scene.world_pose(place).matrix),
            "size": list(place.size[:2]),
        }
        for place in (*scene.surfaces.values(), *scene.cavities.values())
    ]


def _actions(timeline: Timeline) -> list[dict[str, Any]]:
    """Describe the plan's actions, and when each begins and ends, seconds."""
    return [
        {
            "name": action.name,
            "about": action.text.removeprefix(action.name).strip(),
            "text": action.text,
            "start": action.start,
            "end": action.end,
        }
        for action in timeline.actions
    ]


def _samples(sample_markers: Sequence[SampleMarker]) -> list[dict[str, Any]]:
    """Describe the samples that were tried."""
    return [
        {
            "kind": shot.kind,
            "body": shot.body,
            "T": _matrix(shot.T),
            "used": shot.used,
            "test": shot.test,
            "why": shot.why,
            "others": list(shot.others),
            "text": shot.text,
        }
        for shot in sample_markers
    ]


def _story(story: PlanningSummary) -> dict[str, Any]:
    """Describe how the plan was found, for the page's panel."""
    return {
        "head": story.head,
        "why": list(story.why),
        "skeletons": [{"text": text, "lines": list(lines)} for text, lines in story.skeletons],
        "search": story.search,
        "streams": [list(row) for row in story.streams],
        "time": [list(row) for row in story.time],
    }


def _view(timeline: Timeline) -> dict[str, Any]:
    """Describe the first camera, and the ball in which shadows are drawn."""
    camera = framing(timeline, (1000, 800))
    target, out = np.array(camera.target), np.array(camera.eye) - np.array(camera.target)
    distance = float(np.linalg.norm(out))
    room = timeline.scene.room
    middle = [sum(room.x) / 2, sum(room.y) / 2, 0.5]
    return {
        "target": target.tolist(),
        "yaw": math.atan2(out[1], out[0]),
        "pitch": math.asin(out[2] / distance),
        "distance": distance,
        "angle": camera.angle,
        "middle": middle,
        "radius": math.hypot(room.x[1] - room.x[0], room.y[1] - room.y[0]) / 2 + 1.0,
    }


def packed_meshes(meshes: tuple[Mesh, ...]) -> list[dict[str, Any]]:
    """Describe meshes as assets/draw.js reads them; one without faces is left out."""
    return [_mesh(mesh) for mesh in meshes if len(mesh.faces)]


def _mesh(mesh: Mesh) -> dict[str, Any]:
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    step = np.maximum(high - low, 1e-9) / GRID
    return {
        "vertices": _packed(np.round((mesh.vertices - low) / step).astype("<u2")),
        "faces": _packed(mesh.faces.astype("<u4")),
        "low": low.tolist(),
        "step": step.tolist(),
        "colour": [round(part, 4) for part in mesh.colour],
    }


def _matrix(T: Array) -> list[float]:
    return [round(float(number), 7) + 0.0 for number in T.ravel()]


def _packed(array: np.ndarray) -> str:
    return base64.b64encode(array.tobytes()).decode()
