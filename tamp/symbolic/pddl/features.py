"""Features of the larger PDDL levels, and of languages beside it, that are refused: each by its
name.
"""

from __future__ import annotations

from collections.abc import Iterable

FEATURES: dict[str, str] = {
    ":durative-action": "durative actions",
    ":duration": "durative actions",
    ":condition": "durative actions",
    ":process": "processes",
    ":event": "events",
    ":constraints": "trajectory constraints",
    ":preference": "preferences",
    ":goal-utilities": "goal utilities",
    ":utility": "goal utilities",
    ":goal-reward": "goal rewards",
    ":task": "hierarchical tasks",
    ":method": "hierarchical tasks",
    ":tasks": "hierarchical tasks",
    ":htn": "hierarchical tasks",
    ":observe": "sensing",
    ":sensing-action": "sensing",
    ":agent": "several agents",
    "preference": "preferences",
    "is-violated": "preferences",
    "total-time": "durations",
    "<": "numeric fluents",
    ">": "numeric fluents",
    "<=": "numeric fluents",
    ">=": "numeric fluents",
    "decrease": "numeric fluents",
    "assign": "numeric fluents",
    "scale-up": "numeric fluents",
    "scale-down": "numeric fluents",
    "probabilistic": "probabilistic effects",
    "oneof": "nondeterministic effects",
    "unknown": "incomplete initial states",
    "always": "trajectory constraints",
    "sometime": "trajectory constraints",
    "within": "trajectory constraints",
    "at-most-once": "trajectory constraints",
    "sometime-after": "trajectory constraints",
    "sometime-before": "trajectory constraints",
    "always-within": "trajectory constraints",
    "hold-during": "trajectory constraints",
    "hold-after": "trajectory constraints",
    "at": "durative actions and timed literals",
    "over": "durative actions",
}
"""Keyword or connective to the feature it belongs to; words that a domain declares as its own mean
what it says.
"""


def unsupported(word: str, written: str | None = None) -> str:
    """Say that a word's feature is not supported; `written` as the user wrote it."""
    return lacking(written or word, FEATURES[word])


def lacking(written: str, feature: str) -> str:
    """Say that what stands there is not supported, and which feature it is."""
    return f"'{written}' is not supported: tamp has no {feature}"


def sections(supported: Iterable[str]) -> tuple[str, ...]:
    """Return the keywords of features that are none of the known ones."""
    return tuple(word for word in FEATURES if word.startswith(":") and word not in supported)
