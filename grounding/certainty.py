"""Significance of a trained classifier: one that does no better than chance must not pass for one
that knows.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Labels = NDArray[np.bool_]

ENOUGH = 100
"""Labels from which on a classifier is trusted at all."""

EACH = 5
"""Labels of each kind that it needs to have seen."""

MANY = 2000
"""Labels from which on the validation split of the training is judge enough."""

REASON = "cannot tell"
"""The card's key for why a grounding has no classifier yet."""


def cannot_tell(card: Mapping[str, Any]) -> str | None:
    """Return why weights have no classifier yet, by their card; None when they have one."""
    if card.get("classifies", True):
        return None
    return str(
        card.get(REASON) or f"it was trained on {card.get('samples', 'few')} labels; {_needed()}"
    )


def too_few(holds: Labels) -> str | None:
    """Return why labels are too few, or too unbalanced, to learn a classifier from; else None."""
    count, positive = len(holds), int(holds.sum())
    negative = count - positive
    if count >= ENOUGH and min(positive, negative) >= EACH:
        return None
    said = f"it was trained on {count} labels, {negative or 'none'} of them negative"
    if positive < min(EACH, negative):
        said = f"it was trained on {count} labels, {positive or 'none'} of them positive"
    return f"{said}; {_needed()}"


def no_better_than_chance(
    holds: Labels, fit: Callable[[NDArray[np.intp], NDArray[np.intp]], Labels]
) -> str | None:
    """Cross-validate a classifier in two folds; return why it knows no more than chance does, or
    None.

    The mean of both kinds' recall has to be two standard errors of guessing above a half.

    Args:
        holds: The labels, shape (n,).
        fit: Trains on the rows of its first argument, and returns what it says of those of the
            second one.
    """
    said = np.zeros(len(holds), dtype=bool)
    fold = np.zeros(len(holds), dtype=np.intp)
    for kind in (True, False):
        rows = np.flatnonzero(holds == kind)
        fold[rows] = np.arange(len(rows)) % 2
    for part in (0, 1):
        test = np.flatnonzero(fold == part)
        said[test] = fit(np.flatnonzero(fold != part), test)
    return chance(holds, said)


def chance(holds: Labels, said: Labels) -> str | None:
    """Test answers against chance; return why they are no better than guesses, or None. Both shape
    (n,).
    """
    if said.all() or not said.any():
        return f"it says {'yes' if said.all() else 'no'} to everything"
    recalls = (float(said[holds].mean()), float((~said[~holds]).mean()))
    error = 0.5 * math.sqrt(0.25 / max(holds.sum(), 1) + 0.25 / max((~holds).sum(), 1))
    if np.mean(recalls) > 0.5 + 2 * error:
        return None
    yes, no = (f"{100 * share:.0f} %" for share in recalls)
    return (
        f"it is no better than chance: right about {yes} of the positive labels "
        f"and {no} of the negative ones"
    )


def _needed() -> str:
    return f"a classifier needs {ENOUGH}, at least {EACH} of each kind"
