"""What a problem consists of: where its domain and streams are, its start, goal and metric."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.robots import load_robot
from tamp.planner.problem_files import ProblemFiles, parse_task, read_files
from tamp.symbolic.pddl.structs import And, Atom
from tamp.system.files import find_domain, shipped
from tests.geometric.making import scene, table

PROBLEM = """\
domain: cupboard
robot: {model: panda_mobile, base: [0.0, 0.0, 0.0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.6], at: [1.2, 0.0, 0.0]}
  cup:   {box: [0.06, 0.06, 0.1], on: table}
goal: (on cup table)
"""


def read(
    folder: Path, text: str = PROBLEM, *, domain: str | Path | None = None,
    streams: str | Path | None = None,
) -> ProblemFiles:  # fmt: skip
    file = folder / "own.yaml"
    file.write_text(text, encoding="utf-8")
    return read_files(file, domain, streams, None, None)


def copied(folder: Path, name: str = "mine", streams: bool = True) -> Path:
    """The cupboard's domain under another name, with its streams beside it."""
    for suffix in (".pddl", ".streams.pddl")[: 1 + streams]:
        source = find_domain("cupboard").with_suffix(suffix)
        (folder / f"{name}{suffix}").write_text(source.read_text(encoding="utf-8"))
    return folder / f"{name}.pddl"


# ---------------------------------------------------------------- which files


def test_a_shipped_domain_is_found_by_name_with_its_streams_beside(tmp_path: Path) -> None:
    files = read(tmp_path)
    assert files.domain_path == find_domain("cupboard")
    assert files.streams_path == shipped("domains") / "cupboard.streams.pddl"
    roles = files.by_role()
    assert roles["problem"] == ((tmp_path / "own.yaml").resolve(),)
    assert roles["domain"] == (files.domain_path.resolve(),)
    assert roles["meshes"] == roles["drawn"] == ()


def test_a_domain_named_in_the_file_is_looked_for_beside_it(tmp_path: Path) -> None:
    copied(tmp_path)
    files = read(tmp_path, PROBLEM.replace("domain: cupboard", "domain: mine.pddl"))
    assert files.domain_path.resolve() == (tmp_path / "mine.pddl").resolve()
    assert files.streams_path.resolve() == (tmp_path / "mine.streams.pddl").resolve()


def test_what_is_given_counts_before_what_the_file_names(tmp_path: Path) -> None:
    mine = copied(tmp_path)
    other = tmp_path / "others.pddl"
    other.write_text((tmp_path / "mine.streams.pddl").read_text())
    files = read(tmp_path, domain=mine, streams=other)
    assert (files.domain_path, files.streams_path) == (mine, other)


def test_no_domain_at_all_has_a_remedy(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no domain") as caught:
        read(tmp_path, PROBLEM.replace("domain: cupboard\n", ""))
    assert "domain: cupboard" in (caught.value.remedy or "")


def test_an_unknown_domain_is_told_at_its_line(tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read(tmp_path, "# a comment\n" + PROBLEM.replace("cupboard", "cupbord"))
    assert caught.value.line == 2 and "cupboard" in (caught.value.choices or ())


def test_streams_that_are_not_there_are_asked_for(tmp_path: Path) -> None:
    mine = copied(tmp_path, streams=False)
    with pytest.raises(InputError, match=r"streams of 'mine\.pddl' are looked for beside it") as no:
        read(tmp_path, domain=mine)
    assert "--streams FILE" in (no.value.remedy or "")


def test_a_scene_is_taken_as_it_is_by_now(tmp_path: Path) -> None:
    file = tmp_path / "own.yaml"
    file.write_text(PROBLEM, encoding="utf-8")
    now = scene(table("desk"))
    assert read_files(file, None, None, now, None).loaded.scene is now


def test_movable_bodies_have_tops_where_the_domain_knows_them(tmp_path: Path) -> None:
    assert not read(tmp_path).loaded.scene.bodies["cup"].surfaces
    carried = read(tmp_path, domain="carriers").loaded.scene
    assert [one.name for one in carried.bodies["cup"].surfaces] == ["cup"]


# ---------------------------------------------------------------- the start, the goal, the metric


def test_the_files_facts_join_those_of_the_scene(tmp_path: Path) -> None:
    domain = copied(tmp_path)
    text = domain.read_text()
    domain.write_text(text.replace("(:predicates", "(:predicates (clean ?o - movable)", 1))
    start, goal = parse_task(read(tmp_path, PROBLEM + "init: [(clean cup)]\n", domain=domain), None)
    assert ("clean", "cup") in start.facts and ("hand-empty",) in start.facts
    assert start.objects["cup"] == ("movable",)
    assert goal == Atom("on", ("cup", "table"))


def test_a_mistake_in_the_goal_is_told_in_the_yamls_lines_and_columns(tmp_path: Path) -> None:
    text = PROBLEM.replace(
        "goal: (on cup table)", "goal: |\n  (and (on cup table)\n       (on cap table))"
    )
    with pytest.raises(InputError) as caught:
        parse_task(read(tmp_path, text), None)
    assert (caught.value.line, caught.value.column) == (9, 12)
    assert "'cap'" in caught.value.message


def test_a_circle_is_refused_where_bodies_carry_bodies(tmp_path: Path) -> None:
    text = PROBLEM.replace(
        "  cup:", "  jar:   {box: [0.06, 0.06, 0.1], on: table, at: [0.2, 0.0]}\n  cup:"
    )
    text = text.replace("(on cup table)", "(and (on cup jar) (on jar cup))")
    with pytest.raises(InputError, match="in a circle"):
        parse_task(read(tmp_path, text, domain="carriers"), None)


@pytest.mark.parametrize("metric", ["(minimize (total-cost))", "minimize   total-cost"])
def test_the_cost_may_be_the_metric(tmp_path: Path, metric: str) -> None:
    _, goal = parse_task(read(tmp_path, PROBLEM + f"metric: {metric}\n"), None)
    assert not isinstance(goal, And)


def test_no_other_metric_is_known(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="unknown metric") as caught:
        parse_task(read(tmp_path, PROBLEM + "metric: (minimize (total-time))\n"), None)
    assert caught.value.line == 8 and "total-cost" in (caught.value.remedy or "")


def test_an_arms_name_is_no_bodys(tmp_path: Path) -> None:
    arm = load_robot("two_pandas").arms[1].arm
    assert arm is not None
    text = PROBLEM.replace("panda_mobile", "two_pandas").replace("cup", arm.title())
    text = text.replace(f"{arm.title()}board", "two_arms")
    with pytest.raises(InputError, match="is the name of one of the robot's arms") as caught:
        parse_task(read(tmp_path, text), None)
    assert caught.value.line == 6
