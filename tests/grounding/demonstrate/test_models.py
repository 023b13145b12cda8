"""Bodies to show relations with: every kind has some, and a hand can hold them."""

from __future__ import annotations

from grounding.demonstrate.models import MODELS, sample_body
from grounding.demonstrate.relation import (
    KINDS,
)


def test_every_kind_but_surfaces_has_bodies(rng) -> None:
    for kind in KINDS[:-1]:
        chosen, entry = sample_body(kind, rng)
        assert chosen in MODELS and entry
