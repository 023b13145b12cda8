"""Moving pictures are known by their ending."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.view.video_formats import VIDEO_FORMATS, check_suffix


@pytest.mark.parametrize("name", ["a.gif", "a.webp", "a.b.WEBP"])
def test_moving_pictures_by_their_ending(name: str) -> None:
    check_suffix(Path(name))
    assert Path(name).suffix.lower() in VIDEO_FORMATS


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("a.mp4", "as '.mp4'. Choices: .gif, .webp"),
        ("gif", "as 'gif'"),
        ("a.gof", "Did you mean '.gif'"),
    ],
)
def test_other_endings_are_refused_with_the_choices(name: str, said: str) -> None:
    with pytest.raises(InputError, match=re.escape(said)):
        check_suffix(Path(name))
