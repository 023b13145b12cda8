"""The judge's tolerances in words: for `tamp-verify --help` and docs/how-it-works.md."""

from __future__ import annotations

import math

from tamp.verification import certified_facts as certified
from tamp.verification import collision_sweep as sweep
from tamp.verification import limits, loads, replay
from tamp.verification import support_geometry as supports
from tamp.verification import trajectory_sampling as sampling


def tolerances() -> tuple[tuple[str, str], ...]:
    """List what is compared, and by how much it may be off."""
    speed, harsh = (f"{100 * (share - 1):.0f} %" for share in (limits.SPEED, limits.HARSH))
    same = f"{_mm(certified.CLOSE)}, {math.degrees(certified.ALIKE):g} deg"
    air = f"0 to {_mm(supports.GAP)} (it may sink in {_mm(supports.SINK)})"
    return (
        ("penetration of robot, held body, bodies, floor", _mm(sweep.TOLERANCE)),
        (
            "between two states that are looked at",
            f"{_mm(sampling.STEP)}, {math.degrees(sampling.TURN):g} deg a joint",
        ),
        ("air between a resting body and what carries it", air),
        ("gaps of points that carry a body differ by", _mm(supports.EVEN)),
        (
            "centre of mass beyond what carries the body, also with all that stands on it",
            _mm(supports.LEAN),
        ),
        (
            "lean of a body that is carried with others on it",
            f"{math.degrees(loads.LEAN):g} deg",
        ),
        ("body beyond the walls of a cavity", _mm(supports.SINK)),
        ("pose of a body or the tool against the plan's", same),
        (
            "fingers: in what they hold, and off it",
            f"{_mm(certified.PRESSED)}, {_mm(certified.LOOSE)}",
        ),
        ("a joint or the base beyond its range", f"{limits.SLACK:g} rad, m"),
        ("velocity and acceleration over the limit", f"{speed}, {harsh}"),
        ("jumps between segments, and of the clock", f"{replay.JUMP:g} rad, m; {replay.CLOCK:g} s"),
    )  # fmt: skip


def _mm(metres: float) -> str:
    return f"{1000 * metres:g} mm"
