"""Real URDF and mesh files: how many load as bodies, and whether their boxes are those that pybullet's shapes have.

python -m benchmarks.real_files                     # 110 files of pybullet_data
python -m benchmarks.real_files --folder ~/ycb      # and those below a folder of yours
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from benchmarks.common import record, table
from tamp.geometric.scene.pose import Array, Pose

EXACT = 1e-4
"""Metres by which no side of a box may differ."""

ROBOTS = (
    "a1", "aliengo", "bicycle", "biped", "franka_panda", "humanoid", "husky", "laikago", "mini_cheetah", "quadruped",
    "xarm", "racecar", "kuka_iiwa",
)  # fmt: skip
"""Folders of pybullet_data that hold robots and vehicles; they have the mesh files of dozens of links."""

NO_BODY = ("torus_deform.urdf", "plane_implicit.urdf", "samurai.urdf")
"""A soft body, a plane without an end, a monastery of 120 m."""

MESHES = ("duck.obj", "bunny.obj", "torus/torus.obj", "objects/mug.obj", "objects/mug_col.obj", "l_finger.stl")
LINKS = ("xarm/link1.urdf", "xarm/link3.urdf", "xarm/base.urdf")
SUFFIXES = (".urdf", ".obj", ".stl", ".ply", ".dae")


@dataclass(frozen=True)
class Options:
    """What to run.

    Attributes:
        count: Files of pybullet_data: objects, some links and meshes, the rest of its random ones.
        folder: A further folder of URDF and mesh files.
        show: Print a line for each file.
    """

    count: int = 110
    folder: Path | None = None
    show: bool = False


def files(options: Options) -> list[Path]:
    """The files to read, always the same ones."""
    import pybullet_data

    data = Path(pybullet_data.getDataPath())
    chosen = [
        file
        for file in sorted(data.rglob("*.urdf"))
        if file.relative_to(data).parts[0] not in (*ROBOTS, "random_urdfs") and file.name not in NO_BODY
    ]
    chosen += [data / name for name in (*LINKS, *MESHES) if (data / name).is_file()]
    random = sorted((data / "random_urdfs").glob("*/*.urdf"))
    left = max(0, options.count - len(chosen))
    chosen += random[:: max(1, len(random) // max(1, left))][:left]
    if options.folder is not None:
        chosen += sorted(file for file in options.folder.rglob("*") if file.suffix.lower() in SUFFIXES)
    return chosen


def reference_box(bullet: Any, file: Path, scale: float) -> tuple[Array, Array] | None:
    """The corners (3,) of the box around the collision shapes as pybullet has them, without its margins.

    None when pybullet cannot read the file.
    """
    if file.suffix.lower() != ".urdf":
        points = _corners(file) * scale
        return points.min(axis=0), points.max(axis=0)
    try:
        body = bullet.loadURDF(str(file), globalScaling=scale, flags=bullet.URDF_USE_IMPLICIT_CYLINDER)
    except bullet.error:
        return None
    lows, highs = [], []
    for link in range(-1, bullet.getNumJoints(body)):
        for T_world_shape, kind, size, name in _shapes(bullet, body, link):
            low, high = _box(bullet, T_world_shape, kind, size, name)
            lows.append(low)
            highs.append(high)
    bullet.removeBody(body)
    return (np.min(lows, axis=0), np.max(highs, axis=0)) if lows else None


def _shapes(bullet: Any, body: int, link: int) -> Iterator[tuple[Pose, int, tuple[float, ...], bytes]]:
    """Pose in the root's frame, kind, dimensions and file of a link's collision shapes."""
    T_base_com = Pose(*bullet.getDynamicsInfo(body, -1)[3:5])
    T_world_base = Pose(*bullet.getBasePositionAndOrientation(body)) @ T_base_com.inverse()
    if link < 0:
        T_world_com = T_world_base @ T_base_com
    else:
        T_world_com = Pose(*bullet.getLinkState(body, link, computeForwardKinematics=True)[:2])
    for _, _, kind, size, name, position, quaternion in bullet.getCollisionShapeData(body, link):
        yield T_world_base.inverse() @ T_world_com @ Pose(position, quaternion), kind, size, name


def _box(bullet: Any, pose: Pose, kind: int, size: tuple[float, ...], name: bytes) -> tuple[Array, Array]:
    rotation, centre = np.abs(pose.rotation), np.array(pose.position)
    if kind == bullet.GEOM_BOX:
        half = rotation @ np.array(size) / 2
    elif kind == bullet.GEOM_SPHERE:
        half = np.full(3, size[0])
    elif kind in (bullet.GEOM_CYLINDER, bullet.GEOM_CAPSULE):
        length, radius = size[:2]
        axis = rotation[:, 2]
        rim = radius * np.sqrt(np.maximum(0, 1 - axis**2)) if kind == bullet.GEOM_CYLINDER else np.full(3, radius)
        half = axis * length / 2 + rim
    else:
        points = pose.apply(_corners(Path(name.decode())) * np.array(size))
        return points.min(axis=0), points.max(axis=0)
    return centre - half, centre + half


def _corners(file: Path) -> Array:
    """The corners (n, 3) that the faces of an OBJ name, read line by line; of other files what trimesh reads."""
    if file.suffix.lower() != ".obj":
        import trimesh

        mesh: Any = trimesh.load(file, force="mesh")
        return np.array(mesh.vertices)
    lines = [line.split() for line in file.read_text(encoding="latin-1").splitlines()]
    corners = np.array([[float(word) for word in line[1:4]] for line in lines if line[:1] == ["v"]])
    named = {int(word.partition("/")[0]) for line in lines if line[:1] == ["f"] for word in line[1:]}
    return corners[sorted(number - 1 if number > 0 else len(corners) + number for number in named)]


def _scale(file: Path) -> float:
    """1, or what makes a mesh file of many metres half a metre large."""
    if file.suffix.lower() == ".urdf":
        return 1.0
    size = float(np.ptp(_corners(file), axis=0).max())
    return 1.0 if size < 5 else 0.5 / size


def main(options: Options) -> None:
    """Read all, compare, print what differs."""
    import pybullet

    from tamp.errors import InputError
    from tamp.geometric.loading.meshes import load_mesh
    from tamp.geometric.scene.bounds import bounds

    pybullet.connect(pybullet.DIRECT)
    rows: list[dict[str, Any]] = []
    chosen = files(options)
    for file in chosen:
        scale = _scale(file)
        name = "/".join(file.parts[-2:])
        began, cpu = time.perf_counter(), time.process_time()
        try:
            mesh = load_mesh(file, (scale, scale, scale))
            error = ""
        except InputError as caught:
            mesh, error = None, str(caught)
        result: dict[str, Any] = {
            "loads": mesh is not None, "error": error, "parts": len(mesh.parts) if mesh else 0,
            "warnings": len(mesh.warnings) if mesh else 0, "load_s": time.perf_counter() - began,
            "load_cpu_s": time.process_time() - cpu, "off_mm": None,
        }  # fmt: skip
        reference = reference_box(pybullet, file, scale) if mesh else None
        if mesh is not None and reference is not None:
            box = bounds(mesh.parts, Pose())
            result["off_mm"] = 1000 * float(np.abs(np.array(box) - np.array(reference)).max())
        record("real_files.jsonl", config={"file": name, "scale": scale}, **result)
        rows.append({"file": name, **result})
        if options.show or error or (result["off_mm"] or 0.0) > 1000 * EXACT:
            print(f"{name:45} {result['parts']:3} parts  {result['load_s']:5.1f} s  {result['off_mm']} mm  {error}")
    compared = [row["off_mm"] for row in rows if row["off_mm"] is not None]
    table(
        [
            {
                "files": len(rows),
                "load": sum(row["loads"] for row in rows),
                "boxes compared": len(compared),
                "within 0.1 mm": sum(off <= 1000 * EXACT for off in compared),
                "largest, mm": max(compared, default=0.0),
                "slowest, s of CPU": max(row["load_cpu_s"] for row in rows),
            }
        ],
        "Real files",
    )


if __name__ == "__main__":
    main(tyro.cli(Options))
