"""What cannot become a robot: one clear error each, and nothing written."""

from __future__ import annotations

import io
import re
import shutil
import zipfile
from pathlib import Path

import numpy as np
import pytest

import tamp
from tamp.commands.robot import main
from tamp.errors import InputError
from tamp.geometric.loading.robots import ROBOTS
from tests.commands.robot_folder.urdf import SIX, arm_text

BRANCH = """
<link name="second"/><link name="third"/>
<joint name="b1" type="revolute"><parent link="foot"/><child link="second"/><limit lower="-1" upper="1"/></joint>
<joint name="b2" type="revolute"><parent link="second"/><child link="third"/><limit lower="-1" upper="1"/></joint>
"""
FINGERS = """
<link name="left"><collision><geometry><box size="0.02 0.02 0.05"/></geometry></collision></link>
<link name="right"><collision><geometry><box size="0.02 0.02 0.05"/></geometry></collision></link>
<joint name="l" type="prismatic"><parent link="tool"/><child link="left"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.04"/></joint>
<joint name="r" type="{kind}"><parent link="tool"/><child link="right"/><axis xyz="{axis}"/>
<limit lower="0" upper="0.04"/></joint>
"""
ARM = ("--arm", "foot", "tool")


def changed(number: int, kind: str | None = None, limits: str | None = None):
    joint = SIX[number]
    new = (joint[0], kind or joint[1], *joint[2:4], joint[4] if limits is None else limits)
    return (*SIX[:number], new, *SIX[number + 1 :])


CASES = {
    "no-file": (None, ARM, r"no such file"),
    "no-xml": ("this is no XML", ARM, r"arm.urdf.*syntax error"),
    "no-robot": ("<model/>", ARM, r"neither a URDF nor an MJCF"),
    "unknown-link": (arm_text(), ("--arm", "foot", "tol"), r"unknown link 'tol'.*Did you mean 'tool'"),
    "other-branch": (arm_text(extra=BRANCH), ("--arm", "second", "tool"), r"'tool' does not hang on 'second'"),
    "branches": (arm_text(extra=BRANCH), (), r"branches: 2 chains.*--arm foot tool"),
    "no-limits": (arm_text(changed(1, limits="")), ARM, r"joint 'lift' has no limits.*<limit"),
    "swapped": (arm_text(changed(1, limits="3 -3")), ARM, r"'lift': its limits 3 and -3 are swapped"),
    "floating": (arm_text(changed(1, kind="floating")), ARM, r"floating joints"),
    "unknown-kind": (arm_text(changed(1, kind="rotary")), ARM, r"unknown type 'rotary'"),
    "no-shapes": (
        arm_text().replace("<collision>", "<visual>").replace("</collision>", "</visual>"), ARM,
        r"no collision shapes.*<collision>",
    ),
    "lost-mesh": (
        arm_text().replace('<box size="0.12 0.12 0.1"/>', '<mesh filename="lost.stl"/>'), ARM, r"'lost.stl', which",
    ),
    "broken-mesh": (
        arm_text().replace('<box size="0.12 0.12 0.1"/>', '<mesh filename="broken.stl"/>'), ARM, r"broken.stl",
    ),
    "too-high": (arm_text(), (*ARM, "--base", "fixed", "--height", "9"), r"reaches nothing.*nor any table"),
    "wide": (arm_text(), (*ARM, "--opening", "3"), r"opens from 0.01 to 0.2 m"),
    "cup-small": (arm_text(), (*ARM, "--suction", "0.001"), r"rim of a cup has a radius of 0.003 to 0.15 m"),
    "cup-strong": (arm_text(), (*ARM, "--suction", "0.02", "--force", "500"), r"pulls with 127 N at most"),
    "cup-opens": (arm_text(), (*ARM, "--suction", "0.02", "--opening", "0.1"), r"--opening is of fingers"),
    "cup-fingers": (arm_text(), (*ARM, "--suction", "0.02", "--gripper", "l", "r"), r"--gripper is of fingers"),
    "fingers-unknown": (arm_text(), (*ARM, "--gripper", "l", "r"), r"unknown joint 'l'"),
    "fingers-turn": (
        arm_text(extra=FINGERS.format(kind="revolute", axis="0 1 0")), (*ARM, "--gripper", "l", "r"), r"'r' turns",
    ),
    "fingers-part": (
        arm_text(extra=FINGERS.format(kind="prismatic", axis="0 1 0")), (*ARM, "--gripper", "l", "r"),
        r"do not move towards each other: the gripper cannot close",
    ),
    "fingers-overlap": (
        arm_text(extra=FINGERS.format(kind="prismatic", axis="0 -1 0")), (*ARM, "--gripper", "l", "r"),
        r"in each other at the end of their way: the gripper cannot close",
    ),
    "home-count": (arm_text(), (*ARM, "--home", "0", "0"), r"--home: 6 numbers are expected"),
    "home-limits": (arm_text(), (*ARM, "--home", "9", "0", "0", "0", "0", "0"), r"--home: pan = 9 is not within"),
    "stands": (arm_text(), (*ARM, "--stands", "x"), r"--stands x: JOINT=VALUE"),
    "stands-unknown": (arm_text(), (*ARM, "--stands", "x=1"), r"unknown joint 'x'"),
    "drive": (arm_text(), (*ARM, "--base", "flying"), r"unknown drive 'flying'.*omnidirectional"),
    "car-radius": (arm_text(), (*ARM, "--base", "car"), r"--base car needs --turning-radius"),
    "no-car": (arm_text(), (*ARM, "--turning-radius", "1"), r"--turning-radius is of --base car alone"),
    "radius-range": (
        arm_text(), (*ARM, "--base", "car", "--turning-radius", "50"), r"--turning-radius 50.*from 0.05 to 20",
    ),
    "in-the-floor": (
        arm_text(), (*ARM, "--mount", "0", "0", "-0.2", "0"),
        r"--mount: foot reaches 0.2\d* m into the floor.*Mount it",
    ),
    "two-roots": (arm_text(extra='<link name="alone"/>'), ARM, r"several roots: foot, alone"),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_a_bad_urdf_is_one_clear_error(
    name: str, quick: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text, options, says = CASES[name]
    file, out = tmp_path / "arm.urdf", tmp_path / "made" / "arm"
    (tmp_path / "broken.stl").write_bytes(b"solid nothing\nfacet normal\n")
    if text is not None:
        file.write_text(text, encoding="utf-8")
    assert main(["make", str(file), "--out", str(out), "--quiet", *options]) == 2
    error = capsys.readouterr().err
    assert error.startswith("error: ") and error.count("\n") == 1 and "Traceback" not in error
    assert re.search(says, error), error
    assert not (tmp_path / "made").exists() or not list((tmp_path / "made").iterdir())


def yaml(old: str, new: str):
    def change(folder: Path) -> None:
        file = folder / "robot.yaml"
        text = file.read_text()
        assert old in text
        file.write_text(text.replace(old, new, 1))

    return change


def arrays(part: str, name: str, change):
    """Change the first array of a name in one of the folder's files."""

    def spoil(folder: Path) -> None:
        file = folder / f"{part}.npz"
        with np.load(file) as kept:
            found = {key: kept[key] for key in kept.files}
        key = next(key for key in found if key.rpartition("/")[2] == name)
        np.savez(file, **{**found, key: change(found[key])})

    return spoil


def bomb(folder: Path) -> None:
    """Write an array that says to be larger than any memory."""
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(
        header, {"descr": "<f8", "fortran_order": False, "shape": (10**13,)}
    )
    with zipfile.ZipFile(folder / "reachability.npz", "a") as packed:
        packed.writestr("more.npy", header.getvalue() + b"0" * 80)


DAMAGED = {
    "version": (yaml("version: 1", "version: 7"), r"robot.yaml:3: version: version 7 .*only 1.*Make it again"),
    "format": (yaml("format: tamp-robot", "format: other"), r"not a robot"),
    "drive": (yaml("drive: differential", "drive: hover"), r"unknown drive 'hover'"),
    "car": (yaml("drive: differential", "drive: car"), r"robot.yaml:\d+: .*a car needs a turning_radius"),
    "no-car": (
        yaml("drive: differential", "drive: differential\n  turning_radius: 1.0"),
        r"robot.yaml:\d+: .*a turning_radius is a car's, not of a differential base",
    ),
    "car-radius": (
        yaml("drive: differential", "drive: car\n  turning_radius: 99.0"),
        r"turning_radius: must be at most 20, found 99",
    ),
    "in-the-floor": (
        yaml("mount: {xyz: [", "mount: {xyz: [0.0, 0.0, -0.3], quaternion: [0.0, 0.0, 0.0, 1.0]} #"),
        r"arm.mount: foot reaches 0.3\d* m into the floor. Mount it higher",
    ),
    "home": (yaml("home: [", "home: [99, "), r"home: expected 6 numbers, found 7"),
    "key": (yaml("  foot:", "  feet:"), r"unknown key 'feet'. Choices: foot, mount"),
    "pair": (yaml("allowed:\n  - base", "allowed:\n  - bass"), r"unknown link 'bass'"),
    "no-geometry": (lambda folder: (folder / "geometry.npz").unlink(), r"geometry.npz is missing"),
    "cut-geometry": (
        lambda folder: (folder / "geometry.npz").write_bytes((folder / "geometry.npz").read_bytes()[:5000]),
        r"geometry.npz: damaged.*Make the robot again",
    ),
    **{
        f"{part}-{what}": (arrays(part, name, change), rf"{part}.npz: damaged: .*{says}.*Make the robot again")
        for part, name, what, change, says in (
            ("geometry", "spheres", "flat", lambda a: a[:, :3], "4 numbers"),
            ("geometry", "spheres", "nan", lambda a: a * np.nan, "4 numbers"),
            ("geometry", "spheres", "inside-out", lambda a: -a, "are no spheres"),
            ("geometry", "slack", "many", lambda a: np.zeros(3), "one numbers"),
            ("geometry", "slack", "complex", lambda a: a + 1j, "slack' holds complex numbers"),
            ("geometry", "faces", "beyond", lambda a: a + 10**6, "vertices that are not there"),
            ("geometry", "vertices", "words", lambda a: a.astype(str), "vertices' holds text"),
            ("reachability", "heights", "falling", lambda a: a[::-1], "do not fit together"),
            ("reachability", "counts", "huge", lambda a: a + 1e300, "n x n x n x n numbers"),
            ("reachability", "rotations", "short", lambda a: a[:-1], "do not fit together"),
        )
    },
    "no-yaml": (lambda folder: (folder / "robot.yaml").unlink(), r"has no robot.yaml"),
    "bomb": (bomb, r"reachability.npz: damaged"),
    "long-name": (yaml("urdf: robot.urdf", f"urdf: {'x' * 5000}"), r"needs xxx"),
    "no-table": (lambda folder: (folder / "reachability.npz").unlink(), r"reachability table is missing"),
    "cut-table": (
        lambda folder: (folder / "reachability.npz").write_bytes(b"PK"), r"reachability.npz: damaged",
    ),
    "wrong-table": (
        lambda folder: np.savez(folder / "reachability.npz", heights=np.zeros(3)), r"reachability.npz: damaged",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGED)
def test_a_damaged_folder_is_one_clear_error_before_planning(
    name: str, driving: Path, tmp_path: Path
) -> None:
    change, says = DAMAGED[name]
    folder = tmp_path / "boxes"
    shutil.copytree(driving, folder)
    change(folder)
    with pytest.raises(InputError, match=says):
        tamp.load_problem("one_object", robot=folder)


CUP = {
    "force": (yaml("force: 75.4", "force: 900"), r"pulls with 127 N at most, not with 900"),
    "radius": (yaml("radius: 0.02", "radius: -0.02"), r"radius"),
    "tilt": (yaml("tilt: 0.087", "tilt: 3.087"), r"tilt: a face may lean by 0 to 0.785 rad"),
    "fingers": (yaml("  radius:", "  opening: 0.1\n  radius:"), r"unknown key 'opening'.*Choices: .*radius"),
    "kind": (yaml("kind: suction", "kind: magnet"), r"unknown kind of gripper 'magnet'. .*parallel, suction"),
    "no-radius": (yaml("  radius: 0.02\n", ""), r"radius"),
}  # fmt: skip


@pytest.mark.parametrize("name", CUP)
def test_a_damaged_cup_is_one_clear_error_before_planning(name: str, tmp_path: Path) -> None:
    change, says = CUP[name]
    folder = tmp_path / "cup"
    shutil.copytree(ROBOTS["ur5_suction"]().folder, folder)
    change(folder)
    with pytest.raises(InputError, match=says):
        tamp.load_problem("parcels", robot=folder)


def test_an_unknown_robot_names_the_known_ones() -> None:
    with pytest.raises(
        InputError, match=r"unknown robot 'pnada_mobile'.*Did you mean 'panda_mobile'"
    ):
        tamp.load_problem("one_object", robot="pnada_mobile")
