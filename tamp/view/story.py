"""Summary of how a plan was found, for a panel: what was searched, which streams were asked, where
the time went.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tamp.system.json_fields import Field

MOST = 40
"""Skeletons that are told of."""


COUNTS = {
    "skeletons": ("skeleton", "skeletons"),
    "searches": ("search", "searches"),
    "expanded": ("state expanded", "states expanded"),
}
"""What is counted, and what one and several of it are called."""


@dataclass(frozen=True)
class PlanningSummary:
    """Texts, ready to be shown.

    Attributes:
        head: One line about the whole.
        why: Why there is no plan, a line a cause.
        skeletons: Of each sequence of actions that was tried a line, and more lines about it.
        search: One line.
        streams: Name, why it refused, calls, values kept, seconds.
        time: Part, a note, seconds.
    """

    head: str
    why: tuple[str, ...] = ()
    skeletons: tuple[tuple[str, tuple[str, ...]], ...] = ()
    search: str = ""
    streams: tuple[tuple[str, str, str, str, str], ...] = ()
    time: tuple[tuple[str, str, str], ...] = ()


def planning_summary(document: Mapping[str, Any], file: Path | None = None) -> PlanningSummary:
    """Summarize what a plan file, or the summary of a run that found no plan, tells of the run.

    Args:
        document: Their content.
        file: Where it was read, for errors.

    Raises:
        InputError: Something in it is not what the format says.
    """
    root = Field(dict(document), "", file)
    statistics, timing, record = root.get("statistics"), root.get("timing"), root.get("record")
    seconds = (
        {} if timing is None else {name: part.number(0.0) for name, part in timing.fields().items()}
    )
    if statistics is None:
        return PlanningSummary(_head(root, seconds))
    numbers = statistics.fields()
    streams = numbers["streams"].fields() if "streams" in numbers else {}
    counts = [
        (words, numbers[name].number(0.0)) for name, words in COUNTS.items() if name in numbers
    ]
    texts = [f"{count:,.0f} {words[0] if count == 1 else words[1]}" for words, count in counts]

    return PlanningSummary(
        head=_head(root, seconds),
        why=tuple(
            line.text() for line in (root["explanation"].items() if "explanation" in root else ())
        ),
        skeletons=()
        if record is None
        else tuple(_skeleton(item) for item in record["skeletons"].items()[:MOST]),
        search=" · ".join(texts),
        streams=tuple(
            _stream(name, field, seconds.get(name, 0.0))
            for name, field in streams.items()
            if _asked(field)
        ),
        time=tuple(
            (name, "", f"{spent:.3f}") for name, spent in seconds.items() if name not in streams
        ),
    )


def _head(root: Field, seconds: Mapping[str, float]) -> str:
    took = f" in {seconds['total']:.2f} s" if "total" in seconds else ""
    seed = f" · seed {root['seed'].number():.0f}" if "seed" in root else ""
    if "message" in root and root["outcome"].text() != "solved":
        return f"{root['message'].text()}{took.replace(' in ', ' · ')}{seed}"
    count, moving = len(root["actions"].items()), root["duration"].number(0.0)
    return f"{count} action{'' if count == 1 else 's'}, {moving:.1f} s of motion, found{took}{seed}"


def _skeleton(field: Field) -> tuple[str, tuple[str, ...]]:
    actions = [action.text() for action in field["actions"].items()]
    rounds = int(field["rounds"].number(0.0))
    failed = f"failed {rounds} time{'' if rounds == 1 else 's'}" if rounds else ""
    became = "became the plan" if field["bound"].value is True else ""
    verdict = ", then ".join(text for text in (failed, became) if text) or "not finished"
    lines = [f"{number}. {action}" for number, action in enumerate(actions, start=1)]
    lines += [failure.text() for failure in field["failures"].items()]
    return f"{len(actions)} actions: {verdict}", tuple(lines)


def _asked(field: Field) -> bool:
    return field["calls"].number(0.0) > 0


def _stream(name: str, field: Field, seconds: float) -> tuple[str, str, str, str, str]:
    calls, kept = field["calls"].number(0.0), field["successes"].number(0.0)
    refusals = field.get("rejections")
    reasons = (
        {}
        if refusals is None
        else {reason: count.number() for reason, count in refusals.fields().items()}
    )
    most = sorted(reasons.items(), key=lambda pair: -pair[1])[:3]
    note = ", ".join(f"{count:.0f} {reason}" for reason, count in most)
    return name, note, f"{calls:,.0f}", f"{100 * kept / calls:.0f} %", f"{seconds:.2f} s"
