"""What tells a plan of a problem in PDDL alone from one with motions."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tamp.plan.symbolic import is_symbolic
from tests.plan.making import DOCUMENT


@pytest.mark.parametrize("content", [DOCUMENT, {}, {"format": "tamp-plan"}])
def test_other_documents_are_not_symbolic(content: dict, tmp_path: Path) -> None:
    assert not is_symbolic(content)
    (tmp_path / "list.json").write_text("[1]")
    assert not is_symbolic(tmp_path / "list.json")


def test_a_plan_in_pddl_alone_is_told_from_its_content_or_its_file(tmp_path: Path) -> None:
    symbolic = {"format": "tamp-symbolic-plan", "version": 1}
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(symbolic))
    assert is_symbolic(symbolic) and is_symbolic(file)
