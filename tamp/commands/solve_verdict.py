"""The verdict of the independent judge on a new plan, and the last lines of tamp-solve."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tamp.geometric.scene.classifier import Classifier
    from tamp.verification.report import Report


def judge_text(text: str, classifiers: Mapping[str, Classifier] | None = None) -> Report:
    """Judge the text of a plan file that would be written.

    Args:
        text: The plan file's, JSON.
        classifiers: The user's own, by relation.
    """
    from tamp.verification.verify import verify  # it takes a while, and only some are judged

    return verify(json.loads(text), classifiers=classifiers or {})


def closing_lines(out: Path, written: Path | None, verdict: Report | None) -> Iterator[str]:
    """Say what the judge found, and where the plan is.

    Args:
        out: Where the plan was to be written.
        written: Where it is.
        verdict: The judge's, if it was asked.
    """
    if verdict is not None:
        yield f"\n{verdict.text()}"
    if written is not None:
        yield f"\n{written} written. Check it: tamp-verify {shlex.quote(str(written))}"
    elif verdict is not None:
        yield f"\n{out} not written: the plan does not hold."
