"""Classifiers, which answer whether a relation holds in a scene, and a guarded call of one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol, runtime_checkable

from tamp.geometric.scene.scene import Scene

LIKELY_PROBABILITY = 0.5
"""A relation holds when its classifier gives at least this probability."""


@runtime_checkable
class Classifier(Protocol):
    """Judges whether a relation holds in a scene."""

    def classify(self, scene: Scene, arguments: Sequence[str]) -> float:
        """Return the probability in [0, 1] that the relation holds for these arguments; not a
        number: it cannot tell.
        """
        ...


@runtime_checkable
class NoClassifier(Protocol):
    """A generator that has no classifier yet; `cannot_tell` says why."""

    cannot_tell: str


class Unanswered(Exception):
    """A classifier raised, or what it returned is no probability; the message says what, with "it"
    for its name.
    """


def probability(classifier: Classifier, scene: Scene, arguments: Sequence[str]) -> float:
    """Return the probability that a relation holds; not a number where the classifier cannot tell.

    Raises:
        Unanswered: The classifier raised, or returned something else.
    """
    try:
        number = float(classifier.classify(scene, tuple(arguments)))
    except (Exception, SystemExit) as error:
        text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise Unanswered(f"it raised {text}") from error
    if math.isinf(number) or not (math.isnan(number) or -1e-6 <= number <= 1 + 1e-6):
        raise Unanswered(f"it returned {number:g}, which is no probability")
    return number
