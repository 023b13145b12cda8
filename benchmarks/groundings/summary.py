"""What the measurements amount to: means over the seeds, Wilson's intervals, tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from benchmarks.common import wilson
from benchmarks.groundings.case import NAMES
from benchmarks.groundings.measure import BATCHES
from grounding.registry import RELATIONS

Line = Mapping[str, Any]

JUDGES = ("mca", "settled")
"""By which poses are judged."""

PUBLISHED_ORACLE = "published"
"""By which they are judged beside the paper's figures: the published code's, at 3 cm."""

FAILURES = {"mca": "mca_failures", "settled": "failures"}
"""A judge's field of failures."""


@dataclass(frozen=True)
class Share:
    """A share of scenes.

    Attributes:
        mean: Over the seeds.
        each: Of each seed.
        interval: Wilson's, 95 %, of the mean among as many scenes as one seed was judged on, for all see the same.
    """

    mean: float
    each: tuple[float, ...]
    interval: tuple[float, float]


def share(lines: Sequence[Line], field: str, scenes: str = "scenes") -> Share:
    """A field's share in measurements that differ in their seed only."""
    each = tuple(float(line[field]) for line in lines)
    mean, count = sum(each) / len(each), int(lines[0][scenes])
    return Share(mean, each, wilson_of(mean, count))


def wilson_of(mean: float, count: int) -> tuple[float, float]:
    """The interval of a share of `count`, the nearest whole number of them."""
    return wilson(round(mean * count), count)


def grouped(lines: Sequence[Line]) -> dict[tuple[str, str], dict[int, list[Line]]]:
    """Relation and model to training scenes to the seeds' lines, in the order of NAMES, sizes increasing."""
    groups: dict[tuple[str, str], dict[int, list[Line]]] = {}
    for line in sorted(lines, key=_place):
        config = line["config"]
        groups.setdefault((config["relation"], config["model"]), {}).setdefault(config["samples"], []).append(line)
    return groups


def failures(lines: Sequence[Line], judge: str) -> dict[str, float]:
    """Failure type to its share, the mean over the seeds."""
    names = dict.fromkeys(name for line in lines for name in line[FAILURES[judge]])
    return {name: sum(line[FAILURES[judge]].get(name, 0.0) for line in lines) / len(lines) for name in names}


def feasible(lines: Sequence[Line], relation: str) -> float:
    """The share of scenes in which any model or the data's maker found a placement, at least."""
    return max(line["feasible"] for line in lines if line["config"]["relation"] == relation)


def blind(lines: Sequence[Line], relation: str, judge: str) -> float | None:
    """The blind ceiling by an oracle on boxes, None where it was not measured."""
    field = f"blind_{judge}"
    found = [line[field] for line in lines if line["config"]["relation"] == relation and field in line]
    return max(found, default=None)


def rows(figure: str, lines: Sequence[Line]) -> list[dict[str, object]]:
    """A figure's table, at least one row."""
    return [
        {"relation": relation, "model": model, "samples": samples, "seeds": len(same), **_CELLS[figure](same)}
        for (relation, model), sizes in grouped(lines).items()
        for samples, same in sizes.items()
    ]


def _accuracy(lines: Sequence[Line]) -> dict[str, object]:
    return {
        name: cell for split in ("train", "test") for name, cell in _cells(split, lines, f"{split}_scenes").items()
    } | {"scenes": lines[0]["test_scenes"]}


def _success(lines: Sequence[Line]) -> dict[str, object]:
    judges = [judge for judge in (*JUDGES, PUBLISHED_ORACLE) if judge in lines[0]]
    cells = {name: cell for judge in judges for name, cell in _cells(judge, lines, "scenes").items()}
    if "blind_mca" in lines[0]:
        cells["blind"] = f"{lines[0]['blind_mca']:.3f} / {lines[0]['blind_published']:.3f}"
    return cells | {"feasible": f"{lines[0]['feasible']:.3f}", "scenes": lines[0]["scenes"]}


def _failing(lines: Sequence[Line]) -> dict[str, object]:
    cells: dict[str, object] = {}
    for judge in JUDGES:
        cells[judge] = ", ".join(f"{name} {number:.3f}" for name, number in sorted(failures(lines, judge).items()))
    return cells | {"scenes": lines[0]["scenes"]}


def _times(lines: Sequence[Line]) -> dict[str, object]:
    (line,) = lines
    fields = [f"{what}_{count}" for what in ("propose", "classify") for count in BATCHES]
    return {f"{field} [ms]": "-" if line[f"{field}_ms"] is None else f"{line[f'{field}_ms']:.3g}" for field in fields}


def _cells(field: str, lines: Sequence[Line], scenes: str) -> dict[str, object]:
    one = share(lines, field, scenes)
    return {
        field: f"{one.mean:.3f} [{one.interval[0]:.3f}, {one.interval[1]:.3f}]",
        f"{field} of seeds": f"{min(one.each):.3f}-{max(one.each):.3f}" if len(one.each) > 1 else "",
    }


def _place(line: Line) -> tuple[int, int, int, int]:
    config = line["config"]
    return RELATIONS.index(config["relation"]), NAMES.index(config["model"]), config["samples"], config["seed"]


_CELLS = {"fig4": _accuracy, "fig5": _success, "fig6": _failing, "fig7": _times}
