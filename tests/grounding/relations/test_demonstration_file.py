"""Demonstration files of any bodies: what they say, and what is wrong with them."""

from __future__ import annotations

from pathlib import Path

import pytest

from grounding.relations.demonstration_file import Label, demonstrations_of
from grounding.relations.demonstration_text import (
    demonstration_text,
)
from tamp.errors import InputError
from tests.grounding.relations.shown import everything


def test_robot_and_room_may_be_left_out(tmp_path: Path) -> None:
    path = tmp_path / "one.yaml"
    text = demonstration_text(everything(Label("alone", ("cup",), True)))
    path.write_text(
        "\n".join(line for line in text.splitlines() if not line.startswith(("robot", "room")))
    )
    assert [one.arguments for one in demonstrations_of("alone", [path])] == [("cup",)]


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        ("(near cup plate)", "one.yaml:11: the goal says nothing of 'stack'"),
        ("(stack cpu plate)", "one.yaml:11:14: unknown object 'cpu'"),
        ("(stack)", "names one to 6 bodies"),
        ("(stack (cup) plate)", "names one to 6 bodies"),
        ("(stack cup cup)", "'cup' stands twice"),
        ("(and (stack cup plate) (stack cup))", "has 1 arguments here, and 2 before"),
    ],
)
def test_what_is_wrong_is_said_with_its_line(goal: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "one.yaml"
    text = demonstration_text(everything(Label("stack", ("cup", "plate"), True)))
    path.write_text(text.replace("(stack cup plate)", goal))
    with pytest.raises(InputError) as found:
        list(demonstrations_of("stack", [path]))
    assert message in str(found.value)
