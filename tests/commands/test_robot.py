"""tamp-robot: what is asked of the maker of robots, what is refused before minutes are spent, what is said."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tamp.commands import robot
from tamp.commands.robot import OURS, Make, _wanted, main  # pyright: ignore[reportPrivateUsage]
from tamp.commands.robot_folder.wanted import Wanted
from tamp.errors import InputError
from tamp.simulation import engines
from tests.commands.robot_folder.hands import SLIDES, sliding
from tests.commands.robot_folder.urdf import arm_text, write_arm
from tests.needs import INSTALLED

MJCF = """
<mujoco model="arm"><worldbody><body name="foot"><geom type="box" size=".1 .1 .05"/>
<body name="one" pos="0 0 .1"><joint name="a" axis="0 0 1" range="-1 1"/><geom type="sphere" size=".05"/>
<body name="two" pos="0 0 .2"><joint name="b" axis="0 1 0" range="-1 1"/><geom type="sphere" size=".05"/>
</body></body></body></worldbody></mujoco>
"""


@pytest.mark.parametrize(
    ("name", "what", "engine"),
    [
        ("panda_fixed", "7 joints, fixed base", INSTALLED[0]),
        ("two_pandas", "7 + 7 joints, fixed base", "mujoco"),
        ("two_ur5", "6 + 6 joints, omnidirectional base", INSTALLED[0]),
    ],
)
def test_a_robots_folder_is_checked_with_all_its_arms(
    name: str,
    what: str,
    engine: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(engines, "installed", lambda one: one == engine)
    assert main(["check", name]) == 0
    said = capsys.readouterr().out
    assert f"{name}: {what}, sound" in said
    assert f"frames differ from {engine}'s by" in said


def test_another_folder_is_not_overwritten(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "letter.txt").write_text("dear")
    (tmp_path / "arm.urdf").write_text(arm_text())
    assert (
        main(
            [
                "make",
                str(tmp_path / "arm.urdf"),
                "--arm",
                "foot",
                "tool",
                "--out",
                str(tmp_path / "mine"),
            ]
        )
        == 2
    )
    assert "no robot's folder" in capsys.readouterr().err
    assert (tmp_path / "mine" / "letter.txt").read_text() == "dear"


def wanted(folder: Path, extra: str = "", **options: object) -> Wanted:
    """Settle the choices for the arm of boxes with more elements."""
    file = write_arm(folder, extra=extra)
    return _wanted(Make(urdf=str(file), out=folder / "out", **options), file)  # type: ignore[arg-type]


def test_fingers_that_nobody_named_and_that_cannot_close_give_way_to_ours(tmp_path: Path) -> None:
    crossed = wanted(tmp_path, sliding((1, -1), ("0 0.04", "0 0.04"), (-0.01, 0.01)))
    assert crossed.fingers is None and crossed.remarks == (OURS,)
    sound = wanted(tmp_path, sliding(*SLIDES["both along y"]))
    assert sound.fingers == ("left_finger_joint", "right_finger_joint") and sound.remarks == ()


def test_a_cup_takes_the_place_of_fingers_that_were_found(tmp_path: Path) -> None:
    text = sliding(*SLIDES["both along y"])
    cup = wanted(tmp_path, text, suction=0.02)
    assert cup.fingers is None and cup.remarks == ()  # and not for that they would not close
    named = ("right_finger_joint", "left_finger_joint")
    assert wanted(tmp_path, text, gripper=named).fingers == named


def test_what_is_said_reaches_the_maker(tmp_path: Path) -> None:
    made = wanted(
        tmp_path,
        arm=("pan_link", "tool"),
        base="car",
        turning_radius=0.7,
        payload=2.0,
        height=0.5,
        stands=("a=0.5", "b=-1"),
        without=("x",),
        home=(0.0, 1.0),
    )
    assert (made.base, made.tip, made.drive, made.turning_radius) == (
        "pan_link",
        "tool",
        "car",
        0.7,
    )
    assert (made.payload, made.height, made.home, made.without) == (2.0, 0.5, (0.0, 1.0), ("x",))
    assert made.fixed == {"a": 0.5, "b": -1.0} and made.out == tmp_path / "out"
    assert wanted(tmp_path).payload == math.inf


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--base car", "--base car needs --turning-radius"),
        ("--turning-radius 1", "--turning-radius is of --base car alone"),
        ("--base flying", "unknown drive 'flying'"),
        ("--stands a=b", "--stands a=b: JOINT=VALUE is expected"),
        ("--force 0", "--force 0.0 is not positive"),
        ("--payload -1", "--payload -1.0 is not positive"),
    ],
)
def test_what_does_not_go_together_is_refused_at_once(
    words: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = write_arm(tmp_path)
    assert main(["make", str(file), "--out", str(tmp_path / "out"), "--quiet", *words.split()]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_what_was_made_is_said_and_how_a_problem_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(robot, "_made", lambda wanted, options, shown: [wanted.tip, "a remark"])
    out = tmp_path / "boxes"
    assert main(["make", str(write_arm(tmp_path)), "--out", str(out), "--quiet"]) == 0
    first, second, last = capsys.readouterr().out.splitlines()
    assert (first, second) == (f"{out}: tool", "  a remark")
    assert last.endswith(f"In a problem: robot: {{model: {out}, base: [x, y, yaw]}}")


def test_what_is_wrong_in_an_mjcf_is_said_of_the_file_that_was_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """And not of the URDF that it becomes on the way, which is gone afterwards."""

    def fails(wanted: Wanted, *_: object) -> list[str]:
        raise InputError("the arm is bent", file=wanted.urdf)

    monkeypatch.setattr(robot, "_made", fails)
    file = tmp_path / "arm.xml"
    file.write_text(MJCF, encoding="utf-8")
    assert main(["make", str(file), "--out", str(tmp_path / "out"), "--quiet"]) == 2
    assert f"{file}: the arm is bent" in capsys.readouterr().err
