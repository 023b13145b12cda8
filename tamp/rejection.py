"""Why a stream's try gave nothing."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Rejection:
    """One try of a stream that produced no value.

    Attributes:
        reason: In a few words, fit to be counted and printed: "out of reach", "hits cereal".
        blockers: Objects whose present fluent facts caused it, by name; the search learns to move them first.
            Empty when nothing that could be moved is to blame.
        given_up: Whether the stream ends here without having tried everything: that it ended then proves nothing.
    """

    reason: str
    blockers: tuple[str, ...] = ()
    given_up: bool = False
