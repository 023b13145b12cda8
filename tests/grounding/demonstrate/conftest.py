from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from grounding.demonstrate.folder import SceneSource
from grounding.demonstrate.relation import parse_relation
from grounding.demonstrate.runner import Runner
from grounding.demonstrate.studio import Studio
from grounding.demonstrate.workbench import Workbench
from tests.view.browser import program

# Where no browser is installed, what needs one is left out; the other files test what the page asks of the server.
collect_ignore = [] if program() else ["test_in_browser.py"]


@pytest.fixture(scope="session")
def workbench() -> Iterator[Workbench]:
    with Workbench() as opened:
        yield opened


@pytest.fixture
def runner() -> Iterator[Runner]:
    with Runner() as opened:
        yield opened


@pytest.fixture
def studio_of(tmp_path: Path, workbench: Workbench, runner: Runner) -> Callable[..., Studio]:
    """Makes a studio of a relation, its demonstrations in tmp_path / "shown"."""

    def made(text: str, scene: Path | None = None, seed: int = 0, out: str = "shown") -> Studio:
        return Studio(
            parse_relation(text), SceneSource(scene, tmp_path / out), workbench, runner, seed
        )

    return made
