"""Make the meshes of bottle and bowl that come with tamp: `python problems/assets/make_assets.py`. They are ours, and CC0.

It also computes the convex pieces of every mesh that a shipped problem uses: nobody shall wait for them at first use.
Both, the bottle and the bowl, are solids of revolution (the bottle squeezed into an oval), standing on z = 0 around the z axis, in metres.
"""

from __future__ import annotations

import math
from pathlib import Path

from tamp.geometric.loading.mesh_pieces import compute_pieces, packed, pieces_name
from tamp.geometric.loading.meshes import find_mesh
from tamp.system.files import write_whole

OBJECTS = Path(__file__).resolve().parent / "objects"
SHIPPED = [
    ("objects/mustard_bottle.obj", (1.0, 1.0, 1.0)),
    ("objects/bowl.obj", (1.0, 1.0, 1.0)),
    ("objects/mug_col.obj", (0.85, 0.85, 0.85)),
]
Profile = list[tuple[float, float]]

# Radius and height from the bottom's centre to the top's, in metres.
# A mustard bottle of YCB's size: 9.5 x 5.8 x 19 cm, with shoulders and a cap.
BOTTLE: Profile = [
    (0, 0), (0.046, 0), (0.0475, 0.004), (0.0475, 0.105), (0.044, 0.125), (0.034, 0.145), (0.021, 0.155),
    (0.019, 0.172), (0.010, 0.174), (0.006, 0.190), (0, 0.190),
]  # fmt: skip
# A bowl of YCB's size: 16 cm wide, 5.5 cm high, its wall 4 mm thick; down the outside, then up the inside.
BOWL: Profile = [
    (0, 0), (0.032, 0), (0.036, 0.004), (0.056, 0.016), (0.071, 0.034), (0.080, 0.055), (0.076, 0.055),
    (0.067, 0.036), (0.053, 0.020), (0.032, 0.007), (0, 0.005),
]  # fmt: skip


def revolve(profile: Profile, count: int, squeeze: float = 1.0) -> str:
    """The OBJ text of a closed surface: the profile turned about z in `count` steps, y scaled by `squeeze`."""
    rings = profile[1:-1]
    lines = [f"v 0 0 {profile[0][1]:g}", f"v 0 0 {profile[-1][1]:g}"]
    for radius, height in rings:
        for step in range(count):
            angle = 2 * math.pi * step / count
            lines.append(
                f"v {radius * math.cos(angle):.6f} {radius * squeeze * math.sin(angle):.6f} {height:g}"
            )
    for step in range(count):
        after = (step + 1) % count
        lines.append(f"f 1 {3 + after} {3 + step}")
        for ring in range(len(rings) - 1):
            low, high = 3 + ring * count, 3 + (ring + 1) * count
            lines += [
                f"f {low + step} {low + after} {high + after}",
                f"f {low + step} {high + after} {high + step}",
            ]
        last = 3 + (len(rings) - 1) * count
        lines.append(f"f 2 {last + step} {last + after}")
    return "\n".join(["# Made by problems/assets/make_assets.py; CC0", *lines, ""])


def main() -> None:
    """Write the files."""
    OBJECTS.mkdir(exist_ok=True)
    (OBJECTS / "mustard_bottle.obj").write_text(revolve(BOTTLE, 24, squeeze=0.058 / 0.095))
    (OBJECTS / "bowl.obj").write_text(revolve(BOWL, 24))
    for file, scale in SHIPPED:
        path = find_mesh(file, OBJECTS.parent)
        write_whole(
            OBJECTS.parent / "pieces" / pieces_name(path, scale),
            packed(*compute_pieces(path, scale)),
        )


if __name__ == "__main__":
    main()
