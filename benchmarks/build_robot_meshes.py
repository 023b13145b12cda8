"""Write tamp/geometric/robot/assets/franka_panda/: the Panda's description and meshes as a package's data.

    python benchmarks/build_robot_meshes.py [FOLDER]

FOLDER is pybullet_data's franka_panda/. The description, its licence and the collision meshes come byte for byte: the
engines load them. Of the meshes to draw come triangles and colours: details under 2 mm, textures and
normals are left out, which makes 9.1 MB to 3.
"""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

from tamp.view.mesh import Mesh, read_mesh

ASSETS = Path(__file__).parents[1] / "tamp" / "geometric" / "robot" / "assets" / "franka_panda"
CELL = 0.002
"""Metres: smaller details are left out. Pages draw none under 6 mm."""
NOTICE = """\
The description and meshes of Franka Emika's Panda, from franka_ros by way of pybullet_data (bullet3), under the Apache
License 2.0: LICENSE.txt. Changed: of the meshes in meshes/visual, benchmarks/build_robot_meshes.py kept triangles and
colours and left out textures, normals and details under 2 mm.
"""


def written(meshes: list[Mesh], name: str) -> tuple[str, str]:
    """The texts of an OBJ file and of its MTL file."""
    lines, materials, first = [f"mtllib {name}.mtl"], [], 1
    for number, mesh in enumerate(meshes):
        red, green, blue, _ = mesh.colour
        materials += [f"newmtl m{number}", f"Kd {red:.4f} {green:.4f} {blue:.4f}"]
        lines += [f"v {x:.5f} {y:.5f} {z:.5f}" for x, y, z in mesh.vertices]
        lines += [f"usemtl m{number}", *(f"f {a + first} {b + first} {c + first}" for a, b, c in mesh.faces)]
        first += len(mesh.vertices)
    return "\n".join([*lines, ""]), "\n".join([*materials, ""])


def main() -> None:
    """Copy and thin out."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, nargs="?", metavar="FOLDER")
    source = parser.parse_args().folder
    if source is None:
        import pybullet_data

        source = Path(pybullet_data.getDataPath()) / "franka_panda"

    (ASSETS / "meshes" / "visual").mkdir(parents=True, exist_ok=True)
    shutil.copytree(source / "meshes" / "collision", ASSETS / "meshes" / "collision", dirs_exist_ok=True)
    for name in ("panda.urdf", "LICENSE.txt"):
        shutil.copyfile(source / name, ASSETS / name)
    (ASSETS / "NOTICE.txt").write_text(NOTICE, encoding="utf-8")

    for file in sorted((source / "meshes" / "visual").glob("*.obj")):
        mesh, material = written(read_mesh(file, (1.0, 1.0, 1.0), None, CELL), file.stem)
        (ASSETS / "meshes" / "visual" / file.name).write_text(mesh, encoding="utf-8")
        (ASSETS / "meshes" / "visual" / f"{file.stem}.mtl").write_text(material, encoding="utf-8")


if __name__ == "__main__":
    main()
