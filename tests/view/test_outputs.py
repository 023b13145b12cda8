"""What a user asks to be shown is checked before time is spent."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.view.outputs import MOST_PIXELS, OutputRequest, check_page


def test_what_is_wanted(tmp_path: Path) -> None:
    nothing = OutputRequest()
    assert not nothing.any and not nothing.page
    assert OutputRequest(view=True).page and OutputRequest(html=tmp_path / "a.html").page
    picture = OutputRequest(png=tmp_path / "a.png")
    assert picture.any and not picture.page
    assert picture.outputs == {"--html": None, "--png": tmp_path / "a.png", "--video": None}


@pytest.mark.parametrize(
    ("request_", "words"),
    [
        (OutputRequest(png=Path("a.jpg")), "a picture is written as .png"),
        (
            OutputRequest(video=Path("a.mp4")),
            "no moving picture is written as '.mp4'.*Choices: .gif, .webp",
        ),
        (OutputRequest(video=Path("movie")), "no moving picture is written as 'movie'"),
        (OutputRequest(at=(1.0, -0.5)), "--at: -0.5 is no time in a plan"),
        (OutputRequest(at=(math.inf,)), "--at: inf is no time in a plan"),
        (OutputRequest(at=(math.nan,)), "--at: nan is no time in a plan"),
        (OutputRequest(speed=0.0), "--speed: 0 is not between 0 and 1000"),
        (OutputRequest(speed=1001.0), "--speed: 1001 is not between"),
        (OutputRequest(speed=math.nan), "--speed: nan is not between"),
        (OutputRequest(size=(15, 100)), "--size: 15x100 is not between 16x16 and 4096x4096"),
        (OutputRequest(size=(100, MOST_PIXELS + 1)), "--size: 100x4097 is not between"),
        (OutputRequest(png=Path("a.png"), html=Path("./a.png")), "--html.*--png|--png.*--html"),
    ],
)
def test_what_cannot_be_done_is_refused(
    request_: OutputRequest, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match=words):
        request_.check()
    assert list(tmp_path.iterdir()) == []


def test_a_page_goes_over_pages_only(tmp_path: Path) -> None:
    log, page, named = tmp_path / "runs.jsonl", tmp_path / "page", tmp_path / "old.html"
    log.write_text('{"seed": 1}\n', encoding="utf-8")
    page.write_text("<!DOCTYPE html>\n<html>", encoding="utf-8")
    named.write_text("to be filled", encoding="utf-8")
    with pytest.raises(InputError, match=r"runs\.jsonl: it is there already, and no page"):
        check_page(log)
    for file in (page, named, tmp_path / "new", tmp_path / "new.html"):
        check_page(file)
    (tmp_path / "empty").touch()
    check_page(tmp_path / "empty")


def test_limits_themselves_are_fine(tmp_path: Path) -> None:
    OutputRequest(
        png=tmp_path / "A.PNG",
        video=tmp_path / "b.GIF",
        at=(0.0, 1e9),
        speed=1000.0,
        size=(16, MOST_PIXELS),
    ).check()
