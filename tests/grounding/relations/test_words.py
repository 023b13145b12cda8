"""A learned relation in words."""

from __future__ import annotations

from grounding.relations.learner import Learned
from grounding.relations.words import explanations


def test_what_was_learned_is_said_in_words(learned: Learned) -> None:
    said = explanations(learned.committee, ("cup", "plate"))
    assert any("gap left of plate seen from the front" in one for one in said)
    assert all(one.endswith("turned as you like") for one in said) and 1 <= len(said) <= 3
    assert learned.held_out is not None and learned.held_out.mean > 0.85 and not learned.cannot_tell
