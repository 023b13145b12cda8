from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tamp.plan.open import PlanBundle, open_plan
from tamp.view.document import page_document
from tamp.view.samples import sample_markers
from tamp.view.story import planning_summary
from tamp.view.timeline import Timeline, timeline_of
from tests.view.browser import program

# Where no browser is installed, what needs one is left out; the other files test what goes into the page.
collect_ignore = [] if program() else ["test_in_browser.py"]


@pytest.fixture(scope="session")
def stored(stored_plan: Path) -> PlanBundle:
    return open_plan(stored_plan)


@pytest.fixture(scope="session")
def timeline(stored: PlanBundle) -> Timeline:
    return timeline_of(stored.loaded.scene, stored.robot, stored.plan)


@pytest.fixture(scope="session")
def document(stored: PlanBundle, timeline: Timeline) -> dict[str, Any]:
    return page_document(
        timeline, planning_summary(stored.document), sample_markers(stored.document, timeline.scene)
    )
