"""Nothing of the user's is overwritten, and what is written is there whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import re
import shutil
import signal
import stat
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from grounding.cli import run as learn
from tamp.commands.bench import run as bench
from tamp.commands.export import main as export
from tamp.commands.solve import BAD_INPUT, SOLVED, run
from tamp.commands.view import main as view
from tamp.errors import InputError
from tamp.system.files import find_domain, find_problem
from tamp.system.outputs import check_outputs, check_writable, locked_folder, write_whole
from tamp.system.terminal import spoken

DOMAIN = (
    "(define (domain d) (:predicates (p)) (:action a :parameters () :precondition () :effect (p)))"
)
TASK = "(define (problem t) (:domain d) (:init) (:goal (p)))"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a problem, its domain and a mesh of its own, and its plan."""
    folder = tmp_path_factory.mktemp("made")
    text = find_problem("one_object").read_text(encoding="utf-8")
    line = next(line for line in text.splitlines() if line.startswith("  soup_can:"))
    support = line[line.index("on:") :]
    (folder / "p.yaml").write_text(
        text.replace(line, f"  soup_can: {{mesh: can.obj, {support}"), encoding="utf-8"
    )
    corners = "".join(f"v {x} {y} {z}\n" for x in (0, 0.05) for y in (0, 0.05) for z in (0, 0.1))
    faces = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
    (folder / "can.obj").write_text(
        f"mtllib can.mtl\n{corners}usemtl paint\n{faces}", encoding="utf-8"
    )
    (folder / "can.mtl").write_text("newmtl paint\nmap_Kd paint.png\n", encoding="utf-8")
    (folder / "paint.png").write_bytes(b"a picture")
    for suffix in (".pddl", ".streams.pddl"):
        shutil.copy(find_domain("cupboard").with_suffix(suffix), folder / f"cupboard{suffix}")
    (folder / "d.pddl").write_text(DOMAIN, encoding="utf-8")
    (folder / "t.pddl").write_text(TASK, encoding="utf-8")
    with contextlib.chdir(folder):
        assert run(["p.yaml", "--out", "plan.json", "--quiet"]) == SOLVED
    return folder


@pytest.fixture
def folder(made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    here = tmp_path / "here"
    shutil.copytree(made, here)
    plan = json.loads((here / "plan.json").read_text(encoding="utf-8"))
    for source in ("problem", "domain", "streams"):
        plan["inputs"][source]["path"] = str(here / Path(plan["inputs"][source]["path"]).name)
    plan["inputs"]["meshes"][0]["path"] = str(here / "can.obj")
    (here / "plan.json").write_text(json.dumps(plan), encoding="utf-8")
    (here / "link.json").symlink_to("plan.json")
    os.link(here / "p.yaml", here / "hard.yaml")
    named = f"samplers: {{on: near.safetensors}}\n{(here / 'p.yaml').read_text(encoding='utf-8')}"
    (here / "named.yaml").write_text(named, encoding="utf-8")
    (here / "near.safetensors").write_bytes(b"weights")
    monkeypatch.chdir(here)
    return here


def contents(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


Command = Callable[[list[str]], int]


@pytest.mark.parametrize(
    ("command", "line"),
    [
        (run, "p.yaml --out p.yaml"),
        (run, "p.yaml --out ./../here/p.yaml"),
        (run, "p.yaml --out hard.yaml"),
        (run, "p.yaml --out can.obj"),
        (run, "p.yaml --out can.mtl"),
        (run, "p.yaml --png paint.png"),
        (run, "p.yaml --html cupboard.pddl"),
        (run, "p.yaml --out cupboard.streams.pddl"),
        (run, "p.yaml --statistics p.yaml"),
        (run, "p.yaml --statistics s.json --out s.json"),
        (run, "p.yaml --html x.html --out x.html"),
        (run, "d.pddl t.pddl --out t.pddl"),
        (run, "d.pddl t.pddl --out d.pddl"),
        (export, "plan.json --out plan.json"),
        (export, "plan.json --out link.json"),
        (export, "plan.json --out p.yaml"),
        (export, "plan.json --out can.obj"),
        (view, "plan.json --html plan.json"),
        (view, "link.json --html plan.json"),
        (view, "plan.json --html hard.yaml"),
        (view, "p.yaml --html can.obj"),
        (view, "p.yaml --html x.png --png x.png"),
        (view, "p.yaml --html cupboard.pddl"),
        (view, "p.yaml --html cupboard.streams.pddl"),
        (view, "named.yaml --html ./near.safetensors"),
        (view, "plan.json --problem p.yaml --html cupboard.streams.pddl"),
        (bench, "run --problems p.yaml --samplers default --seeds 1 --out can.obj"),
        (bench, "run --problems p.yaml --samplers default --seeds 1 --out cupboard.pddl"),
        (learn, "collect on p.yaml --out can.npz"),
    ],
)
def test_an_output_that_is_an_input_is_refused(
    command: Command, line: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if line.startswith("collect"):
        os.link(folder / "p.yaml", folder / "can.npz")
    before = contents(folder)
    assert command(line.split()) == BAD_INPUT
    error = capsys.readouterr().err
    assert error.startswith("error: ") and error.count("\n") == 1, error
    assert "would overwrite it, and it is an input" in error or "to the same file" in error, error
    assert contents(folder) == before


def test_devices_and_places_of_their_own_are_no_conflict(tmp_path: Path) -> None:
    source = tmp_path / "a.yaml"
    source.write_text("x", encoding="utf-8")
    null = Path("/dev/null")
    check_outputs({"--out": null, "--html": null, "--png": tmp_path / "b.png"}, [source])
    check_writable(null)
    write_whole(null, b"gone")


def test_what_is_no_log_of_ours_is_never_touched(tmp_path: Path) -> None:
    notes = tmp_path / "notes.txt"
    for content in (b"mine", b'{"mine": 1}\n', b"one\ntwo"):
        notes.write_bytes(content)
        words = [
            "run",
            "--problems",
            "one_object",
            "--samplers",
            "default",
            "--seeds",
            "1",
            "--out",
            str(notes),
        ]
        assert bench(words) == BAD_INPUT
        assert notes.read_bytes() == content


def test_a_link_is_followed_and_permissions_are_kept(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_bytes(b"old")
    target.chmod(0o640)
    link.symlink_to(target)
    write_whole(link, b"new")
    assert link.is_symlink() and target.read_bytes() == b"new"
    assert stat.S_IMODE(target.stat().st_mode) == 0o640


def test_a_full_disk_leaves_the_old_file_and_no_new_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*args: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    file = tmp_path / "plan.json"
    file.write_bytes(b"old")
    monkeypatch.setattr("tamp.system.outputs.os.fdopen", full)
    for path in (file, tmp_path / "new" / "deep" / "plan.json"):
        with pytest.raises(OSError, match="No space left"):
            write_whole(path, b"new")
    assert [path.name for path in tmp_path.iterdir()] == [
        "plan.json"
    ] and file.read_bytes() == b"old"


def test_a_picture_that_fails_loses_no_plan(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(path: Path, content: bytes) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("tamp.view.picture.write_whole", full)
    monkeypatch.setattr("tamp.planner.statistics_file.write_whole", full)
    plan = tmp_path / "plan.json"
    for option in ("--png", "--statistics"):
        plan.unlink(missing_ok=True)
        assert run(["one_object", "--out", str(plan), option, str(tmp_path / "x.png")]) == BAD_INPUT
        assert "No space left on device" in capsys.readouterr().err
        assert plan.is_file()


WRITER = """
import os, sys, time
from pathlib import Path
import tamp.system.outputs as outputs
true = os.fchmod
def slow(*args):
    print("writing", flush=True)
    time.sleep(60)
outputs.os.fchmod = slow
outputs.write_whole(Path(sys.argv[1]), b"new")
"""


def test_a_killed_run_leaves_the_old_file_and_the_next_one_tidies_up(tmp_path: Path) -> None:
    file = tmp_path / "plan.json"
    file.write_bytes(b"old")
    words = [sys.executable, "-c", WRITER, str(file)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None and process.stdout.readline() == "writing\n"
        write_whole(tmp_path / "other", b"x")  # what is still being written stays
        assert len(list(tmp_path.iterdir())) == 3
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert file.read_bytes() == b"old"
    write_whole(file, b"newer")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["other", "plan.json"]


def test_a_protected_file_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "plan.json"
    file.write_bytes(b"old")
    monkeypatch.setattr(
        "tamp.system.outputs.os.access", lambda path, mode: False
    )  # root may write everywhere
    with pytest.raises(InputError, match="Permission denied"):
        check_writable(file)
    with pytest.raises(OSError, match="Permission denied"):
        write_whole(file, b"new")
    assert file.read_bytes() == b"old"


def test_one_folder_has_one_writer_at_a_time(tmp_path: Path) -> None:
    child = os.fork()
    if child == 0:
        with locked_folder(tmp_path):
            (tmp_path / "mine").touch()
            time.sleep(0.5)
            (tmp_path / "mine").unlink()
        os._exit(0)
    while not (tmp_path / "mine").exists():
        time.sleep(0.01)
    with locked_folder(tmp_path):
        assert not (tmp_path / "mine").exists()
    os.waitpid(child, 0)


def test_a_full_disk_is_one_error_in_every_command(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(*args: object) -> int:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr("tamp.system.outputs.os.fdopen", full)
    before = contents(folder)
    for command, line in (
        (run, "p.yaml --out out.json"),
        (run, "d.pddl t.pddl --out out.json"),
        (export, "plan.json --out out.json"),
        (view, "plan.json --png out.png --size 32x32"),
        (view, "plan.json --html out.html"),
        (spoken(learn), "collect on p.yaml --out out.npz"),
    ):
        assert command(line.split()) == BAD_INPUT
        said = capsys.readouterr().err.splitlines()
        errors = [line for line in said if line.startswith("error: ")]
        assert len(errors) == 1 and said[-1] == errors[0], (
            said
        )  # warnings of what was collected may stand before it
        assert "No space left on device" in errors[0] and re.search(
            r"[ /]out\.(json|png|html|npz): ", said[-1]
        ), said
    assert contents(folder) == before


def test_a_folder_of_the_users_is_not_removed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mine = tmp_path / ".x.parts"
    mine.mkdir()
    (mine / "diary").write_text("dear", encoding="utf-8")
    assert (
        learn(
            ["generate", "on", "--count", "2", "--workers", "1", "--out", str(tmp_path / "x.npz")]
        )
        == BAD_INPUT
    )
    assert "is in the way" in capsys.readouterr().err
    assert (mine / "diary").is_file()


def test_links_in_a_circle_are_refused_and_stay(tmp_path: Path) -> None:
    circle, dangling = tmp_path / "circle", tmp_path / "dangling"
    circle.symlink_to("circle")
    dangling.symlink_to("new.txt")
    with pytest.raises(InputError, match="circle: the output cannot be written"):
        check_writable(circle)
    with pytest.raises(OSError, match="symbolic links"):
        write_whole(circle, b"text")
    assert circle.is_symlink()

    check_writable(dangling)
    write_whole(dangling, b"text")
    assert dangling.is_symlink() and (tmp_path / "new.txt").read_bytes() == b"text"
