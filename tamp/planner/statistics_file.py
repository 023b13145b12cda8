"""Statistics of streams in earlier runs with a domain, kept in a file that the user names."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path

from tamp.errors import InputError
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.algorithms.experience.success_posterior import Posterior
from tamp.system.json_fields import Field, clipped
from tamp.system.outputs import locked_folder, write_whole
from tamp.system.reading import read_json

FORMAT, VERSION = "tamp-statistics", 1

MOST_BYTES = 4_000_000
"""The largest file of statistics that is read."""

REMEDY = "Name another file, or delete this one to begin anew"


def read_statistics(path: Path, domain: str) -> dict[str, Posterior]:
    """Read stream to what is known of it; nothing when there is no such file yet.

    Raises:
        InputError: The file cannot be read, is none of ours, or is about another domain.
    """
    if not path.exists():
        return {}
    try:
        root = Field(read_json(path, MOST_BYTES, kind="file of statistics"), "", path)
        if not isinstance(root.value, dict):
            raise root.wrong(f"it is no '{FORMAT}' file of version {VERSION}")
        if [found and found.value for found in (root.get("format"), root.get("version"))] != [
            FORMAT,
            VERSION,
        ]:
            raise root.wrong(f"it is no '{FORMAT}' file of version {VERSION}")
        if root["domain"].text() != domain:
            raise root.wrong(
                f"its statistics are of domain '{clipped(root['domain'].text())}', not '{domain}'"
            )
        return {name: _posterior(entry) for name, entry in root["streams"].fields().items()}
    except InputError as error:
        error.remedy = error.remedy or REMEDY
        raise error.at(path) from None


def add_statistics(
    path: Path, domain: str, ran: Mapping[str, StreamStatistics]
) -> dict[str, Posterior]:
    """Add what a run tells to what the file says by now, whole or not at all; returns the sum.

    Several runs may end at the same time: each waits for the others, and none is lost.

    Raises:
        InputError: The file cannot be written, or has become something else meanwhile.
    """
    try:
        with locked_folder(Path(os.path.realpath(path)).parent):
            total = read_statistics(path, domain)
            for name, one in ran.items():
                if one.calls:
                    added = Posterior(one.successes, one.calls - one.successes, one.seconds)
                    total[name] = total.get(name, Posterior()) + added
            streams = {name: _entry(one) for name, one in sorted(total.items())}
            document = {"format": FORMAT, "version": VERSION, "domain": domain, "streams": streams}
            write_whole(path, (json.dumps(document, indent=1) + "\n").encode())
    except OSError as error:
        raise InputError(f"cannot write the statistics: {error.strerror}", file=path) from error
    return total


def _entry(one: Posterior) -> dict[str, float]:
    seconds, mean = round(one.seconds, 6), round(one.mean, 6)
    return {"successes": one.successes, "failures": one.failures, "seconds": seconds, "mean": mean}


def _posterior(entry: Field) -> Posterior:
    counts = [entry[name].number(0.0) for name in ("successes", "failures")]
    for name, count in zip(("successes", "failures"), counts, strict=True):
        if count != int(count):
            raise entry[name].wrong(f"{count:g} is no whole number")
    return Posterior(int(counts[0]), int(counts[1]), entry["seconds"].number(0.0))
