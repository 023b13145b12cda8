"""Scenes of the scaling series: many groceries go from tables to the boards of shelves."""

from __future__ import annotations

SHAPES = (
    "box: [0.06, 0.16, 0.21]", "cylinder: {radius: 0.033, height: 0.102}", "cylinder: {radius: 0.03, height: 0.19}",
    "cylinder: {radius: 0.035, height: 0.14}", "box: [0.045, 0.09, 0.175]", "box: [0.058, 0.1, 0.085]",
    "box: [0.028, 0.085, 0.073]", "cylinder: {radius: 0.033, height: 0.2}", "cylinder: {radius: 0.034, height: 0.085}",
    "box: [0.035, 0.11, 0.089]", "box: [0.065, 0.065, 0.12]", "cylinder: {radius: 0.025, height: 0.11}",
    "box: [0.05, 0.08, 0.18]", "cylinder: {radius: 0.035, height: 0.11}", "box: [0.05, 0.065, 0.17]",
    "cylinder: {radius: 0.036, height: 0.09}", "box: [0.04, 0.1, 0.2]", "cylinder: {radius: 0.033, height: 0.11}",
    "cylinder: {radius: 0.037, height: 0.16}", "box: [0.055, 0.055, 0.135]",
)  # fmt: skip
"""Metres."""

COLOURS = ("red", "blue", "green", "yellow", "orange")

TABLE = "{{furniture: table, size: [1.3, 0.75, 0.72], at: [{x}, {y}, 0.0], yaw: {yaw} deg}}"
SHELF = (
    "{{furniture: shelf, size: [1.3, 0.42, 1.18], compartments: [2, 2], plinth: 0.4, at: [{x}, {y}, 0.0], "
    "yaw: {yaw} deg}}"
)

EIGHT = (
    2.5,
    {"table_left": (1.6, 1.1, 90), "table_right": (1.6, -1.1, 90)},
    {"shelf": (-1.6, 1.0, 90), "rack": (-1.6, -1.0, 90)},
)
SIXTEEN = (
    3.0,
    {"table_left": (2.1, 1.5, 90), "table_right": (2.1, -1.5, 90), "table_front": (0.0, -2.1, 0)},
    {"shelf": (-2.2, 1.9, 90), "rack": (-2.2, 0.0, 90), "case": (-2.2, -1.9, 90), "chest": (0.0, 2.3, 0)},
)
"""Half the room, tables and shelves of four boards: x and y in metres, yaw in degrees."""


def scene(objects: int, boards: int) -> str:
    """Write the problem file of so many objects in two rows on each table, for 8 or 16 boards."""
    room, tables, shelves = EIGHT if boards == 8 else SIXTEEN
    lines = [
        f"name: scale_{objects}", "domain: cupboard", "robot: {model: panda_mobile, base: [0.0, 0.0, 0 deg]}",
        f"room: {{x: [-{room}, {room}], y: [-{room}, {room}]}}", "bodies:",
    ]  # fmt: skip
    for kind, bodies in ((TABLE, tables), (SHELF, shelves)):
        lines += [f"  {name}: {kind.format(x=x, y=y, yaw=yaw)}" for name, (x, y, yaw) in bodies.items()]

    columns = max(2, -(-objects // (2 * len(tables))))
    places = [f"{name}_{level}" for level in range(1, 5) for name in shelves]
    goals: list[str] = []
    for i in range(objects):
        table = list(tables)[i // 2 % len(tables)]
        x = -0.58 + 1.161 * (i // (2 * len(tables))) / (columns - 1)
        lines.append(
            f"  o{i:02}: {{{SHAPES[i % len(SHAPES)]}, on: {table}, at: [{x:.3f}, {-0.2 if i % 2 else 0.2}], "
            f"yaw: {37 * i % 90} deg, colour: {COLOURS[i % len(COLOURS)]}}}"
        )
        goals.append(f"(on o{i:02} {places[i % len(places)]})")
    return "\n".join([*lines, f"goal: (and {' '.join(goals)})", ""])
