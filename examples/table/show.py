r"""Show four relations by a program: left_of, between, stack and pack, twelve scenes of each label.

    python examples/table/show.py FOLDER

What tamp ships as `--sampler stack=learned` (and left_of, between, pack) was learned from these and nothing else:

    python examples/table/show.py demos
    tamp-learn new stack --demos demos/stack --out grounding/assets/stack_learned.safetensors \
        --add-to domains/learned.pddl

(then pack, left_of and between, in this order.) Everything that does not matter is varied: heights, sizes, yaws, where
on the furniture. A hand is not exact: a few millimetres and degrees are added.
"""

import math
import random
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from grounding.relations.demonstration_file import Label
from grounding.relations.demonstration_text import BodyEntry, DemonstrationFile, write_demonstration
from tamp.geometric.scene.pose import Pose

EACH = 12
"""Scenes of each label."""

AIR = 0.001
"""Metres between a body and what it rests on."""

Shape = dict[str, Any]
"""A body's shape as a problem file has it."""

Scene = tuple[tuple[str, ...], dict[str, BodyEntry]]


class Table:
    """A table anywhere, of any height, and what is put on it. Metres, radians."""

    def __init__(self, rng: random.Random) -> None:
        self.rng, self.u = rng, rng.uniform
        self.height = round(self.u(0.35, 1.0), 3)
        self.front = Pose.from_xyz_yaw(self.u(-1, 1), self.u(-1, 1), 0.0, self.u(-math.pi, math.pi))
        size = [round(self.u(1.0, 1.6), 3), round(self.u(0.7, 1.0), 3), self.height]
        self.bodies = {"table": BodyEntry({"furniture": "table", "size": size}, self.front)}

    def put(self, name: str, shape: Shape, x: float, y: float, yaw: float, up: float = 0.0) -> None:
        """Put a body down: x to the right and y to the rear as seen from the front, `up` over the table."""
        z = self.height + AIR + up + (0.0 if "furniture" in shape else tall(shape) / 2)
        self.bodies[name] = BodyEntry(shape, self.front @ Pose.from_xyz_yaw(x, y, z, yaw))

    def any_yaw(self) -> float:
        """Draw a yaw."""
        return self.u(-math.pi, math.pi)

    def box(self, low: float, high: float, height: tuple[float, float]) -> Shape:
        """Draw a box whose base's sides are between two lengths, and its height."""
        return {"box": [round(self.u(low, high), 3), round(self.u(low, high), 3), round(self.u(*height), 3)]}

    def can(self, radius: tuple[float, float], height: tuple[float, float]) -> Shape:
        """Draw a cylinder."""
        return {"cylinder": {"radius": round(self.u(*radius), 3), "height": round(self.u(*height), 3)}}

    def cup(self) -> Shape:
        """Draw what one drinks from: round or square."""
        return self.can((0.025, 0.045), (0.06, 0.14)) if self.u(0, 1) < 0.7 else self.box(0.05, 0.08, (0.06, 0.14))

    def plate(self) -> Shape:
        """Draw a plate: a disc, or a square one with a rim, by which a hand can take it."""
        if self.u(0, 1) < 0.5:
            return self.can((0.07, 0.11), (0.015, 0.04))
        side = round(self.u(0.14, 0.22), 3)
        return {"furniture": "open_box", "size": [side, side, round(self.u(0.025, 0.05), 3)], "fixed": False}


def tall(shape: Shape) -> float:
    """The height of an upright shape."""
    match shape:
        case {"cylinder": {"height": height}} | {"box": [_, _, height]} | {"size": [_, _, height]}:
            return float(height)
    raise ValueError(shape)


def wide(shape: Shape) -> float:
    """Half its width across, at most."""
    match shape:
        case {"cylinder": {"radius": radius}}:
            return float(radius)
        case {"box": [x, y, _]} | {"size": [x, y, _]}:
            return max(float(x), float(y)) / 2
    raise ValueError(shape)


def left_of(t: Table, holds: bool, way: int) -> Scene:
    """A cup left of a plate as seen from the front, with a hand's width between."""
    cup, plate, middle = t.cup(), t.plate(), t.u(-0.1, 0.2)
    turn = 0.0 if "size" in plate else t.any_yaw()
    gap, behind, side = t.u(0.05, 0.12), t.u(-0.03, 0.03), -1
    if not holds:  # too far, behind, in front (left of its middle as well), right of it
        gap, behind, side = [
            (t.u(0.2, 0.35), behind, -1), (t.u(-0.06, 0.12), t.u(0.15, 0.3), -1),
            (t.u(-0.06, 0.12), -t.u(0.15, 0.3), -1), (gap, behind, 1),
        ][way]  # fmt: skip
    t.put("plate", plate, middle, 0.0, turn + t.u(-0.1, 0.1))
    t.put("cup", cup, middle + side * (wide(plate) + gap + wide(cup)), behind, t.any_yaw())
    return ("cup", "plate"), t.bodies


def between(t: Table, holds: bool, way: int) -> Scene:
    """A fork between a cup and a plate, its length across the line from one to the other."""
    cup, plate, along = t.cup(), t.plate(), t.any_yaw()
    fork: Shape = {"box": [round(t.u(0.016, 0.026), 3), round(t.u(0.12, 0.2), 3), round(t.u(0.018, 0.03), 3)]}
    gap, half, slack = t.u(0.06, 0.14), wide(fork), t.u(-0.012, 0.012)
    share, aside, turn = t.u(0.4, 0.6), t.u(-0.015, 0.015), t.u(-0.12, 0.12) + math.pi * t.rng.randrange(2)
    if not holds and way == 3:  # along the line
        gap, turn = gap + 0.12, turn + t.u(0.7, 2.4)
    x, y = math.cos(along), math.sin(along)
    start, end = -(gap / 2 + wide(cup)), gap / 2 + wide(plate)
    at = (share - 0.5) * gap + slack
    fork_at = (x * at - y * aside, y * at + x * aside)
    if not holds and way < 3:  # as near to the cup, or to the plate, but elsewhere around it; beside the two
        centre, away = (start, at - start) if way == 0 else (end, end - at)
        round_it = along + t.u(1.0, 2 * math.pi - 1.0) + (math.pi if way == 1 else 0.0)
        fork_at = (x * centre + away * math.cos(round_it), y * centre + away * math.sin(round_it))
        turn = turn + (round_it - along)
        if way == 2:
            aside = t.rng.choice([-1, 1]) * (half + t.u(0.05, 0.12))
            fork_at, turn = (x * at - y * aside, y * at + x * aside), turn - (round_it - along)
    t.put("cup", cup, x * start, y * start, t.any_yaw())
    t.put("plate", plate, x * end, y * end, t.any_yaw())
    t.put("fork", fork, *fork_at, along + turn)
    return ("fork", "cup", "plate"), t.bodies


def stack(t: Table, holds: bool, way: int) -> Scene:
    """A body on the top of another one, its middle well over it."""
    below = t.box(0.06, 0.16, (0.03, 0.1))
    above = t.box(0.04, 0.09, (0.03, 0.1)) if t.u(0, 1) < 0.6 else t.can((0.025, 0.04), (0.05, 0.12))
    half = [side / 2 for side in below["box"]][:2]
    turn, up = t.any_yaw(), tall(below) + AIR
    x, y = (t.u(-0.35, 0.35) * side for side in half)
    if not holds:  # beside it, far, over its edge, hanging above
        x, y, up = [
            (half[0] + wide(above) + t.u(0.01, 0.06), y, 0.0), (half[0] + t.u(0.2, 0.3), y, 0.0),
            (half[0] + t.u(0.0, 0.03), y, up), (x, y, up + t.u(0.03, 0.1)),
        ][way]  # fmt: skip
    c, s = math.cos(turn), math.sin(turn)
    t.put("below", below, 0.0, 0.0, turn)
    t.put("above", above, c * x - s * y, s * x + c * y, t.any_yaw(), up)
    return ("above", "below"), t.bodies


def pack(t: Table, holds: bool, way: int) -> Scene:
    """A body on the floor of an open box that may be moved itself."""
    size = [round(t.u(0.22, 0.45), 3), round(t.u(0.2, 0.35), 3), round(t.u(0.07, 0.14), 3)]
    crate: Shape = {"furniture": "open_box", "size": size, "fixed": False}
    good = t.box(0.04, 0.08, (0.04, 0.11)) if t.u(0, 1) < 0.5 else t.can((0.025, 0.04), (0.05, 0.11))
    half, turn, up = [side / 2 - 0.01 for side in size[:2]], t.any_yaw(), 0.01 + AIR
    room = [max(0.0, side - 1.45 * wide(good)) for side in half]
    x, y = (t.u(-1, 1) * side for side in room)
    if not holds:  # beside it at the floor's height, far, on its rim, hanging above
        x, y, up = [
            (half[0] + 1.5 * wide(good) + t.u(0.02, 0.06), y, up), (half[0] + t.u(0.2, 0.3), y, 0.0),
            (half[0], y, size[2] + AIR), (x, y, size[2] + t.u(0.01, 0.1)),
        ][way]  # fmt: skip
    c, s = math.cos(turn), math.sin(turn)
    t.put("crate", crate, 0.0, 0.0, turn)
    t.put("good", good, c * x - s * y, s * x + c * y, t.any_yaw(), up)
    return ("good", "crate"), t.bodies


RELATIONS: dict[str, Callable[[Table, bool, int], Scene]] = {
    "stack": stack, "pack": pack, "left_of": left_of, "between": between,
}  # fmt: skip


def show(name: str, folder: Path, seed: int = 1) -> None:
    """Write the demonstrations of a relation."""
    rng = random.Random(seed)
    for number in range(2 * EACH):
        holds = number < EACH
        arguments, bodies = RELATIONS[name](Table(rng), holds, number % 4)
        file = folder / f"{name}_{number + 1:03d}.yaml"
        write_demonstration(file, DemonstrationFile(bodies, [Label(name, arguments, holds)]))


if __name__ == "__main__":
    for relation in RELATIONS:
        show(relation, Path(sys.argv[1]) / relation)
