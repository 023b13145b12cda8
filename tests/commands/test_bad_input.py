"""Every mistake is one clear error on the command line: exit 2, place, culprit and choices; nothing is written."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tamp.commands.solve import BAD_INPUT, run
from tamp.system.files import find_domain

PROBLEM = """\
name: mine
domain: cupboard
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
  can: {cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.2, 0.1]}
goal: (on can table)
"""
CAN = "{cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.2, 0.1]}"
MESH = "{mesh: thing.obj, on: table, at: [0.2, 0.1]}"
DOMAIN = find_domain("cupboard").read_text()
STREAMS = find_domain("cupboard").with_suffix(".streams.pddl").read_text()

TETRAHEDRON = """\
v 0 0 0
v 0.05 0 0
v 0 0.05 0
v 0 0 0.05
f 1 3 2
f 1 2 4
f 2 3 4
f 1 4 3
"""
CHAIN = """\
<robot name="chain">
  <link name="a"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
  <link name="b"><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision></link>
</robot>
"""
PROGRESS = re.compile(r"  [a-z ]+ +\d+\.\d s")
"""What is said where something takes longer than two seconds."""


@dataclass(frozen=True)
class Case:
    """One mistake: what is replaced by what in a good input, and what the one message must say.

    Attributes:
        name: Of the mistake.
        old: A passage of the problem, the domain or the streams that stands in exactly one of them.
        new: What the user wrote instead.
        says: A regular expression for the message.
        line: The line that it must name, of the file in which `old` stood; in PDDL where `old` begins, if not given.
        files: Further files beside the problem.
        options: Further arguments.
    """

    name: str
    old: str = ""
    new: str = ""
    says: str = ""
    line: int | None = None
    files: dict[str, str | bytes] = field(default_factory=dict)
    options: tuple[str, ...] = ()


CASES = [
    # Names that nobody knows
    Case(
        "unknown-body",
        "goal: (on can",
        "goal: (on cann",
        r"unknown object 'cann'.*can.*Did you mean 'can'",
        8,
    ),
    Case(
        "unknown-surface",
        "(on can table)",
        "(on can tabel)",
        r"unknown object 'tabel'.*Did you mean 'table'",
        8,
    ),
    Case(
        "unknown-support",
        "on: table",
        "on: tabel",
        r"unknown surface.*'tabel'.*Did you mean 'table'",
        7,
    ),
    Case(
        "unknown-robot",
        "panda_mobile",
        "pnada_mobile",
        r"'pnada_mobile'.*Did you mean 'panda_mobile'",
        3,
    ),
    Case(
        "unknown-predicate",
        "(on can table)",
        "(onn can table)",
        r"unknown predicate 'onn'.*Did you mean 'on'",
        8,
    ),
    Case("unknown-key", "name: mine", "nme: mine", r"unknown key 'nme'.*Did you mean 'name'", 1),
    Case(
        "unknown-type",
        "(holding ?o - movable",
        "(holding ?o - movble",
        r"'movble'.*Did you mean 'movable'",
    ),
    Case("unknown-shape", "cylinder: {", "cylindr: {", r"Did you mean 'cylinder'", 7),
    Case(
        "unknown-domain",
        "domain: cupboard",
        "domain: cupbord",
        r"'cupbord'.*Did you mean 'cupboard'",
        2,
    ),
    Case(
        "unknown-sampler",
        "domain: cupboard",
        "samplers: {on: unifrm}",
        r"'unifrm'.*Did you mean 'uniform'",
        2,
    ),
    Case(
        "unknown-relation",
        "domain: cupboard",
        "samplers: {onn: uniform}",
        r"'onn'.*Did you mean 'on'",
        2,
    ),
    Case(
        "unknown-stream",
        ":stream sample-on",
        ":stream sampel-on",
        r"'sampel-on'.*Did you mean 'sample-on'",
    ),
    Case(
        "unknown-predicate-of-a-stream",
        ":inputs (?o ?s) :domain (and (movable ?o) (surface ?s))",
        ":inputs (?o ?s) :domain (and (movble ?o) (surface ?s))",
        r"'movble'.*Did you mean 'movable'",
    ),
    Case(
        "unknown-predicate-of-an-action",
        "(not (loaded ?o)) ",
        "(not (loadd ?o)) ",
        r"Did you mean 'loaded'",
    ),
    Case(
        "unknown-option",
        says=r"'--sed'.*--time, --seed.*Did you mean '--seed'",
        options=("--sed", "1"),
    ),
    Case(
        "unknown-algorithm",
        says=r"'adaptve'.*Did you mean 'adaptive'",
        options=("--algorithm", "adaptve"),
    ),
    Case(
        "unknown-steering",
        says=r"'se3'.*se2, reeds-shepp.*Did you mean 'se2'",
        options=("--steering", "se3"),
    ),
    Case(
        "unknown-sampler-option",
        says=r"'unifrm'.*Did you mean 'uniform'",
        options=("--sampler", "on=unifrm"),
    ),
    Case(
        "unknown-relation-option",
        says=r"'onn'.*Did you mean 'on'",
        options=("--sampler", "onn=uniform"),
    ),
    Case(
        "sampler-mode",
        says=r"unknown mode 'allone'.*Did you mean 'alone'",
        options=("--sampler", "on=uniform:allone"),
    ),
    Case(
        "sampler-mode-in-the-file",
        "domain: cupboard",
        "samplers: {on: uniform:mxed}",
        r"'mxed'.*Did you mean 'mixed'",
        2,
    ),
    Case(
        "sampler-without-a-name",
        says=r"RELATION=NAME.*on=uniform",
        options=("--sampler", "uniform"),
    ),
    Case(
        "missing-streams",
        says=r"nowhere\.pddl: no such file",
        options=("--streams", "nowhere.pddl"),
    ),
    # The goal
    Case("goal-arity", "(on can table)", "(on can)", r"'on'.* 2 .*1", 8),
    Case("goal-type", "(on can table)", "(on table can)", r"'can'.*surface", 8),
    Case("goal-unclosed", "goal: (on can table)", "goal: (and (on can table)", r"never closed", 8),
    Case("goal-surplus", "goal: (on can table)", "goal: (on can table))", r"closes nothing", 8),
    Case("goal-empty", "goal: (on can table)", "goal: ''", r"goal: has no value", 8),
    Case(
        "goal-no-formula",
        "goal: (on can table)",
        "goal: can on table",
        r"expected the end of the text after one condition",
        8,
    ),
    Case(
        "goal-unknown-later",
        "(on can table)",
        ">\n  (and (on can table)\n    (on cap table))",
        r"'cap'.*'can'",
        10,
    ),
    Case(
        "init-arity", "domain: cupboard", "init: ['(hand-empty can)']", r"'hand-empty'.* 0 .*1", 2
    ),
    Case(
        "init-unknown",
        "domain: cupboard",
        "init: ['(hand-emty)']",
        r"'hand-emty'.*Did you mean 'hand-empty'",
        2,
    ),
    Case(
        "metric",
        "domain: cupboard",
        "metric: (maximize (beauty))",
        r"unknown metric.*\(minimize \(total-cost\)\)",
        2,
    ),
    # The file
    Case("a-list", PROBLEM, "- a\n- b\n", r"expected a mapping", 1),
    Case("words", PROBLEM, "just words", r"expected a mapping", 1),
    Case("empty", PROBLEM, "", r"empty"),
    Case("syntax", PROBLEM, "a: [1, 2\nb: 3\n", r"not valid YAML", 2),
    Case("tabs", PROBLEM, "bodies:\n\ttable: {}\n", r"not valid YAML", 2),
    Case("twice", "  can: ", "  table: ", r"'table' stands twice, first in line 6", 7),
    Case(
        "twice-at-the-top",
        "name: mine",
        "goal: (on can table)",
        r"'goal' stands twice, first in line 1",
        8,
    ),
    Case("missing-goal", "goal: (on can table)\n", "", r"'goal' is missing", 1),
    Case("missing-size", ", size: [1.2, 0.7, 0.72]", "", r"'size' is missing", 6),
    Case("missing-domain", "domain: cupboard\n", "", r"no domain", options=("only-the-problem",)),
    # Numbers
    Case("nan", "height: 0.1}", "height: .nan}", r"height.*not a finite number", 7),
    Case("infinite", "height: 0.1}", "height: .inf}", r"height.*not a finite number", 7),
    Case("negative", "height: 0.1}", "height: -0.1}", r"height.*positive.*-0\.1", 7),
    Case("zero", "height: 0.1}", "height: 0}", r"height.*positive", 7),
    Case("words-for-numbers", "height: 0.1}", "height: tall}", r"height.*'tall'", 7),
    Case("norm-0", "at: [0.2, 0.1]", "quaternion: [0, 0, 0, 0]", r"norm 0", 7),
    Case("nan-pose", "at: [0.2, 0.1]", "at: [.nan, 0.1]", r"not a finite number", 7),
    # Meshes
    Case("mesh-missing", CAN, MESH, r"no mesh file 'thing\.obj'", 7),
    Case(
        "mesh-typo", CAN, "{mesh: objects/mg.obj, on: table}", r"Did you mean 'objects/mug\.obj'", 7
    ),
    Case("mesh-empty", CAN, MESH, r"thing\.obj.*", 7, files={"thing.obj": ""}),
    Case("mesh-comment-only", CAN, MESH, r"thing\.obj.*", 7, files={"thing.obj": "# nothing\n"}),
    Case(
        "mesh-nan",
        CAN,
        MESH,
        r"thing\.obj.*",
        7,
        files={"thing.obj": TETRAHEDRON.replace("0.05 0 0", "nan 0 0")},
    ),
    Case(
        "mesh-one-triangle",
        CAN,
        MESH,
        r"thing\.obj.*",
        7,
        files={"thing.obj": TETRAHEDRON.partition("f")[0] + "f 1 2 3\n"},
    ),
    Case(
        "mesh-flat",
        CAN,
        MESH,
        r"thing\.obj.*",
        7,
        files={"thing.obj": TETRAHEDRON.replace("0 0 0.05", "0.05 0.05 0")},
    ),
    Case(
        "mesh-index", CAN, MESH, r"thing\.obj.*", 7, files={"thing.obj": TETRAHEDRON + "f 1 2 99\n"}
    ),
    Case("mesh-binary", CAN, MESH, r"thing\.obj.*", 7, files={"thing.obj": bytes(range(256)) * 40}),
    Case(
        "mesh-stl-garbage",
        CAN,
        MESH.replace("obj", "stl"),
        r"thing\.stl.*",
        7,
        files={"thing.stl": b"\xff" * 300},
    ),
    Case(
        "mesh-format",
        CAN,
        MESH.replace("obj", "blend"),
        r"thing\.blend.*",
        7,
        files={"thing.blend": "x"},
    ),
    Case("mesh-folder", CAN, "{mesh: ., on: table}", r"mesh", 7),
    Case(
        "urdf-many-links",
        CAN,
        MESH.replace("obj", "urdf"),
        r"2 links",
        7,
        files={"thing.urdf": CHAIN},
    ),
    Case(
        "urdf-broken",
        CAN,
        MESH.replace("obj", "urdf"),
        r"thing\.urdf.*",
        7,
        files={"thing.urdf": "<robot"},
    ),
    # The start
    Case(
        "overlap",
        "goal: (on can",
        "  box: {box: [0.1, 0.1, 0.1], on: table, at: [0.22, 0.1]}\ngoal: (on can",
        r"'can' and 'box' overlap at the start, \d+\.\d mm deep",
        8,
    ),
    Case(
        "overlap-furniture",
        "on: table, at: [0.2, 0.1]",
        "at: [1.6, 0.0, 0.7]",
        r"'table' and 'can' overlap",
        7,
    ),
    Case(
        "robot-in-furniture",
        "base: [0, 0, 0]",
        "base: [1.2, 0, 0]",
        r"starts in collision: \w+ hits table",
        3,
    ),
    Case(
        "robot-in-movable",
        "goal: (on can",
        "  box: {box: [0.1, 0.1, 0.1], on: floor, at: [0.1, 0.1]}\ngoal: (on can",
        r"starts in collision: base hits box",
        3,
    ),
    Case(
        "robot-in-itself",
        "[0, 0, 0]}",
        "[0, 0, 0], arm: [0.8, -0.8, -2.7, -3.05, 1.8, 3.5, 0.6]}",
        r"starts in collision",
        3,
    ),
    Case("robot-outside", "base: [0, 0, 0]", "base: [0, 9, 0]", r"out of the room: y = 9", 3),
    # The domain and its streams
    Case(
        "domain-unclosed",
        "(hand-empty)\n    (at-base",
        "(hand-empty\n    (at-base",
        r"never closed",
    ),
    Case(
        "domain-surplus",
        "(hand-empty)\n    (at-base",
        "(hand-empty))\n    (at-base",
        r"closes nothing",
    ),
    Case(
        "domain-unclosed-action",
        "(pick-motion ?o ?p ?g ?b ?q ?t)\n",
        "(pick-motion ?o ?p ?g ?b ?q ?t\n",
        r"never",
    ),
    Case(
        "streams-unclosed",
        ":certified (grasp ?o ?g))",
        ":certified (grasp ?o ?g)",
        r"never closed",
        3,
    ),
    Case(
        "streams-surplus",
        ":certified (grasp ?o ?g))",
        ":certified (grasp ?o ?g)))",
        r"closes nothing",
    ),
    Case(
        "stream-arity",
        ":outputs (?g) :certified (grasp ?o ?g)",
        ":outputs (?g) :certified (grasp ?g)",
        r"grasp",
    ),
    Case("domain-empty", DOMAIN, "", r"empty"),
    Case("streams-empty", STREAMS, "", r"empty"),
    Case("domain-garbage", DOMAIN, "\0\1\2 what (", r"my\.pddl:1"),
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "mine.yaml").write_text(PROBLEM)
    (tmp_path / "my.pddl").write_text(DOMAIN)
    (tmp_path / "my.streams.pddl").write_text(STREAMS)
    return tmp_path


def arguments(folder: Path, *options: str) -> list[str]:
    return [
        str(folder / "my.pddl"),
        str(folder / "mine.yaml"),
        "--out",
        str(folder / "plan.json"),
        *options,
    ]


def check_one_error(code: int, out: str, err: str) -> str:
    """The message of a run that must have ended with one."""
    assert code == BAD_INPUT, (code, out, err)
    assert out == ""
    lines = [line for line in err.splitlines() if not PROGRESS.fullmatch(line)]  # of a busy machine
    assert len(lines) == 1 and lines[0].startswith("error: "), err
    return lines[0].removeprefix("error: ")


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_one_clear_error(
    case: Case, folder: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    place, line = None, case.line
    if case.old:
        sources = [
            file for file in sorted(folder.iterdir()) if file.read_text().count(case.old) == 1
        ]
        assert len(sources) == 1, "the passage to be spoilt stands in one file, once"
        text = sources[0].read_text()
        sources[0].write_text(text.replace(case.old, case.new))
        place = str(sources[0])
        if sources[0].suffix == ".pddl" and text != case.old and line is None:
            line = text[: text.index(case.old)].count("\n") + 1
    for name, content in case.files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    before = sorted(folder.iterdir())
    if case.options == ("only-the-problem",):
        words = [str(folder / "mine.yaml")]
    elif "domain" in case.name and place and place.endswith(".yaml"):
        words = [str(folder / "mine.yaml"), "--out", str(folder / "plan.json")]
    else:
        words = arguments(folder, *case.options)
    code = run(words)
    message = check_one_error(code, *capsys.readouterr())
    assert re.search(case.says, message), message
    if place is not None:
        assert message.startswith(f"{place}:"), message
    if line is not None:
        assert re.match(rf"{re.escape(str(place))}:{line}(:\d+)?: ", message), message
    assert sorted(folder.iterdir()) == before, "something was written"


def test_a_mesh_that_is_not_watertight_is_mended_or_refused(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "mine.yaml").write_text(PROBLEM.replace(CAN, MESH))
    (folder / "thing.obj").write_text(TETRAHEDRON.removesuffix("f 1 4 3\n"))
    code = run(arguments(folder))
    out, err = capsys.readouterr()
    if code == BAD_INPUT:
        assert "thing.obj" in check_one_error(code, out, err)
    else:
        assert code == 0 and "warning: can: " in out and "watertight" in out, out


@pytest.mark.parametrize(
    ("option", "says"),
    [
        (("--time", "0"), r"must be positive, not 0"),
        (("--time", "-1"), r"must be positive, not -1"),
        (("--time", "nan"), r"must be positive, not nan"),
        (("--time", "abc"), r"--time.*'abc'"),
        (("--seed", "abc"), r"--seed.*'abc'"),
        (("--seed", "1.5"), r"--seed.*'1\.5'"),
        (("--seed", "1" * 400), r"--seed"),
        (("--seed",), r"--seed"),
        (("--json=3",), r"3"),
        (("-x",), r"-x"),
        (("third",), r"third"),
    ],
    ids=lambda value: "-".join(value)[:20] if isinstance(value, tuple) else "",
)
def test_options(
    option: tuple[str, ...], says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    message = check_one_error(run(arguments(folder, *option)), *capsys.readouterr())
    assert re.search(says, message), message
    assert not (folder / "plan.json").exists()


def test_no_files_at_all(capsys: pytest.CaptureFixture[str]) -> None:
    assert "expected [DOMAIN] PROBLEM" in check_one_error(run([]), *capsys.readouterr())


def test_domain_and_problem_in_the_wrong_order(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    message = check_one_error(
        run([str(folder / "mine.yaml"), str(folder / "my.pddl")]), *capsys.readouterr()
    )
    assert "expected [DOMAIN] PROBLEM" in message


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (
            ["for_objects"],
            r"unknown problem 'for_objects'.*four_objects.*Did you mean 'four_objects'",
        ),
        (["cupbord", "one_object"], r"unknown domain 'cupbord'.*Did you mean 'cupboard'"),
        (["nowhere/mine.yaml"], r"no such file: nowhere/mine\.yaml"),
        (["nowhere/my.pddl", "one_object"], r"no such file: nowhere/my\.pddl"),
        (["/tmp"], r"/tmp"),
        ([""], r"no problem given"),
        (["\0"], r""),
        (["x" * 5000], r""),
    ],
    ids=lambda value: value[0][:12] if isinstance(value, list) else "",
)
def test_names_of_files(
    words: list[str],
    says: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    monkeypatch.chdir(tmp_path)
    message = check_one_error(run(words), *capsys.readouterr())
    assert re.search(says, message), message
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("file", ["mine.yaml", "my.pddl", "my.streams.pddl"])
@pytest.mark.parametrize(
    "content",
    [
        b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 8,
        b"\xff\xfen\x00a\x00m\x00e\x00",
        "name: größe\ngoal: (on könn table)".encode("latin-1"),
        b"(" * 100_000,
        b"[" * 100_000,
        b"- (a)\n" * 1_700_000,
    ],
    ids=["png", "utf-16", "latin-1", "parentheses", "brackets", "10 MB"],
)
def test_files_of_something_else(
    file: str, content: bytes, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / file).write_bytes(content)
    message = check_one_error(run(arguments(folder)), *capsys.readouterr())
    assert message.startswith(str(folder / file)), message


def test_where_the_plan_cannot_be_written(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    problem = str(folder / "mine.yaml")
    (folder / "file").write_text("mine")
    os.mkfifo(folder / "pipe")
    for out, says in [
        (folder, r"is a folder. Name a file"),
        (folder / "file" / "plan.json", r"cannot be written"),
        (folder / "pipe", r"not a regular file"),
        (Path("/proc/plan.json"), r"cannot be written"),
        (folder / ("x" * 300), r""),
    ]:
        message = check_one_error(run([problem, "--out", str(out)]), *capsys.readouterr())
        assert message.startswith(f"{out}: ") and re.search(says, message), message
    assert (folder / "file").read_text() == "mine"
    assert sorted(path.name for path in folder.iterdir()) == [
        "file", "mine.yaml", "my.pddl", "my.streams.pddl", "pipe",
    ]  # fmt: skip


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    locked = folder / "locked"
    locked.mkdir(mode=0o500)
    message = check_one_error(
        run([str(folder / "mine.yaml"), "--out", str(locked / "p.json")]), *capsys.readouterr()
    )
    assert "Permission denied" in message


def test_as_a_command(folder: Path) -> None:
    """The same through a process of its own: nothing is printed that this process would have swallowed."""
    (folder / "mine.yaml").write_text(PROBLEM.replace("(on can table)", "(on can tabel)"))
    command = [str(Path(sys.executable).with_name("tamp-solve")), "mine.yaml", "--json"]
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=60, check=False
    )
    message = check_one_error(done.returncode, done.stdout, done.stderr)
    assert message.startswith("mine.yaml:8:15: unknown object 'tabel'")
    assert not (folder / "plan.json").exists()
