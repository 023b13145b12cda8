"""Scenes that nobody wrote: random furniture, objects and goals, solved, judged and recorded.

python -m benchmarks.random_scenes --count 30 --time 15
python -m benchmarks.random_scenes --first 7 --count 1 --keep /tmp/scenes      # one of them again, its files kept
"""

from __future__ import annotations

import math
import tempfile
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from benchmarks.common import record, table, times

ROOM = 2.5
"""Half the room's width, metres."""

FREE = 0.75
"""No furniture is nearer to the robot's start than this, metres."""

MESHES = (
    ("mesh: pybullet_data/objects/mug.urdf, scale: 0.85", 0.09),
    ("mesh: pybullet_data/duck_vhacd.obj, scale: 0.03", 0.08),
    ("mesh: pybullet_data/lego/lego.urdf", 0.04),
    ("mesh: objects/mustard_bottle.obj", 0.10),
    ("mesh: objects/bowl.obj", 0.12),
)
"""A mesh's entry, and about the radius of the circle that it takes, metres."""

GROCERIES = (
    (0.06, 0.16, 0.21), (0.045, 0.09, 0.175), (0.058, 0.10, 0.085), (0.073, 0.085, 0.028), (0.04, 0.18, 0.04),
    (0.066, 0.0, 0.102), (0.07, 0.0, 0.033), (0.07, 0.14, 0.24),
)  # fmt: skip
"""YCB-like sizes, metres; a depth of zero says a can of that diameter."""


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        count: How many scenes.
        first: The first scene's seed.
        time: Budget for each, seconds.
        keep: A folder for the scenes and plans; a temporary one when not given.
        hulls: Random meshes of pybullet_data (random_urdfs) among the objects.
        out: The name of the file under benchmarks/results.
    """

    count: int = 30
    first: int = 0
    time: float = 15.0
    keep: Path | None = None
    hulls: bool = True
    out: str = "random_scenes.jsonl"


@dataclass
class Place:
    """Somewhere to put things: its name, its relation, its extents x, y and its free height, metres."""

    name: str
    relation: str
    size: tuple[float, float]
    height: float
    taken: list[tuple[float, float, float]] = field(default_factory=list)

    def spot(self, radius: float, rng: np.random.Generator) -> tuple[float, float] | None:
        """Where a circle still has room."""
        half = [edge / 2 - min(radius, 0.9 * edge / 2) for edge in self.size]
        for _ in range(50):
            x, y = (float(rng.uniform(-limit, limit)) for limit in half)
            if all(math.hypot(x - a, y - b) > radius + r + 0.01 for a, b, r in self.taken):
                self.taken.append((x, y, radius))
                return x, y
        return None


def random_scene(seed: int, hulls: bool = True) -> str:
    """A problem file's text."""
    rng = np.random.default_rng(seed)
    lines: list[str] = []
    places = furniture(lines, rng)
    things = objects(lines, places, rng, hulls)
    goals: list[str] = []
    for name, place, height in things[: int(rng.integers(1, len(things) + 1))] if things else ():
        others = [p for p in places if p is not place and p.height > height + 0.1 and min(p.size) > 0.12]
        if others:
            there = others[int(rng.integers(len(others)))]
            goals.append(f"({there.relation} {name} {there.name})")
    goal = f"(and {' '.join(goals)})"
    return (
        f"# Random scene {seed}.\nname: random_{seed}\ndomain: cupboard\n"
        f"robot: {{model: panda_mobile, base: [0.0, 0.0, {rng.uniform(-3, 3):.2f}]}}\n"
        f"room: {{x: [-{ROOM}, {ROOM}], y: [-{ROOM}, {ROOM}]}}\nbodies:\n" + "\n".join(lines) + f"\ngoal: {goal}\n"
    )


def furniture(lines: list[str], rng: np.random.Generator) -> list[Place]:
    """Two to four pieces around the robot, their fronts towards it; the first is a table."""
    places: list[Place] = []
    taken: list[tuple[float, float, float]] = []
    for number in range(int(rng.integers(2, 5))):
        kind = "table" if number == 0 else ("table", "cupboard", "shelf")[int(rng.integers(3))]
        name = f"{kind}{number}"
        width, depth = rng.uniform(0.5, 1.4), rng.uniform(0.35, 0.8)
        options, plinth, rows, columns = "", 0.0, 1, 1
        if kind == "table":
            height = rng.uniform(0.3, 1.0)
            options = ", legs: false" if rng.random() < 0.3 else ""
        else:
            depth = rng.uniform(0.3, 0.45)
            rows, columns = int(rng.integers(1, 4)), int(rng.integers(1, 3))
            height, plinth = rng.uniform(0.7, 1.3), rng.choice([0.0, rng.uniform(0.1, 0.4)])
            options = f", compartments: [{rows}, {columns}], plinth: {plinth:.2f}"
        radius = math.hypot(width, depth) / 2
        for _ in range(100):
            angle, distance = rng.uniform(-math.pi, math.pi), FREE + depth / 2 + rng.uniform(0.0, 1.1)
            x, y = distance * math.cos(angle), distance * math.sin(angle)
            if all(math.hypot(x - a, y - b) > radius + r + 0.1 for a, b, r in taken):
                break
        else:
            continue
        taken.append((x, y, radius))
        yaw = math.degrees(angle) - 90 + rng.normal(0.0, 15.0)
        lines.append(
            f"  {name}: {{furniture: {kind}, size: [{width:.2f}, {depth:.2f}, {height:.2f}], "
            f"at: [{x:.2f}, {y:.2f}, 0.0], yaw: {yaw:.0f} deg{options}}}"
        )
        if kind == "table":
            places.append(Place(name, "on", (width, depth), math.inf))
            continue
        inner = (width - (columns + 1) * 0.02) / columns, depth - 0.02, (height - plinth - (rows + 1) * 0.02) / rows
        places.append(Place(f"{name}_top", "on", (width, depth), math.inf))
        relation = "inside" if kind == "cupboard" else "on"
        places += [Place(f"{name}_{k + 1}", relation, inner[:2], inner[2]) for k in range(rows * columns)]
    if rng.random() < 0.4:
        size = rng.uniform(0.25, 0.45), rng.uniform(0.2, 0.35), rng.uniform(0.06, 0.16)
        spot = places[0].spot(math.hypot(*size[:2]) / 2, rng)
        if spot is not None:
            lines.append(
                f"  tray: {{furniture: open_box, size: [{size[0]:.2f}, {size[1]:.2f}, {size[2]:.2f}], "
                f"on: {places[0].name}, at: [{spot[0]:.2f}, {spot[1]:.2f}]}}"
            )
            places.append(Place("tray", "inside", (size[0] - 0.02, size[1] - 0.02), math.inf))
    return places


def objects(
    lines: list[str], places: list[Place], rng: np.random.Generator, hulls: bool
) -> list[tuple[str, Place, float]]:
    """One to six things on tables and tops: name, where it stands, its height."""
    tops = [place for place in places if place.relation == "on" and place.height == math.inf]
    found: list[tuple[str, Place, float]] = []
    for number in range(int(rng.integers(1, 7))):
        place = tops[int(rng.integers(len(tops)))]
        turned = f"yaw: {rng.uniform(-180, 180):.0f} deg"
        draw = rng.random()
        if draw < 0.45:
            x, y, height = GROCERIES[int(rng.integers(len(GROCERIES)))]
            shape = f"box: [{x}, {y}, {height}]" if y else f"cylinder: {{radius: {x / 2:.4f}, height: {height}}}"
            radius = math.hypot(x, y or x) / 2
        elif draw < 0.6:
            x, y, height = rng.uniform(0.03, 0.075), rng.uniform(0.03, 0.15), rng.uniform(0.03, 0.2)
            shape, radius = f"box: [{x:.3f}, {y:.3f}, {height:.3f}]", math.hypot(x, y) / 2
        elif draw < 0.85 or not hulls:
            entry, radius = MESHES[int(rng.integers(len(MESHES)))]
            shape, height = entry, 0.12
        else:
            shape, radius, height, turned = _random_urdf(rng)
            if not shape:
                continue
        spot = place.spot(radius, rng)
        if spot is None:
            continue
        lines.append(
            f"  thing{number}: {{{shape}, on: {place.name}, at: [{spot[0]:.3f}, {spot[1]:.3f}], {turned}, "
            f"mass: {rng.uniform(0.1, 0.6):.2f}}}"
        )
        found.append((f"thing{number}", place, height))
    return found


def _random_urdf(rng: np.random.Generator) -> tuple[str, float, float, str]:
    """One of pybullet_data's thousand blobs, on its steadiest face: entry, radius, height, and how it is turned."""
    from scipy.spatial.transform import Rotation

    from tamp.geometric.loading.load import load_scene
    from tamp.geometric.stability.stable_poses import stable_faces_of

    number = int(rng.integers(1000))
    scale = float(rng.uniform(0.5, 0.9))
    entry = f"mesh: pybullet_data/random_urdfs/{number:03d}/{number:03d}.urdf, scale: {scale:.2f}"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "one.yaml"
        path.write_text(
            "robot: {model: panda_mobile, base: [0, 0, 0]}\nroom: {x: [-1, 1], y: [-1, 1]}\n"
            f"bodies:\n  blob: {{{entry}, at: [1.0, 1.0, 0.5], fixed: false}}\ngoal: (hand-empty)\n"
        )
        faces = stable_faces_of(load_scene(path).scene.bodies["blob"]).faces
    if not faces:
        return "", 0.0, 0.0, ""
    face = max(faces, key=lambda face: face.angle)
    turn = Rotation.from_rotvec([0.0, 0.0, rng.uniform(-3, 3)]).as_matrix() @ face.rotation
    quaternion = Rotation.from_matrix(turn).as_quat()
    radius = float(np.linalg.norm(face.outline, axis=1).max())
    return entry, radius, face.extent, f"quaternion: [{', '.join(f'{x:.9f}' for x in quaternion)}]"


def run(path: Path, seed: int, budget: float) -> dict[str, Any]:
    """Plan one file and judge the plan. An exception is a result, too: a bug."""
    import tamp
    from tamp.verification.verify import verify

    result: dict[str, Any] = {"violations": [], "explanation": [], "planning_s": 0.0, "actions": 0, "objects": 0}
    try:
        problem = tamp.load_problem(path)
        result |= {"objects": len(problem.scene.movable), "goal": problem.goal, "warnings": list(problem.warnings)}
        began = time.perf_counter()
        solution = tamp.solve(problem, max_time=budget, seed=seed)
        result |= {
            "outcome": solution.outcome.name,
            "planning_s": time.perf_counter() - began,
            "actions": len(solution.plan),
            "explanation": list(solution.explanation),
            "warnings": list(solution.warnings),
            "seconds": {name: round(seconds, 3) for name, seconds in solution.seconds.items()},
            "rejections": {
                name: dict(s.reasons.most_common(4)) for name, s in solution.statistics.items() if s.reasons
            },
        }
        if solution.solved:
            plan = tamp.write_plan(solution, path.with_suffix(".plan.json"))
            result["violations"] = [str(violation) for violation in verify(plan).violations]
            result["outcome"] = "REJECTED" if result["violations"] else "VERIFIED"
    except tamp.InputError as error:
        result |= {"outcome": "REFUSED", "explanation": [str(error)]}
    except Exception:
        result |= {"outcome": "CRASH", "explanation": traceback.format_exc().splitlines()[-12:]}
    return result


def runs(options: Options, folder: Path) -> Iterator[tuple[int, dict[str, Any]]]:
    """All scenes' results in order."""
    for seed in range(options.first, options.first + options.count):
        path = folder / f"random_{seed}.yaml"
        path.write_text(random_scene(seed, options.hulls), encoding="utf-8")
        yield seed, run(path, seed, options.time)


def main(options: Options) -> None:
    results: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for seed, result in runs(options, folder):
            record(options.out, seed=seed, config={"time_s": options.time, "hulls": options.hulls}, **result)
            results.append(result)
            print(
                f"random_{seed:<4} {result['objects']} objects  {result['outcome']:10} {result['planning_s']:6.2f} s"
                f"  {result['actions']:3} actions  {result.get('goal', '')}",
                flush=True,
            )
            for line in (*result["violations"][:5], *result["explanation"], *result.get("warnings", ())):
                print(f"    {line}")
    solved = [result["planning_s"] for result in results if result["outcome"] in ("VERIFIED", "REJECTED")]
    counts = Counter(result["outcome"] for result in results)
    table([{**{name.lower(): str(n) for name, n in sorted(counts.items())}, **times(solved)}], "random scenes")


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
