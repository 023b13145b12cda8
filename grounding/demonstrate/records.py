"""The records of a session, as the page shows them: counts, cards, hints."""

from __future__ import annotations

import re
from typing import Any

from grounding.demonstrate.folder import Card, DemonstrationFolder
from grounding.demonstrate.hints import hints, next_step
from grounding.demonstrate.relation import KINDS, PRESETS, DemonstratedRelation, parse_relation
from grounding.demonstrate.use import Uses


def records(
    relation: DemonstratedRelation, folder: DemonstrationFolder, uses: Uses
) -> dict[str, Any]:
    """Describe a relation and its demonstrations for the page."""
    cards = folder.cards()
    shown = [one for card in cards for one in card.demonstrations]
    holding = sum(one.holds for one in shown)

    return {
        "relation": {
            "text": str(relation),
            "name": relation.name,
            "meaning": relation.meaning,
            "arguments": [{"name": one.name, "kind": one.kind} for one in relation.arguments],
        },
        "presets": [
            {"text": str(parse_relation(text)), "meaning": said} for text, said in PRESETS.items()
        ],
        "kinds": list(KINDS),
        "folder": str(folder.path),
        "cards": [_card(card) for card in cards],
        "holding": holding,
        "other": len(shown) - holding,
        "hints": [
            {"kind": one.kind, "text": one.text, "files": list(one.files)}
            for one in hints(relation, shown)
        ],
        "todo": next_step(relation, shown),
        "restorable": folder.restorable,
        "commands": uses.commands,
        "learned": uses.weights.is_file(),
    }


def in_arguments(text: str, relation: DemonstratedRelation, folder: DemonstrationFolder) -> str:
    """Return what tamp-learn said with the relation's arguments in the place of the bodies of the
    first demonstration, which it says them of: "gap to b" for "gap to blue_can".
    """
    shown = folder.demonstrations()
    if not shown or len(shown[0].arguments) != len(relation.arguments):
        return text
    names = {
        name: one.name for name, one in zip(shown[0].arguments, relation.arguments, strict=True)
    }
    words = re.compile(rf"\b({'|'.join(map(re.escape, names))})\b")
    return "\n".join(
        words.sub(lambda word: names[word[1]], line)
        if line.startswith(("  ", "missing:"))
        else line
        for line in text.split("\n")
    )


def _card(card: Card) -> dict[str, Any]:
    return {
        "name": card.name,
        "labels": [label.holds for label in card.labels],
        "error": card.error,
        "stamp": f"{card.stamp[0]}-{card.stamp[1]}",
    }
