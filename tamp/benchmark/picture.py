"""Pictures of results: the only place that draws, with matplotlib (the extra `bench`)."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from tamp.benchmark.summary import Summary, summaries, times
from tamp.benchmark.table import short
from tamp.errors import InputError
from tamp.system.distribution import install_command
from tamp.system.outputs import write_whole

COLOURS = (
    "#4477aa",
    "#ee6677",
    "#228833",
    "#aa3377",
    "#ccbb44",
    "#66ccee",
    "#777777",
    "#994455",
    "#225522",
    "#000000",
)
"""Paul Tol's bright ones, and darker ones after them: told apart by the colour-blind as well."""

STYLES = ("-", "--", ":")
"""The next one when the colours are used up."""

PANEL = (4.6, 3.6)
"""Inches of one problem's picture."""

LEGEND = 1.9
"""Inches more for the legend."""

PER_ROW = 3


def draw(lines: Sequence[Mapping[str, Any]], folder: Path) -> list[Path]:
    """Write success.png, ecdf.png, cactus.png and parts.png, one panel a problem.

    Args:
        lines: Results of one budget and algorithm, at least one.
        folder: Where; it is made.

    Raises:
        InputError: matplotlib is missing, or the folder cannot be written.
    """
    try:
        import matplotlib
    except ImportError:
        raise InputError("pictures need matplotlib", remedy=install_command("bench")) from None
    matplotlib.use("Agg")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        written: list[Path] = []
        for name, picture in PICTURES.items():
            sheet = _Sheet(lines)
            picture(sheet)
            written.append(sheet.save(folder / f"{name}.png"))
    except OSError as error:
        raise InputError(f"the pictures cannot be written: {error.strerror}", file=folder) from None
    return written


class _Sheet:
    """A figure with a panel for each problem."""

    def __init__(self, lines: Sequence[Mapping[str, Any]]) -> None:
        from matplotlib.figure import Figure

        self.lines = lines
        self.summaries = summaries(lines)
        self.budget = max(one.budget for one in self.summaries)
        self.problems = list(dict.fromkeys(one.problem for one in self.summaries))
        self.samplers = list(dict.fromkeys(one.sampler for one in self.summaries))
        columns = min(len(self.problems), PER_ROW)
        rows = math.ceil(len(self.problems) / columns)
        self._figure = Figure(figsize=(PANEL[0] * columns, PANEL[1] * rows), layout="constrained")
        self._axes = self._figure.subplots(rows, columns, squeeze=False).ravel().tolist()
        for axes in self._axes[len(self.problems) :]:
            axes.set_visible(False)

    def panels(self) -> Iterator[tuple[Any, str, list[Summary]]]:
        """Yield each problem's axes, with its summaries."""
        for axes, problem in zip(self._axes, self.problems, strict=False):
            axes.set_title(short(problem))
            axes.spines[["top", "right"]].set_visible(False)
            axes.grid(alpha=0.3)
            axes.set_axisbelow(True)
            yield axes, problem, [one for one in self.summaries if one.problem == problem]

    def of(self, one: Summary) -> list[float]:
        """Return a summary's times."""
        config = (one.problem, one.sampler)
        return times(
            line
            for line in self.lines
            if (line["config"]["problem"], line["config"]["sampler"]) == config
        )

    def style(self, sampler: str) -> dict[str, str]:
        """Return a sampler's style: the same one looks the same everywhere."""
        index = self.samplers.index(sampler)
        return {
            "color": COLOURS[index % len(COLOURS)],
            "linestyle": STYLES[index // len(COLOURS) % len(STYLES)],
        }

    def save(self, path: Path) -> Path:
        """Save the picture with one legend for all panels."""
        labels: dict[str, Any] = {}
        for axes in self._axes:
            for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
                labels.setdefault(label, handle)
        if labels:
            width, height = self._figure.get_size_inches()
            self._figure.set_size_inches(width + LEGEND, height)
            self._figure.legend(
                list(labels.values()), list(labels), loc="outside right center", frameon=False
            )
        content = io.BytesIO()
        self._figure.savefig(content, dpi=150, format="png")
        write_whole(path, content.getvalue())
        return path


def _success(sheet: _Sheet) -> None:
    """Plot the success rates with Wilson's intervals: the paper's figure 8."""
    for axes, _, found in sheet.panels():
        shares = [100 * one.solved / one.runs for one in found]
        low = [share - 100 * one.interval[0] for share, one in zip(shares, found, strict=True)]
        high = [100 * one.interval[1] - share for share, one in zip(shares, found, strict=True)]
        errors = [[max(0.0, error) for error in side] for side in (low, high)]
        places = range(len(found))
        axes.bar(
            places, shares, color=[sheet.style(one.sampler)["color"] for one in found], width=0.7
        )
        axes.errorbar(places, shares, errors, fmt="none", ecolor="black", capsize=3, linewidth=1)
        axes.set_xticks(
            places, [one.sampler for one in found], rotation=35, ha="right", rotation_mode="anchor"
        )
        axes.set_ylim(0, 102)
        axes.grid(axis="x", visible=False)
        axes.set_ylabel(f"solved in {sheet.budget:g} s [%]")


def _ecdf(sheet: _Sheet) -> None:
    """Plot the empirical distribution: how many runs are solved after how much time."""
    for axes, _, found in sheet.panels():
        for one in found:
            solved = [time for time in sheet.of(one) if math.isfinite(time)]
            shares = [100 * count / one.runs for count in range(len(solved) + 1)]
            start = solved[:1] or [sheet.budget]
            ends = [*start, *solved, max([sheet.budget, *solved])]
            axes.step(
                ends,
                [*shares, shares[-1]],
                where="post",
                label=one.sampler,
                **sheet.style(one.sampler),
            )
        axes.set_xscale("log")
        axes.set_ylim(0, 102)
        axes.set_xlabel("planning time [s]")
        axes.set_ylabel("solved [%]")


def _cactus(sheet: _Sheet) -> None:
    """Plot the cactus: in how much time each the quickest n runs are solved."""
    for axes, _, found in sheet.panels():
        for one in found:
            solved = [time for time in sheet.of(one) if math.isfinite(time)]
            places = range(1, len(solved) + 1)
            axes.plot(
                places,
                solved,
                label=one.sampler,
                marker=".",
                markersize=3,
                **sheet.style(one.sampler),
            )
        axes.set_yscale("log")
        axes.set_xlim(0, max(one.runs for one in found) + 0.5)
        axes.set_xlabel("runs solved")
        axes.set_ylabel("planning time [s]")


def _parts(sheet: _Sheet) -> None:
    """Plot the mean time of a run by what it is spent on."""
    told = [
        (part, seconds) for one in sheet.summaries for part, seconds in (one.parts or {}).items()
    ]
    parts = list(dict.fromkeys(part for part, seconds in told if seconds > 0.0))
    for axes, _, found in sheet.panels():
        places = range(len(found))
        bottom = [0.0] * len(found)
        for index, part in enumerate(parts):
            heights = [(one.parts or {}).get(part, 0.0) for one in found]
            axes.bar(
                places,
                heights,
                bottom=bottom,
                color=COLOURS[index % len(COLOURS)],
                width=0.7,
                label=part,
            )
            bottom = [low + height for low, height in zip(bottom, heights, strict=True)]

        axes.set_xticks(
            places, [one.sampler for one in found], rotation=35, ha="right", rotation_mode="anchor"
        )
        axes.grid(axis="x", visible=False)
        axes.set_ylabel("mean time of a run [s]")


PICTURES: dict[str, Callable[[_Sheet], None]] = {
    "success": _success,
    "ecdf": _ecdf,
    "cactus": _cactus,
    "parts": _parts,
}
"""What is drawn, by the file's name."""
