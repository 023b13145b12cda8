"""Causes why there is no plan, as data: the sentence that a user reads, its kind and objects."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from enum import Enum


class CauseKind(Enum):
    """The kinds of causes; code decides by these, never by words. The values stand in files."""

    UNREACHABLE = "unreachable"
    """A fact of the goal, or one that it needs, that nothing makes true."""
    EXCLUSIVE = "exclusive"
    """Parts of the goal, each of which excludes the others."""
    FORBIDDEN = "forbidden"
    """An action that facts forbid which stay as they are."""
    NO_VALUE = "no-value"
    """A call of a stream that ended without a value."""
    ENDLESS = "endless"
    """A call of a stream that did not end."""
    FAILED = "failed"
    """A step of plans, or a kind of calls, that failed whenever it was tried, or mostly."""
    IN_THE_WAY = "in-the-way"
    """Objects that were hit, or that blocked a way."""
    CONTRADICTED = "contradicted"
    """A classifier that says otherwise of a pose than when the pose was drawn."""
    REFUTED = "refuted"
    """A plan that did not hold when it was replayed."""
    SEARCHED = "searched"
    """Nothing more than that all was searched, or that nothing was tried yet."""


@dataclass(frozen=True, slots=True)
class Cause:
    """One cause why there is no plan.

    Attributes:
        text: A sentence without a full stop; fit for users, and for nothing else.
        kind: What it is.
        objects: The problem's objects that it is about, by the names that PDDL has for them.
    """

    text: str
    kind: CauseKind
    objects: tuple[str, ...] = ()

    def document(self) -> dict[str, object]:
        """Return the same for programs, as `--json` has it."""
        return {"kind": self.kind.value, "text": self.text, "objects": list(self.objects)}


def distinct_causes(causes: Iterable[Cause]) -> tuple[Cause, ...]:
    """Return the causes in order, those with the same text as one that has the objects of all."""
    found: dict[str, Cause] = {}
    for cause in causes:
        first = found.setdefault(cause.text, cause)
        objects = tuple(dict.fromkeys((*first.objects, *cause.objects)))
        found[cause.text] = replace(first, objects=objects)
    return tuple(found.values())


def named_objects(words: Iterable[str], names: Collection[str]) -> tuple[str, ...]:
    """Return the words that are among names of objects, each once and in order.

    Args:
        words: Terms of facts, inputs of calls, names of bodies as a scene writes them.
        names: As PDDL has them, in lower case.
    """
    return tuple(dict.fromkeys(word.lower() for word in words if word.lower() in names))
