"""The figures, as in the paper, with matplotlib."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from benchmarks.groundings.case import DEPARTED, GENERATORS, on_clouds
from benchmarks.groundings.measure import BATCHES
from benchmarks.groundings.summary import JUDGES, PUBLISHED_ORACLE, Share, blind, failures, feasible, grouped, share
from benchmarks.paper_ways import PUBLISHED
from grounding.registry import TRAINING_VARIANTS
from tamp.benchmark.picture import COLOURS, STYLES
from tamp.errors import InputError
from tamp.system.distribution import install_command

Line = Mapping[str, Any]

TITLES = {
    "mca": "MCA, the paper's oracle",
    "settled": "settled in physics",
    PUBLISHED_ORACLE: "the published oracle, 3 cm",
}

SHADES = {
    "holds": "#228833",
    "collides": "#ccbb44",
    "tips over": "#aa3377",
    "penetrates support": "#994455",
    "outside but overlapping": "#66ccee",
    "outside": "#4477aa",
    "too high": "#ee6677",
    "too low": "#882233",
    "nothing proposed": "#bbbbbb",
}
"""Of a bar of figure 6, from success to what is farthest from it."""


def draw(figure: str, lines: Sequence[Line], folder: Path, layout: str = "household") -> Path:
    """Write FIGURE_groundings.png, or FIGURE_groundings_paper.png.

    Args:
        figure: One of FIGURES.
        lines: Its measurements, at least one.
        folder: Where; it is made.
        layout: Of the scenes. In the paper's the figures that its text tells stand beside ours.

    Raises:
        InputError: matplotlib is missing.
    """
    try:
        import matplotlib
    except ImportError:
        raise InputError("pictures need matplotlib", remedy=install_command("bench")) from None
    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    relations = list(dict.fromkeys(relation for relation, _ in grouped(lines)))
    sheet = Figure(layout="constrained")
    if figure == "fig5" and layout == "paper":
        _success(sheet, lines, relations, (PUBLISHED_ORACLE, "settled"))
        _published(sheet, relations)
    else:
        _DRAWN[figure](sheet, lines, relations)
    sheet.suptitle(_note(lines), fontsize=9 if len(relations) > 1 else 7)
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{figure}_groundings{'' if layout == 'household' else f'_{layout}'}.png"
    sheet.savefig(path, dpi=100)
    return path


def _accuracy(sheet: Any, lines: Sequence[Line], relations: list[str]) -> None:
    """Figure 4."""
    panels = _panels(sheet, len(relations), 1, (8.0, 2.9))
    groups = grouped(lines)
    for (axes,), relation in zip(panels, relations, strict=True):
        models = [model for name, model in groups if name == relation]
        for side, (split, alpha) in enumerate((("train", 0.45), ("test", 1.0))):
            found = [share(_whole(groups[relation, model]), split, f"{split}_scenes") for model in models]
            places = [place + 0.4 * (side - 0.5) for place in range(len(models))]
            colours = [_style(model)["color"] for model in models]
            axes.bar(places, [one.mean for one in found], 0.38, color=colours, alpha=alpha)
            _errors(axes, places, found)
        axes.set_xticks(range(len(models)), models)
        axes.tick_params(axis="x", labelsize=8)
        axes.set_ylim(0.5, 1.01)
        axes.set_ylabel("accuracy")
        axes.set_title(f"{relation}: training (pale) and test scenes")


def _success(sheet: Any, lines: Sequence[Line], relations: list[str], judges: Sequence[str] = JUDGES) -> None:
    """Figure 5."""
    panels = _panels(sheet, len(judges), len(relations), (5.2, 3.6))
    for judge, row in zip(judges, panels, strict=True):
        for axes, relation in zip(row, relations, strict=True):
            _curves(axes, lines, relation, judge)
            axes.set_title(f"{relation}: {TITLES[judge]}")
            axes.set_ylim(-0.02, 1.02)
    for axes in panels[-1]:
        axes.set_xlabel("training scenes")
    _legend(sheet, [axes for row in panels for axes in row], 3 * len(relations))


def _published(sheet: Any, relations: list[str]) -> None:
    """Put the paper's figures among ours, which are in the first row of panels, as diamonds."""
    for axes, relation in zip(sheet.axes, relations, strict=False):
        for (name, model), figures in PUBLISHED.items():
            if name == relation:
                axes.plot([*figures], [*figures.values()], "D", mfc="none", markersize=7, color=_style(model)["color"])


def _curves(axes: Any, lines: Sequence[Line], relation: str, judge: str) -> None:
    groups = {model: sizes for (name, model), sizes in grouped(lines).items() if name == relation}
    axes.axhline(feasible(lines, relation), color="black", linewidth=0.8, linestyle=":", label="feasible")
    ceiling = blind(lines, relation, judge)
    if ceiling is not None:
        axes.axhline(ceiling, color="black", linewidth=0.8, linestyle="--", label="blind ceiling")
    for model, sizes in groups.items():
        places, found = [*sizes], [share(same, judge) for same in sizes.values()]
        if places == [0]:  # not trained
            axes.axhline(found[0].mean, label=model, linewidth=1.0, **_style(model))
            continue
        axes.plot(places, [one.mean for one in found], label=model, marker=".", linewidth=1.2, **_style(model))
        _errors(axes, places, found, _style(model)["color"])
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:,.0f}")


def _failures(sheet: Any, lines: Sequence[Line], relations: list[str]) -> None:
    """Figure 6."""
    panels = _panels(sheet, len(JUDGES), len(relations), (5.4, 3.9))
    groups = grouped(lines)
    for judge, row in zip(JUDGES, panels, strict=True):
        for axes, relation in zip(row, relations, strict=True):
            models = [model for name, model in groups if name == relation]
            left = [0.0] * len(models)
            parts = [_shares(_whole(groups[relation, model]), judge) for model in models]
            for name, colour in SHADES.items():
                widths = [part.get(name, 0.0) for part in parts]
                if any(widths):
                    axes.barh(models, widths, left=left, color=colour, label=name, height=0.75)
                left = [before + width for before, width in zip(left, widths, strict=True)]
            axes.invert_yaxis()
            axes.set_xlim(0, 1)
            axes.tick_params(axis="y", labelsize=8)
            axes.set_title(f"{relation}: {TITLES[judge]}")
    _legend(sheet, [axes for row in panels for axes in row], 5)


def _times(sheet: Any, lines: Sequence[Line], relations: list[str]) -> None:
    """Figure 7."""
    panels = _panels(sheet, len(relations), 2, (5.4, 3.2))
    groups = grouped(lines)
    for row, relation in zip(panels, relations, strict=True):
        for axes, what in zip(row, ("propose", "classify"), strict=True):
            models = [model for name, model in groups if name == relation]
            times = {model: _whole(groups[relation, model])[0] for model in models}
            models = [model for model in models if times[model][f"{what}_{BATCHES[0]}_ms"] is not None]
            colours = [_style(model)["color"] for model in models]
            for side, (count, alpha) in enumerate(zip(BATCHES, (1.0, 0.45), strict=True)):
                places = [place + 0.4 * (side - 0.5) for place in range(len(models))]
                found = [times[model][f"{what}_{count}_ms"] for model in models]
                axes.barh(places, found, 0.38, color=colours, alpha=alpha)
            axes.set_yticks(range(len(models)), models)
            axes.invert_yaxis()
            axes.tick_params(axis="y", labelsize=8)
            axes.set_xscale("log")
            axes.xaxis.set_major_formatter("{x:g}")
            axes.xaxis.set_minor_formatter("")
            axes.set_xlabel("ms for a batch of 1, and (pale) of 64")
            axes.set_title(f"{relation}: {'generators' if what == 'propose' else 'classifiers'}")


def _panels(sheet: Any, rows: int, columns: int, size: tuple[float, float]) -> list[list[Any]]:
    """Axes by row and column, each of this size in inches."""
    sheet.set_size_inches(size[0] * columns, size[1] * rows)
    panels = sheet.subplots(rows, columns, squeeze=False).tolist()
    for axes in (axes for row in panels for axes in row):
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(alpha=0.3)
        axes.set_axisbelow(True)
    return panels


def _errors(axes: Any, places: Sequence[float], found: Sequence[Share], colour: str = "black") -> None:
    """Wilson's intervals, and a dot for each of several seeds."""
    low = [max(0.0, one.mean - one.interval[0]) for one in found]
    high = [max(0.0, one.interval[1] - one.mean) for one in found]
    axes.errorbar(places, [one.mean for one in found], [low, high], fmt="none", ecolor=colour, capsize=2, linewidth=0.8)
    for place, one in zip(places, found, strict=True):
        if len(one.each) > 1:
            axes.plot([place] * len(one.each), one.each, "o", color="black", markersize=1.5, alpha=0.6)


def _legend(sheet: Any, panels: Sequence[Any], columns: int) -> None:
    """One for all panels."""
    labels: dict[str, Any] = {}
    for axes in panels:
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
            labels.setdefault(label, handle)
    sheet.legend(list(labels.values()), list(labels), loc="outside lower center", ncols=columns, frameon=False)


def _style(model: str) -> dict[str, str]:
    """The same model looks the same everywhere."""
    index = [*reversed(GENERATORS), *TRAINING_VARIANTS, *DEPARTED].index(model)
    return {"color": COLOURS[index % len(COLOURS)], "linestyle": STYLES[index // len(COLOURS)]}


def _whole(sizes: Mapping[int, list[Line]]) -> list[Line]:
    """The lines of the largest training set."""
    return sizes[max(sizes)]


def _shares(lines: Sequence[Line], judge: str) -> dict[str, float]:
    return {"holds": share(lines, judge).mean, **failures(lines, judge)}


def _note(lines: Sequence[Line]) -> str:
    """On how many scenes and trainings it rests."""
    counts = {cloud: set[int]() for cloud in (False, True)}
    for line in lines:
        counts[on_clouds(line["config"]["model"])].add(line["config"]["scenes"])
    shown = {cloud: ", ".join(str(count) for count in sorted(found)) for cloud, found in counts.items() if found}
    clouds = f" ({shown[True]} for models on clouds)" if False in shown and True in shown else ""
    seeds = 1 + max(line["config"]["seed"] for line in lines)
    trainings = f"; up to {seeds} trainings, a dot each; bars: Wilson, 95 %" if seeds > 1 else ""
    return f"{shown.get(False, shown.get(True))} scenes{clouds}{trainings}"


_DRAWN: Mapping[str, Callable[[Any, Sequence[Line], list[str]], None]] = {
    "fig4": _accuracy,
    "fig5": _success,
    "fig6": _failures,
    "fig7": _times,
}
