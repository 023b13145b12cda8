"""The outputs that a user asks for (page, picture, video), and how they are written."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tamp.errors import InputError
from tamp.system.outputs import check_outputs, check_writable
from tamp.view.video_formats import check_suffix

if TYPE_CHECKING:
    from tamp.view.story import PlanningSummary
    from tamp.view.timeline import Timeline

MOST_PIXELS = 4096
"""Columns or rows of a picture."""

MOST_BEFORE_HTML = 4096
"""Bytes in which the element of a page begins."""


@dataclass(frozen=True)
class OutputRequest:
    """A request for outputs: where a timeline is to be shown.

    Attributes:
        html: A page to write.
        png: A picture to write.
        video: A moving picture to write.
        view: Whether to open the page in a browser.
        at: Times of the pictures in the PNG, seconds; none for start, middle and end.
        size: Columns and rows of a picture; None for the usual.
        speed: Of the moving picture, times the robot's.
        port: To serve at, 0 for any.
        browser: Whether to open one, or only to serve.
    """

    html: Path | None = None
    png: Path | None = None
    video: Path | None = None
    view: bool = False
    at: tuple[float, ...] = ()
    size: tuple[int, int] | None = None
    speed: float = 6.0
    port: int = 0
    browser: bool = True

    @property
    def page(self) -> bool:
        """Check whether the page is wanted, with the samples that were tried."""
        return self.view or self.html is not None

    @property
    def outputs(self) -> dict[str, Path | None]:
        """Return the files to be written, by option."""
        return {"--html": self.html, "--png": self.png, "--video": self.video}

    @property
    def any(self) -> bool:
        """Check whether anything is wanted."""
        return self.page or self.png is not None or self.video is not None

    def check(self) -> None:
        """Refuse what cannot be done before time is spent.

        Raises:
            InputError: An output that cannot be written, an ending or a number that is not
                possible, no browser.
        """
        from tamp.view.server import check_browser

        for option, file in self.outputs.items():
            if file is not None:
                check_writable(file, option)
        check_outputs(self.outputs)
        if self.png is not None and self.png.suffix.lower() != ".png":
            raise InputError("a picture is written as .png", file=self.png)
        if self.video is not None:
            check_suffix(self.video)
        for time in self.at:
            if not 0.0 <= time < math.inf:
                raise InputError(f"--at: {time:g} is no time in a plan")
        if not 0.0 < self.speed <= 1000.0:
            raise InputError(f"--speed: {self.speed:g} is not between 0 and 1000")
        if self.size is not None and not all(16 <= side <= MOST_PIXELS for side in self.size):
            raise InputError(
                f"--size: {self.size[0]}x{self.size[1]} is not between "
                f"16x16 and {MOST_PIXELS}x{MOST_PIXELS}"
            )
        if self.view and self.browser:
            check_browser()


def check_page(page: Path) -> None:
    """Refuse to write a page over what is none.

    Raises:
        InputError: A file that neither holds a page nor is named as one.
    """
    if _is_of_others(page):
        raise InputError(
            "it is there already, and no page: --html would overwrite it",
            file=page,
            remedy="Choose another place with --html",
        )


def _is_of_others(file: Path) -> bool:
    """Check that a file holds what is no page, and is not named as one either."""
    if file.suffix.lower() in (".html", ".htm") or not file.is_file():
        return False
    with contextlib.suppress(OSError), file.open("rb") as stream:
        head = stream.read(MOST_BEFORE_HTML).lower()
        return bool(head.strip()) and b"<html" not in head
    return False


def write_outputs(
    request: OutputRequest,
    timeline: Timeline,
    story: PlanningSummary,
    document: Mapping[str, Any],
    file: Path | None,
    say: Callable[[str], None],
) -> None:
    """Show a timeline.

    Args:
        request: Where.
        timeline: What happens.
        story: How it was found.
        document: The plan file's content, for the samples.
        file: The plan file, for errors.
        say: Tells the user what was written.

    Raises:
        InputError: Something cannot be written or served, or the document is not what it should be.
    """
    from tamp.view.appearance import undrawable
    from tamp.view.document import page_document
    from tamp.view.page import page, write_page
    from tamp.view.picture import write_png, write_video
    from tamp.view.samples import sample_markers
    from tamp.view.server import serve

    for sentence in undrawable(timeline.scene.bodies.values()):
        say(f"warning: {sentence}.")
    if request.png is not None:
        write_png(timeline, request.png, request.at, request.size or (800, 600))
        say(f"{request.png} written.")
    if request.video is not None:
        cut = write_video(timeline, request.video, request.speed, request.size or (480, 360))
        say(f"{request.video} written{f', without {cut:,.0f} s of pauses' if cut else ''}.")
    if request.page:
        content = page_document(timeline, story, sample_markers(document, timeline.scene, file))
        if request.html is not None:
            write_page(content, request.html)
            say(f"{request.html} written: open it in any browser.")
        if request.view:
            serve(page(content).encode(), say, port=request.port, browser=request.browser)
