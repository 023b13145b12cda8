"""The errands with a van, in files where the command is run."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.planner.pddl_only.problem import SymbolicProblem, load_symbolic
from tests.planner.pddl_only.texts import DOMAIN, PROBLEM, SHOP, SHOPPING


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "d.pddl").write_text(DOMAIN, encoding="utf-8")
    (tmp_path / "p.pddl").write_text(PROBLEM, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def errands(files: Path) -> SymbolicProblem:
    return load_symbolic(files / "d.pddl", files / "p.pddl")


@pytest.fixture
def shopping(tmp_path: Path) -> SymbolicProblem:
    """Four things for three each, or for one each with a ticket for five: 9 at the least."""
    (tmp_path / "shop.pddl").write_text(SHOP, encoding="utf-8")
    (tmp_path / "shopping.pddl").write_text(SHOPPING, encoding="utf-8")
    return load_symbolic(tmp_path / "shop.pddl", tmp_path / "shopping.pddl")
