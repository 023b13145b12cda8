"""The command `tamp-robot`."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import tyro

from tamp.errors import InputError
from tamp.system.command_line import as_command
from tamp.system.options import Above, Between, OneOf, check_rules, read_command
from tamp.system.progress import Progress, say
from tamp.system.scratch import scratch_folder

if TYPE_CHECKING:
    from tamp.commands.robot_folder.ends import End
    from tamp.commands.robot_folder.wanted import Wanted

OURS = "the fingers of the URDF do not close: a gripper of ours takes their place"

DRIVES = ("omnidirectional", "differential", "car", "fixed")


@dataclass(frozen=True)
class Make:
    """Make a robot's folder from a URDF or an MJCF.

    A problem names it, `robot: {model: FOLDER}`, or --robot of tamp-solve.

    The arm is the chain of joints between two links. A parallel gripper of ours is bolted to its
    tip, in place of whatever hangs there, unless --gripper names the two sliding finger joints of
    the URDF's own. docs/adding-a-robot.md goes through it. What was interrupted goes on where it
    was when it is asked for again.

    Exit status: 0 made, 2 bad input.
    """

    urdf: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="FILE")]
    """A URDF or an MJCF, or a robot's name in example-robot-data, or pybullet_data/..."""
    out: Annotated[Path, tyro.conf.arg(metavar="FOLDER")]
    """The folder to make; its name is the robot's."""
    arm: Annotated[tuple[str, str] | None, tyro.conf.arg(metavar="BASE TIP")] = None
    """The links that the arm begins and ends with; asked for where the file leaves a choice."""
    srdf: Annotated[Path | None, tyro.conf.arg(metavar="FILE")] = None
    """MoveIt's SRDF of the robot; else one is looked for beside the URDF. Its groups say which is
    the arm, its end effectors which the gripper; a state proposes the home, and pairs that it
    disables are checked where they meet."""
    base: Annotated[str, tyro.conf.arg(metavar="NAME"), OneOf("drive", DRIVES)] = "omnidirectional"
    """omnidirectional, differential (turns on the spot, drives straight), car (arcs and straight
    lines, forwards and backwards; --turning-radius says how tight), or fixed."""
    turning_radius: Annotated[
        float | None,
        tyro.conf.arg(metavar="M"),
        Between(0.05, 20.0, "--turning-radius {value} is not from 0.05 to 20 m"),
    ] = None
    """Of the tightest circle that the middle of a car's base drives, metres."""
    gripper: Annotated[tuple[str, str] | None, tyro.conf.arg(metavar="LEFT RIGHT")] = None
    """The sliding finger joints of the URDF's own gripper."""
    axis: Annotated[str | None, tyro.conf.arg(metavar="AXIS")] = None
    """The tip's axis along which our gripper points: x, -x, y, -y, z or -z; else that of the last
    joint, out of the arm."""
    opening: Annotated[
        float | None, tyro.conf.arg(metavar="M"), Above(0.0, "--opening {value} is not positive")
    ] = None
    """The gripper's largest opening, metres; ours opens 0.085."""
    suction: Annotated[
        float | None, tyro.conf.arg(metavar="M"), Above(0.0, "--suction {value} is not positive")
    ] = None
    """A suction gripper of ours instead of fingers; the radius of its cup's rim, metres."""
    force: Annotated[
        float | None, tyro.conf.arg(metavar="N"), Above(0.0, "--force {value} is not positive")
    ] = None
    """With which each finger presses, newtons (50), or the most that a cup pulls with (what 0.6 bar
    do on it)."""
    payload: Annotated[
        float | None, tyro.conf.arg(metavar="KG"), Above(0.0, "--payload {value} is not positive")
    ] = None
    """The most that the arm lifts, kilograms."""
    mount: Annotated[
        tuple[float, float, float, float] | None, tyro.conf.arg(metavar="X Y Z YAW")
    ] = None
    """Where the URDF's root is on the base, metres and radians."""
    height: Annotated[float, tyro.conf.arg(metavar="M")] = 0.0
    """How high a fixed arm is bolted to something, metres; such as a table's height."""
    home: Annotated[tuple[float, ...] | None, tyro.conf.arg(metavar="Q")] = None
    """The arm's carrying configuration, one number a joint; else one is looked for."""
    stands: Annotated[tuple[str, ...], tyro.conf.arg(metavar="JOINT=VALUE")] = ()
    """Where joints stand that are no part of the arm; else as near to 0 as they get."""
    without: Annotated[tuple[str, ...], tyro.conf.arg(metavar="LINK")] = ()
    """Links that are left out, with all that hangs on them but the arm: another arm of the body."""
    quiet: bool = False
    """No progress."""


@dataclass(frozen=True)
class Check:
    """Check a robot's folder: its files, home, inverse kinematics, and frames against an engine's.

    Exit status: 0 sound, 2 not.
    """

    robot: Annotated[str, tyro.conf.Positional, tyro.conf.arg(metavar="ROBOT")]
    """A shipped robot's name, or a folder."""


@as_command()
def main(shown: Progress, arguments: Sequence[str] | None = None) -> int:
    """Exit with 0 when the robot is made or sound, 2 for bad input."""
    kinds = {"make": Make, "check": Check}
    words = list(sys.argv[1:] if arguments is None else arguments) or ["--help"]
    options = read_command(kinds, "tamp-robot", words)
    check_rules(options)
    if isinstance(options, Check):
        _check(options.robot)
        return 0
    shown.quiet = options.quiet
    _make(options, shown)
    return 0


def _make(options: Make, shown: Progress) -> None:
    _check_out(options.out)
    _check_drive(options)
    from tamp.commands.robot_folder.description import find_urdf
    from tamp.commands.robot_folder.mjcf import as_urdf

    began = time.monotonic()
    with scratch_folder() as scratch:
        file = find_urdf(options.urdf)
        urdf = as_urdf(file, scratch)
        try:
            lines = _made(_wanted(options, urdf, file), options, shown)
        except InputError as error:
            raise error if error.file != str(urdf) else error.about(file) from None
    shown.end()
    seconds = time.monotonic() - began
    say(f"{options.out}: {lines[0]}")
    for line in lines[1:]:
        say(f"  {line}")
    say(f"  {seconds:.0f} s. In a problem: robot: {{model: {options.out}, base: [x, y, yaw]}}")


def _made(wanted: Wanted, options: Make, shown: Progress) -> list[str]:
    """Make the folder; return what there is to say."""
    from tamp.commands.robot_folder.check import against_physics, check_home, solved
    from tamp.commands.robot_folder.make import make
    from tamp.commands.robot_folder.write import write_folder
    from tamp.geometric.loading.robot_folder import read_robot
    from tamp.simulation.engines import default_engine

    made = make(wanted, lambda what, share: shown.news(f"{what} ({share:.0%})"))
    srdf = None if wanted.srdf is None else str(wanted.srdf.file)
    write_folder(wanted.out, made.robot, made.covers, made.table, made.masses, options.urdf, srdf)
    robot = read_robot(wanted.out)
    engine = default_engine()
    shown.news(f"checks against {engine}")
    physics = against_physics(robot)
    check_home(robot)
    share = solved(robot)
    kinds = ", ".join(f"{joint.name} ({joint.kind})" for joint in robot.joints)
    hulls = sum(len(link.parts) for link in robot.links)
    pairs = len(robot.links) * (len(robot.links) - 1) // 2 - len(robot.allowed)
    return [
        f"{robot.name}, {len(robot.joints)} joints: {kinds}",
        f"{hulls} convex parts, {pairs} pairs of links are checked, home {_numbers(robot.home)}",
        *made.warnings,
        f"frames differ from pinocchio's by {made.off:.1g}, from {engine}'s by {physics:.1g}",
        f"inverse kinematics finds {share:.1%} of reachable poses",
    ]


def _wanted(options: Make, urdf: Path, file: Path | None = None) -> Wanted:
    """Settle the choices that a robot is made by.

    Args:
        options: The user's.
        urdf: The description.
        file: The one that the user named, beside which an SRDF is looked for.
    """
    from tamp.commands.robot_folder.choose_gripper import closes
    from tamp.commands.robot_folder.description import read_description
    from tamp.commands.robot_folder.ends import choose_end, ends
    from tamp.commands.robot_folder.srdf_arm import choose_arm, choose_fingers
    from tamp.commands.robot_folder.srdf_search import srdf_for
    from tamp.commands.robot_folder.wanted import Wanted

    def own(end: End) -> bool:
        chosen = Wanted(urdf, end.tip, options.out, base=end.base, fingers=end.fingers)
        return end.fingers is not None and closes(description, chosen)

    (base, tip), found = options.arm or ("", ""), None
    description = read_description(urdf)
    srdf, remarks = srdf_for(description, options.srdf, file or urdf)
    if options.arm is None:
        end, said = None, ""
        if srdf is not None and len(ends(description)) != 1:
            end, said = choose_arm(srdf, description)
        end = choose_end(description, own) if end is None else end
        base, tip, found = end.base, end.tip, end.fingers
        remarks = (*remarks, said) if said else remarks
    asked = options.gripper is None and options.suction is None and options.axis is None
    if srdf is not None and found is None and asked and tip in description.links:
        found, said = choose_fingers(srdf, description, tip)
        remarks = (*remarks, said) if said else remarks
    wanted = Wanted(
        urdf=urdf,
        base=base,
        tip=tip,
        out=options.out.absolute(),
        drive=options.base,
        turning_radius=options.turning_radius,
        fingers=options.gripper or (None if options.suction else found),
        opening=options.opening,
        force=options.force,
        suction=options.suction,
        payload=math.inf if options.payload is None else options.payload,
        mount=options.mount,
        axis=options.axis,
        height=options.height,
        home=options.home,
        fixed=_fixed(options.stands),
        without=options.without,
        srdf=srdf,
        remarks=remarks,
    )
    chosen = options.gripper is None and wanted.fingers is not None
    if chosen and not closes(description, wanted):
        return replace(wanted, fingers=None, remarks=(*remarks, OURS))
    return wanted


def _fixed(words: Sequence[str]) -> dict[str, float]:
    found: dict[str, float] = {}
    for word in words:
        name, _, value = word.partition("=")
        try:
            found[name] = float(value)
        except ValueError:
            raise InputError(
                f"--stands {word}: JOINT=VALUE is expected, in radians or metres"
            ) from None
    return found


def _check_drive(options: Make) -> None:
    """Refuse a car without its turning radius, and a turning radius without a car."""
    if options.base == "car" and options.turning_radius is None:
        raise InputError(
            "--base car needs --turning-radius",
            remedy="Say the radius of the tightest circle that its middle drives, metres",
        )
    if options.base != "car" and options.turning_radius is not None:
        raise InputError("--turning-radius is of --base car alone", remedy="Leave one of them out")


def _check_out(out: Path) -> None:
    """Refuse a folder that is something else, before minutes are spent."""
    if out.exists() and not (out / "robot.yaml").is_file():
        raise InputError(
            "it exists and is no robot's folder", file=out, remedy="Choose another place with --out"
        )


def _check(name: str) -> None:
    from tamp.commands.robot_folder.check import against_physics, check_home, solved
    from tamp.geometric.loading.robots import find_robot, load_robot
    from tamp.geometric.robot.reachability import Reachability
    from tamp.geometric.robot.spheres import link_covers
    from tamp.simulation.engines import default_engine

    robot = load_robot(find_robot(name))
    if robot.drive != "fixed" or not robot.beside:  # else no table is asked where to stand
        for arm in robot.arms:
            Reachability(arm)
    link_covers(robot)
    check_home(robot)
    off = against_physics(robot)
    share = min(map(solved, robot.arms))
    if share < 0.98:
        raise InputError(f"inverse kinematics finds {share:.1%} of reachable poses only",
                         file=robot.folder)  # fmt: skip
    joints = " + ".join(str(len(arm.joints)) for arm in robot.arms)
    say(f"{robot.name}: {joints} joints, {robot.drive} base, sound")
    engine = default_engine()
    say(f"  frames differ from {engine}'s by {off:.1g}; inverse kinematics finds {share:.1%}")


def _numbers(values: Sequence[float]) -> str:
    return f"[{', '.join(f'{value:.3g}' for value in values)}]"


if __name__ == "__main__":
    sys.exit(main())
