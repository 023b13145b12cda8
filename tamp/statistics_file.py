"""What streams did in earlier runs with a domain, kept in a file that the user names."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tamp.algorithms.posterior import Posterior
from tamp.algorithms.statistics import StreamStatistics
from tamp.data import write_whole
from tamp.errors import InputError

FORMAT, VERSION = "tamp-statistics", 1

REMEDY = "Name another file, or delete this one to begin anew"


def read_statistics(path: Path, domain: str) -> dict[str, Posterior]:
    """Stream to what is known of it; nothing when there is no such file yet.

    Raises:
        InputError: The file cannot be read, is none of ours, or is about another domain.
    """
    if not path.exists():
        return {}
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "it is not JSON"
        raise InputError(f"cannot read the statistics: {reason}", file=path, remedy=REMEDY) from error
    if not isinstance(document, dict) or (document.get("format"), document.get("version")) != (FORMAT, VERSION):
        raise InputError(f"it is no '{FORMAT}' file of version {VERSION}", file=path, remedy=REMEDY)
    if document.get("domain") != domain:
        raise InputError(
            f"its statistics are of domain '{document.get('domain')}', not '{domain}'", file=path, remedy=REMEDY
        )
    streams = document.get("streams")
    if not isinstance(streams, dict):
        raise InputError("it has no 'streams'", file=path, remedy=REMEDY)
    return {str(name): _posterior(path, str(name), entry) for name, entry in streams.items()}


def add_statistics(
    path: Path, domain: str, known: Mapping[str, Posterior], ran: Mapping[str, StreamStatistics]
) -> dict[str, Posterior]:
    """Write what was known and what a run adds to it, whole or not at all; returns the sum.

    Raises:
        InputError: The file cannot be written.
    """
    total = dict(known)
    for name, one in ran.items():
        if one.calls:
            added = Posterior(one.successes, one.calls - one.successes, one.seconds)
            total[name] = total.get(name, Posterior()) + added
    streams = {name: _entry(one) for name, one in sorted(total.items())}
    document = {"format": FORMAT, "version": VERSION, "domain": domain, "streams": streams}
    try:
        write_whole(path, (json.dumps(document, indent=1) + "\n").encode())
    except OSError as error:
        raise InputError(f"cannot write the statistics: {error.strerror}", file=path) from error
    return total


def _entry(one: Posterior) -> dict[str, float]:
    seconds, mean = round(one.seconds, 6), round(one.mean, 6)
    return {"successes": one.successes, "failures": one.failures, "seconds": seconds, "mean": mean}


def _posterior(path: Path, name: str, entry: Any) -> Posterior:
    match entry:
        case {"successes": int(successes), "failures": int(failures), "seconds": int(seconds) | float(seconds)}:
            if min(successes, failures, seconds) >= 0 and math.isfinite(seconds):
                return Posterior(int(successes), int(failures), float(seconds))
    raise InputError(f"stream '{name}' wants successes, failures (whole) and seconds", file=path, remedy=REMEDY)
