"""Solvable scenes with awkward bodies: does anything claim that they are infeasible?

Each scene is solvable by construction: a body that a hand 80 mm wide can take in a way that the kind names stands free
on a table, and the goal puts it on a free surface, or into a compartment that it fits into as it lies. A proof that
there is no plan is wrong in all of them; a plan that is not found in the time is no lie.

python -m benchmarks.awkward_scenes --count 200 --time 10
python -m benchmarks.awkward_scenes --first 17 --count 1 --keep /tmp/scenes
"""

from __future__ import annotations

import math
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tyro
from numpy.random import Generator as Random

from benchmarks.common import record, table

HEAD = """\
name: {name}
domain: cupboard
robot: {{model: panda_mobile, base: [0.0, 0.0, 0 deg]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}

bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}}
  bench: {{furniture: table, size: [0.8, 0.5, 0.6], at: [-0.2, -1.8, 0.0]}}
  cupboard: {{furniture: cupboard, size: [0.9, 0.42, 0.9], compartments: 2, at: [-1.6, 0.4, 0.0], yaw: 90 deg}}
"""

AT = ((-0.35, 0.0), (0.0, 0.05), (0.35, 0.0), (-0.18, -0.2), (0.18, -0.2))
"""Places on the table, metres: the first is the goal body's, the others may be taken by bodies of any kind."""

WHERE = ("on {} bench", "on {} cupboard_top")
"""Goals that any body fits."""

TURNS = 24
"""Corners of a revolved mesh's rings."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        count: How many scenes.
        first: The first scene's seed.
        time: Budget for each, seconds.
        algorithm: Of the planner.
        keep: A folder for the scenes; a temporary one when not given.
        out: The name of the file under benchmarks/results.
    """

    count: int = 200
    first: int = 0
    time: float = 10.0
    algorithm: str = "adaptive"
    keep: Path | None = None
    out: str = "awkward_scenes.jsonl"


Entry = tuple[str, str]
"""What a body is and how it is turned, as YAML, and the goal with a blank for its name."""


def wide_box(rng: Random, folder: Path) -> Entry:
    """One side just under the hand's opening."""
    size = [rng.uniform(0.070, 0.079), rng.uniform(0.08, 0.16), rng.uniform(0.06, 0.18)]
    return f"box: [{size[0]:.4f}, {size[1]:.3f}, {size[2]:.3f}], yaw: {rng.uniform(0, 180):.0f} deg", _free(rng)


def wide_can(rng: Random, folder: Path) -> Entry:
    """A can nearly as wide as the hand."""
    return f"cylinder: {{radius: {rng.uniform(0.035, 0.0395):.4f}, height: {rng.uniform(0.06, 0.16):.3f}}}", _free(rng)


def lying_can(rng: Random, folder: Path) -> Entry:
    """A can on its side."""
    size = f"{{radius: {rng.uniform(0.02, 0.035):.4f}, height: {rng.uniform(0.1, 0.18):.3f}}}"
    return f"cylinder: {size}, rpy: [90 deg, 0 deg, {rng.uniform(0, 180):.0f} deg]", _free(rng)


def lying_bottle(rng: Random, folder: Path) -> Entry:
    """A bottle on its side, perhaps to be put into a compartment that is too low for it to stand in."""
    r, h = rng.uniform(0.028, 0.036), rng.uniform(0.2, 0.26)
    profile = [(0.9 * r, 0.0), (r, 0.01), (r, 0.6 * h), (0.4 * r, 0.8 * h), (0.4 * r, h)]
    mesh = _revolved(folder, "bottle", profile, rng)
    goal = "inside {} cupboard_1" if rng.random() < 0.3 else _free(rng)
    return f"mesh: {mesh}, rpy: [90 deg, 0 deg, {rng.uniform(0, 180):.0f} deg]", goal


def long_box_lying(rng: Random, folder: Path) -> Entry:
    """Too tall for the compartment upright, lies in it."""
    size = f"[{rng.uniform(0.04, 0.06):.3f}, {rng.uniform(0.27, 0.3):.3f}, {rng.uniform(0.04, 0.07):.3f}]"
    return f"box: {size}, yaw: {rng.uniform(0, 180):.0f} deg", "inside {} cupboard_1" if rng.random() < 0.5 else _free(
        rng
    )


def pear(rng: Random, folder: Path) -> Entry:
    """A pear: no face of it is flat."""
    r = rng.uniform(0.028, 0.036)
    angles = np.linspace(0.05, math.pi - 0.05, 14)
    slim = 1.0 - 0.35 * (angles / math.pi) ** 2
    profile = [(r * math.sin(a) * s, 1.25 * r * (1 - math.cos(a))) for a, s in zip(angles, slim, strict=True)]
    return f"mesh: {_revolved(folder, 'pear', profile, rng)}, rpy: [90 deg, 0 deg, 30 deg]", _free(rng)


def egg(rng: Random, folder: Path) -> Entry:
    """An egg on its side."""
    r = rng.uniform(0.022, 0.03)
    angles = np.linspace(0.05, math.pi - 0.05, 12)
    profile = [(r * math.sin(a), 1.3 * r * (1 - math.cos(a))) for a in angles]
    return f"mesh: {_revolved(folder, 'egg', profile, rng)}, rpy: [90 deg, 0 deg, 0 deg]", _free(rng)


def ball_mesh(rng: Random, folder: Path) -> Entry:
    """A ball as a mesh."""
    r = rng.uniform(0.025, 0.037)
    angles = np.linspace(0.05, math.pi - 0.05, 12)
    profile = [(r * math.sin(a), r * (1 - math.cos(a))) for a in angles]
    return f"mesh: {_revolved(folder, 'ball', profile, rng)}", _free(rng)


def ball(rng: Random, folder: Path) -> Entry:
    """A ball that shall be held: nobody asks for it to be put down."""
    return f"sphere: {rng.uniform(0.025, 0.039):.4f}", "exists (?g - grasp) (holding {} ?g)"


def flat(rng: Random, folder: Path) -> Entry:
    """A flat box, narrow enough to be taken from above."""
    size = f"[{rng.uniform(0.03, 0.07):.3f}, {rng.uniform(0.08, 0.18):.3f}, {rng.uniform(0.018, 0.03):.3f}]"
    return f"box: {size}, yaw: {rng.uniform(0, 180):.0f} deg", _free(rng)


def unsteady(rng: Random, folder: Path) -> Entry:
    """A tall thin box on its smallest side."""
    edge = rng.uniform(0.018, 0.03)
    return f"box: [{edge:.3f}, {rng.uniform(0.03, 0.07):.3f}, {rng.uniform(0.2, 0.28):.3f}]", _free(rng)


def cone(rng: Random, folder: Path) -> Entry:
    """A frustum: every side of it leans."""
    r, h = rng.uniform(0.025, 0.037), rng.uniform(0.06, 0.12)
    return f"mesh: {_revolved(folder, 'cone', [(r, 0.0), (rng.uniform(0.6, 0.9) * r, h)], rng)}", _free(rng)


KINDS: tuple[Callable[[Random, Path], Entry], ...] = (
    wide_box, wide_can, lying_can, lying_bottle, long_box_lying, pear, egg, ball_mesh, ball, flat, unsteady, cone,
)  # fmt: skip


def overhanging(entry: str, rng: Random) -> str:
    """The entry with a place where the body stands out over the table's edge, its centre well on it."""
    return f"{{{entry}, on: table, at: [{AT[0][0]}, {-0.35 + rng.uniform(0.025, 0.03):.3f}]}}"


def scene(seed: int, folder: Path) -> tuple[str, str]:
    """The kind and the text of one scene; meshes are written into the folder."""
    rng = np.random.default_rng((seed, 7))
    kind = KINDS[seed % len(KINDS)]
    entry, goal = kind(rng, folder)
    overhangs = kind in (wide_box, flat, long_box_lying) and rng.random() < 0.3
    text = HEAD.format(name=f"{kind.__name__}_{seed}")
    place = overhanging(entry, rng) if overhangs else f"{{{entry}, on: table, at: [{AT[0][0]}, {AT[0][1]}]}}"
    text += f"  thing: {place}\n"
    for number in range(int(rng.integers(0, 4))):
        other, _ = KINDS[int(rng.integers(len(KINDS)))](rng, folder)
        text += f"  other_{number}: {{{other}, on: table, at: [{AT[number + 1][0]}, {AT[number + 1][1]}]}}\n"
    if rng.random() < 0.2 and kind in (wide_box, wide_can, flat):
        text += "  lid: {box: [0.04, 0.04, 0.05], on: thing}\n"
    return kind.__name__, f"{text}\ngoal: ({goal.format('thing')})\n"


def main(options: Options) -> None:
    """Solve all, print the table, count wrong proofs."""
    from tamp.errors import InputError
    from tamp.planner.problem import load_problem
    from tamp.planner.solve import solve

    outcomes: dict[str, Counter[str]] = defaultdict(Counter)
    wrong: list[str] = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for seed in range(options.first, options.first + options.count):
            kind, text = scene(seed, folder)
            path = folder / f"scene_{seed}.yaml"
            path.write_text(text, encoding="utf-8")
            try:
                problem = load_problem(path)
            except InputError as error:
                outcomes[kind]["refused"] += 1
                print(f"{seed:4} {kind:14} refused: {error}")
                continue
            used = time.process_time()
            solution = solve(problem, max_time=options.time, seed=seed, algorithm=options.algorithm)
            name = solution.outcome.name
            outcomes[kind][name.lower()] += 1
            used = time.process_time() - used
            config = {"kind": kind, "time_s": options.time, "algorithm": options.algorithm}
            record(
                options.out, seed=seed, config=config, outcome=name, planning_cpu_s=used,
                explanation=list(solution.explanation),
            )  # fmt: skip
            if name == "INFEASIBLE":
                wrong.append(f"{seed} ({kind}): {solution.explanation[:1]}")
            if not solution.solved:
                print(
                    f"{seed:4} {kind:14} {name:10} {used:5.1f} s of CPU  {' | '.join(solution.explanation[:2])}"[:240]
                )
    columns = ("solved", "infeasible", "exhausted", "timeout", "refused")
    table([{"kind": kind, **{name: counts[name] for name in columns}} for kind, counts in outcomes.items()])
    for line in wrong:
        print(f"WRONG proof: {line}")
    print(f"wrong proofs: {len(wrong)} of {options.count} scenes")


def _free(rng: Random) -> str:
    return str(rng.choice(WHERE))


def _revolved(folder: Path, name: str, profile: list[tuple[float, float]], rng: Random) -> str:
    """Write the surface that a profile of radii and heights, metres, sweeps about z; the file's path."""
    lines: list[str] = []
    for radius, height in profile:
        for k in range(TURNS):
            angle = 2 * math.pi * k / TURNS
            lines.append(f"v {radius * math.cos(angle):.6f} {radius * math.sin(angle):.6f} {height:.6f}")
    lines += [f"v 0 0 {profile[0][1]:.6f}", f"v 0 0 {profile[-1][1]:.6f}"]
    low, high = len(lines) - 1, len(lines)
    for ring in range(len(profile) - 1):
        for k in range(TURNS):
            a, b = ring * TURNS + k + 1, ring * TURNS + (k + 1) % TURNS + 1
            lines += [f"f {a} {b} {b + TURNS}", f"f {a} {b + TURNS} {a + TURNS}"]
    last = (len(profile) - 1) * TURNS
    for k in range(TURNS):
        a, b = k + 1, (k + 1) % TURNS + 1
        lines += [f"f {low} {b} {a}", f"f {high} {last + a} {last + b}"]
    path = folder / f"{name}_{int(rng.integers(10**9))}.obj"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
