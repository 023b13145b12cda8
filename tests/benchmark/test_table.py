"""Tables that are read as they stand, and where their figures come from."""

from __future__ import annotations

import pytest

from tamp.benchmark.table import MOST_WARNINGS, report, short, table
from tests.benchmark.toys import TIMEOUT, line, some

MACHINE = {"cpu": "A cpu", "cores": 2}


def test_cells_are_padded_names_to_the_left_and_numbers_to_the_right() -> None:
    rows = [{"problem": "swap", "solved": "3/4"}, {"problem": "packed", "solved": "10/10"}]
    assert table(rows).split("\n") == [
        "| problem | solved |",
        "|---------|-------:|",
        "| swap    |    3/4 |",
        "| packed  |  10/10 |",
    ]


@pytest.mark.parametrize(
    ("problem", "shown"),
    [("swap", "swap"), ("/a/b/mine.yaml", "mine"), ("./mine.yaml", "mine"), ("a.b", "a.b")],
)
def test_a_path_is_shown_by_its_name(problem: str, shown: str) -> None:
    assert short(problem) == shown


def cells(text: str, row: int = 2) -> dict[str, str]:
    """One row of the first table by its head."""
    lines = [
        [cell.strip() for cell in one.strip("|").split("|")]
        for one in text.split("\n")[:9]
        if "|" in one
    ]
    return dict(zip(lines[0], lines[row], strict=True))


def test_a_run_without_a_plan_takes_longer_than_its_budget() -> None:
    cases = some(3)
    found = cells(
        report(
            [line(cases[0], 2.0), line(cases[1], 30.1, **TIMEOUT), line(cases[2], 30.2, **TIMEOUT)]
        )
    )
    assert (found["solved"], found["median [s]"], found["p95 [s]"]) == ("1/3", ">30", ">30")
    assert found["PAR-2 [s]"] == f"{(2 + 60 + 60) / 3:.2f}"
    assert found["CPU median [s]"] == ""  # no run tells


def test_against_a_baseline_the_others_are_compared_seed_by_seed() -> None:
    lines = [line(case, 3.0) for case in some(2, ("uniform",))] + [
        line(case, 1.5) for case in some(2)
    ]
    text = report(lines, "uniform")
    assert (
        cells(text)["faster than uniform"] == "" and cells(text, 3)["faster than uniform"] == "2x"
    )
    assert "faster" not in report(lines)


def test_parts_add_up_to_their_total() -> None:
    lines = [line(case, 2.0, parts_s={"search": 0.5, "motion": 1.5}) for case in some(2)]
    text = report(lines)
    assert "Mean seconds by part, of all runs:" in text
    assert "0.500 (25 %)" in text and "1.500 (75 %)" in text and "2.000" in text
    assert "by part" not in report([line(case) for case in some(2)])


def test_where_the_figures_come_from() -> None:
    cases = some(3)
    lines = [
        line(cases[0], commit="abc", machine=MACHINE, load=1.0),
        line(cases[1], commit="def", machine=MACHINE, load=7.26),
        line(cases[2]),
    ]
    last = report(lines).split("\n")[-2:]
    assert last[0].startswith("3 runs of 30 s, adaptive;")
    assert last[1] == "Commit abc and def; A cpu, 2 cores, load 1.0-7.3."
    assert report([line(cases[0])]).endswith("Commit unknown; unknown.")


def test_samplers_that_took_no_part_to_the_end_are_named_with_their_number() -> None:
    out = "sampler 'flow' for 'on' is sidelined: it raised"
    lines = [line(case, warnings=[out, "the mesh is open"]) for case in some(3, ("flow",))]
    text = report(lines)
    assert f"Samplers that were sidelined:\n3 x flow: {out}\n" in text and "mesh" not in text
    many = [
        line(case, warnings=[f"{i} is sidelined"])
        for i, case in enumerate(some(MOST_WARNINGS + 2, ("flow",)))
    ]
    assert "\nand 2 more\n" in report(many)
