"""The judge's tolerances in words: for `tamp-verify --help` and docs/how-it-works.md."""

from __future__ import annotations

import math

from tamp.verification import certified_facts as certified
from tamp.verification import collision_sweep as sweep
from tamp.verification import holding, limits, loads, replay
from tamp.verification import support_geometry as supports
from tamp.verification import trajectory_sampling as sampling


def tolerances() -> tuple[tuple[str, str], ...]:
    """List what is compared, and by how much it may be off."""
    speed, harsh = (
        f"{100 * (share - 1):.0f} %"
        for share in (limits.VELOCITY_LIMIT_SHARE, limits.ACCELERATION_LIMIT_SHARE)
    )
    same = (
        f"{_mm(certified.POSE_DIFFERENCE_M)}, {math.degrees(certified.POSE_DIFFERENCE_RAD):g} deg"
    )
    air = (
        f"0 to {_mm(supports.SUPPORT_GAP_M)} (it may sink in {_mm(supports.SUPPORT_PENETRATION_M)})"
    )

    return (
        ("penetration of robot, held body, bodies, floor", _mm(sweep.MAX_PENETRATION_M)),
        (
            "between two states that are looked at",
            f"{_mm(sampling.POINT_STEP_M)}, {math.degrees(sampling.JOINT_STEP_RAD):g} deg a joint",
        ),
        ("air between a resting body and what carries it", air),
        ("gaps of points that carry a body differ by", _mm(supports.SUPPORT_GAP_SPREAD_M)),
        (
            "centre of mass beyond what carries the body, also with all that stands on it",
            _mm(supports.CENTRE_TOLERANCE_M),
        ),
        (
            "lean of a body that is carried with others on it",
            f"{math.degrees(loads.LOADED_TILT_RAD):g} deg",
        ),
        ("body beyond the walls of a cavity", _mm(supports.SUPPORT_PENETRATION_M)),
        ("pose of a body or the tool against the plan's", same),
        (
            "fingers: in what they hold, and off it",
            f"{_mm(holding.FINGER_PENETRATION_M)}, {_mm(holding.FINGER_GAP_M)}",
        ),
        (
            "suction cup: in what it holds, off it anywhere, and aslant beyond its own limit",
            f"{_mm(holding.FINGER_PENETRATION_M)}, {_mm(holding.CUP_GAP_M)}, "
            f"{math.degrees(holding.TILT_TOLERANCE_RAD):g} deg",
        ),
        ("a joint or the base beyond its range", f"{limits.RANGE_TOLERANCE:g} rad, m"),
        ("velocity and acceleration over the limit", f"{speed}, {harsh}"),
        (
            "jumps between segments, and of the clock",
            f"{replay.SEGMENT_JUMP:g} rad, m; {replay.TIME_TOLERANCE_S:g} s",
        ),
    )  # fmt: skip


def _mm(metres: float) -> str:
    return f"{1000 * metres:g} mm"
