"""Pictures of generated scenes: the arguments in the colours of their order."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import tamp.view.picture
from grounding.relations.picture import COLOURS, write_picture
from tamp.geometric.loading.bodies import COLOURS as RGBA
from tests.grounding.relations.shown import BODIES

THINGS = {name: BODIES[name] for name in ("desk", "cup", "plate")}


@pytest.fixture
def shown(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The timelines that are drawn."""
    drawn: list[Any] = []

    def draw(timeline: Any, file: Path) -> None:
        drawn.append(timeline)
        file.write_bytes(b"a picture")

    monkeypatch.setattr(tamp.view.picture, "write_png", draw)
    return drawn


def colours(timeline: Any) -> dict[str, Any]:
    return {name: body.colour for name, body in timeline.scene.bodies.items()}


def test_arguments_are_coloured_by_their_order_and_the_rest_as_it_is(
    shown: list[Any], tmp_path: Path
) -> None:
    for order in (("plate", "cup"), ("cup",)):
        write_picture(tmp_path / "new" / "one.png", THINGS, order, "near")
    assert (tmp_path / "new" / "one.png").read_bytes() == b"a picture"
    both, alone = (colours(timeline) for timeline in shown)
    assert COLOURS[:2] == ("orange", "blue")
    assert both["plate"][:3] == alone["cup"][:3] == RGBA["orange"]
    assert both["cup"][:3] == RGBA["blue"]
    assert alone["plate"][:3] == RGBA["grey"] and both["desk"] == alone["desk"]
    assert THINGS["cup"].shape["colour"] == "red"


def test_a_place_of_a_body_has_no_colour_but_its_turn(shown: list[Any], tmp_path: Path) -> None:
    write_picture(tmp_path / "one.png", THINGS, ("cup", "desk_top", "plate"), "between")
    (found,) = (colours(timeline) for timeline in shown)
    assert found["cup"][:3] == RGBA["orange"] and found["plate"][:3] == RGBA[COLOURS[2]]
    assert found["desk"][:3] == RGBA["wood"]
