"""The house is as it is meant to be: each measure of `benchmarks/house.py` keeps its limit."""

from __future__ import annotations

import ast
from pathlib import Path

import networkx as nx
import pytest

from benchmarks import house
from benchmarks.house import Measure, measures

NAMES = 11


@pytest.fixture(scope="module")
def made() -> list[Measure]:
    return measures()


@pytest.mark.parametrize("number", range(NAMES))
def test_measures_keep_their_limits(number: int, made: list[Measure]) -> None:
    assert len(made) == NAMES
    one = made[number]
    assert one.holds, (
        f"{one.name}: {one.shown}, not {one.limit}\n{house.circles()}{house.upward()}{house.untested()}"
        f"{house.without_test_file()}"
    )


@pytest.mark.parametrize(
    ("value", "limit", "holds"),
    [(16, "<= 16", True), (17, "<= 16", False), (0.55, ">= 0.55", True), (0.54, ">= 0.55", False)],
)
def test_a_limit_is_kept_or_not(value: float, limit: str, holds: bool) -> None:
    assert Measure("m", value, limit).holds is holds


def test_circles_and_steps_up_are_found(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = nx.DiGraph([("tamp.plan.a", "tamp.planner.b"), ("tamp.planner.b", "tamp.plan.a")])
    monkeypatch.setattr(house, "imports", lambda *, late: graph)
    assert house.circles() == [["tamp.plan.a", "tamp.planner.b"]]
    assert house.upward() == [("tamp.planner.b", "tamp.plan.a")]


def test_imports_are_those_of_the_code() -> None:
    graph = house.imports(late=True)
    assert graph.has_edge("tamp.planner.optimize", "tamp.planner.problem")
    assert graph.number_of_edges() > 1000
    assert house.imports(late=False).number_of_edges() < graph.number_of_edges()


def test_what_a_test_names_is_asked() -> None:
    code = "import tamp.plan.a\nfrom tamp.plan import b\nrun('import grounding.c; print(1)')"
    named = {name for node in ast.walk(ast.parse(code)) for name in house._named(node)}
    assert named >= {"tamp.plan.a", "tamp.plan.b", "tamp.plan", "grounding.c"}


@pytest.mark.parametrize(
    ("code", "holds"),
    [
        ("def f(x):\n    return g(x)\n", False), ("def f(x):\n    return 1 if x else 2\n", True),
        ("A = [x for x in range(3) if x]\n", False), ("def f(x):\n    return [y for y in x]\n", True),
        ("class C:\n    def f(self, x):\n        return x < 3\n", True), ("class C:\n    x: int\n", False),
    ],
)  # fmt: skip
def test_a_module_decides_by_what_its_functions_do(code: str, holds: bool, tmp_path: Path) -> None:
    file = tmp_path / "m.py"
    file.write_text(code)
    assert house.decides(file) is holds


def test_tests_mirror_the_modules(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    deciding = tmp_path / "m.py"
    deciding.write_text("def f(x):\n    return x < 3\n")
    names = dict.fromkeys(
        ("tamp.planner.solve", "tamp.planner.solved", "grounding.paper.trees"), deciding
    )
    monkeypatch.setattr(house, "names_of_modules", lambda: names)
    assert house.without_test_file() == ["tamp.planner.solved"]
    assert (
        house.file_of_tests("grounding.paper.trees")
        == house.ROOT / "tests/grounding/paper/test_trees.py"
    )
