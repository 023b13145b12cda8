"""A plan file of the least that one may have."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.plan.making import DOCUMENT


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "plan.json"
    path.write_text(json.dumps(DOCUMENT))
    return path
