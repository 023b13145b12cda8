"""The examples are the documentation: each one runs, as a user would run it."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).resolve().parent.parent / "examples").glob("*.py"))


def test_examples_are_numbered_without_gaps() -> None:
    assert len(EXAMPLES) >= 3
    assert [example.name[:2] for example in EXAMPLES] == [
        f"{number:02}" for number in range(len(EXAMPLES))
    ]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.stem)
def test_example_runs(example: Path, tmp_path: Path) -> None:
    title = (ast.get_docstring(ast.parse(example.read_text(encoding="utf-8"))) or "").splitlines()[
        0
    ]
    assert title.endswith(".")
    run = subprocess.run(
        [sys.executable, str(example)], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stdout + run.stderr
    assert "solved" in run.stdout.lower()
