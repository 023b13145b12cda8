"""Initial poses: the places of the bodies of a problem at the start."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tamp.geometric.loading.bodies import UnplacedBody
from tamp.geometric.loading.footing import FLOOR_NAME
from tamp.geometric.loading.orientation import read_orientation, read_pose
from tamp.geometric.loading.tops import top_of
from tamp.geometric.loading.yaml_nodes import YamlNode
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.scene.scene import CONTACT_GAP, LEVEL_COSINE, Body

MAX_COORDINATE_M = 1e5
"""Metres from the world's origin: farther out numbers lose the tenths of a millimetre that contacts
need.
"""

_HIGHEST_PILE = 200
_SNAP_DISTANCE_M = 0.002


@dataclass(frozen=True)
class _Place:
    """A horizontal rectangle in the world that may carry a body. `name` is None for the floor."""

    name: str | None
    pose: Pose
    size: tuple[float, float]

    def outside(self, point: Array) -> float:
        """Compute how far a world point lies beyond the rectangle's edges, metres; 0 within it."""
        x, y, _ = self.pose.inverse().apply(point[None])[0]
        return max(0.0, abs(float(x)) - self.size[0] / 2, abs(float(y)) - self.size[1] / 2)


def place_bodies(drafts: Mapping[str, UnplacedBody]) -> tuple[dict[str, Body], tuple[str, ...]]:
    """Give every body its pose and its support.

    Returns:
        The placed bodies in the order of the drafts, and warnings.

    Raises:
        InputError: An unknown support, one outside of its support, bodies that stand on each other
            in a circle.
    """
    return _InitialPoses(drafts).run()


class _InitialPoses:
    def __init__(self, drafts: Mapping[str, UnplacedBody]) -> None:
        self.drafts = drafts
        self.owners = {
            place.name: draft.body.name
            for draft in drafts.values()
            for place in (*draft.body.surfaces, *draft.body.cavities)
        }
        self.placed: dict[str, Body] = {}
        self.warnings: list[str] = []
        self.places: list[tuple[str, _Place]] = []
        self.heights = np.zeros(0)

    def run(self) -> tuple[dict[str, Body], tuple[str, ...]]:
        for name in self.drafts:
            self.place(name, ())
        bodies = {name: self.placed[name] for name in self.drafts}
        # Every place once: thousands of bodies make millions of pairs.
        self.places = [
            (body.name, place)
            for body in self.placed.values()
            for place in (*_places(body).values(), *filter(None, [_top(body)]))
        ]
        self.heights = np.array([place.pose.position[2] for _, place in self.places])
        for name, draft in self.drafts.items():
            if "on" not in draft.entries and bodies[name].movable:
                bodies[name] = self.with_inferred_support(bodies[name], draft.node)
        return bodies, tuple(self.warnings)

    def place(self, name: str, above: tuple[str, ...]) -> None:
        """Place a body, and first the one it stands on; `above` are those that wait for it."""
        if name in self.placed:
            return
        draft = self.drafts[name]
        if name in above:
            circle = " on ".join((*above[above.index(name) :], name))
            raise draft.entries["on"].error(f"these stand on each other in a circle: {circle}")
        if len(above) > _HIGHEST_PILE:
            raise draft.node.error(f"it carries more than {_HIGHEST_PILE} bodies, one on the other")
        if "on" in draft.entries:
            self.placed[name] = self.placed_on_support(draft, (*above, name))
        else:
            self.placed[name] = self.placed_at_pose(draft)
        if max(map(abs, self.placed[name].pose.position)) > MAX_COORDINATE_M:
            raise draft.node.error(
                f"it is farther than {MAX_COORDINATE_M:g} m from the world's origin"
            )
        self.check_level(self.placed[name], draft.node)

    def placed_at_pose(self, draft: UnplacedBody) -> Body:
        """Place a body given by `pose:`, or by `at: [x, y, z]` and how it is turned."""
        entries = draft.entries
        if "pose" in entries:
            for key in entries:
                if key != "pose":
                    raise entries[key].error(f"'pose' and '{key}' both say where it is: keep one")
            return replace(draft.body, pose=read_pose(entries["pose"]))
        if "at" not in entries:
            remedy = "Give 'on: <surface>', 'at: [x, y, z]' or 'pose:'"
            raise draft.node.error("nothing says where it is", remedy=remedy)
        if len(entries["at"].items()) == 2:
            remedy = "Or say what it stands on, such as 'on: floor'"
            raise entries["at"].error("expected 3 numbers, found 2", remedy=remedy)
        x, y, z = entries["at"].numbers(3)
        return replace(draft.body, pose=Pose((x, y, z), read_orientation(entries)))

    def placed_on_support(self, draft: UnplacedBody, above: tuple[str, ...]) -> Body:
        """Place a body given by `on:`: upright as modelled unless turned, its lowest point just
        above the support.
        """
        entries, name = draft.entries, draft.body.name
        if "pose" in entries:
            raise entries["pose"].error("'on' and 'pose' both say where it is: keep one")
        place = self.support(entries["on"], above)
        x, y = entries["at"].numbers(2) if "at" in entries else (0.0, 0.0)
        pose = place.pose @ Pose((x, y, 0.0), read_orientation(entries))
        pose = _on(draft.body, pose, place.pose.position[2])
        low, high = bounds(draft.body.parts, pose)
        beyond = place.outside((low + high) / 2)
        if beyond > 0:
            size = " x ".join(f"{side:g}" for side in place.size)
            origin = np.array(pose.position)
            remedy = f"'at' is in its frame; it reaches {size} m"
            if place.outside(origin) == 0:
                remedy = "Its mesh's origin is far from its middle"
            raise entries.get("at", entries["on"]).error(
                f"{name}'s centre is {beyond:.3f} m outside of '{place.name}'", remedy=remedy
            )
        return replace(draft.body, pose=pose, support=place.name)

    def support(self, node: YamlNode, above: tuple[str, ...]) -> _Place:
        """Find the surface, the cavity, the carrying body or the floor that `on:` names."""
        name = node.text()
        if name == FLOOR_NAME and name not in self.owners and name not in self.drafts:
            return _Place(None, Pose(), (math.inf, math.inf))

        if name in self.owners:
            self.place(self.owners[name], above)
            return _places(self.placed[self.owners[name]])[name]

        if name in self.drafts:
            body = self.drafts[name].body
            if body.surfaces or body.cavities:
                parts = [place.name for place in (*body.surfaces, *body.cavities)]
                raise node.error(f"'{name}' has several places to stand", choices=parts)

            self.place(name, above)
            top = _top(self.placed[name])
            if top is None:
                raise node.error(
                    f"'{name}' has no flat top to stand on", remedy="Declare one with 'surfaces:'"
                )
            return top

        supports = sorted({*self.owners, *self.drafts, FLOOR_NAME} - {above[-1]})
        raise node.error(f"unknown surface or body '{name}'", found=name, choices=supports)

    def check_level(self, body: Body, node: YamlNode) -> None:
        for place in (*body.surfaces, *body.cavities):
            if (body.pose @ place.pose).rotation[2, 2] < LEVEL_COSINE and not body.movable:
                raise node.error(f"'{place.name}' is not horizontal, nothing can stand on it")

    def with_inferred_support(self, body: Body, node: YamlNode) -> Body:
        """Settle a movable body given by its pose: snap it to what is within 2 mm below it."""
        low, high = bounds(body.parts, body.pose)
        if low[2] < -_SNAP_DISTANCE_M:
            raise node.error(
                f"it reaches {-low[2]:.3f} m below the floor", remedy="Or say 'fixed: true'"
            )
        base = np.array([*(low + high)[:2] / 2, low[2]])
        places = [_Place(None, Pose(), (math.inf, math.inf))]
        for index in np.flatnonzero(np.abs(self.heights - low[2]) <= _SNAP_DISTANCE_M):
            owner, place = self.places[index]
            places += [place] if owner != body.name else []
        under = [
            (abs(low[2] - place.pose.position[2]), index, place)
            for index, place in enumerate(places)
            if abs(low[2] - place.pose.position[2]) <= _SNAP_DISTANCE_M and place.outside(base) == 0
        ]
        if not under:  # in the air, or on several bodies: `steady` asks
            return body
        _, _, place = min(under)
        return replace(body, pose=_on(body, body.pose, place.pose.position[2]), support=place.name)


def _on(body: Body, pose: Pose, height: float) -> Pose:
    """Return the pose with the body's lowest point lifted to CONTACT_GAP above `height`."""
    low, _ = bounds(body.parts, pose)
    x, y, z = pose.position
    return Pose((x, y, z + height + CONTACT_GAP - float(low[2])), pose.quaternion)


def _places(body: Body) -> dict[str, _Place]:
    """List the declared or derived places of a placed body that are level."""
    places: dict[str, _Place] = {}
    for place in (*body.surfaces, *body.cavities):
        pose = body.pose @ place.pose
        if pose.rotation[2, 2] >= LEVEL_COSINE:
            places[place.name] = _Place(place.name, pose, place.size[:2])
    return places


def _top(body: Body) -> _Place | None:
    """Return the highest level face, on which others may stand, of a body without own places."""
    top = None if body.surfaces or body.cavities else top_of(body.name, body.parts, body.pose)
    return None if top is None else _Place(body.name, body.pose @ top.pose, top.size)
