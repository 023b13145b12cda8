"""docs/adding-a-predicate.md is run as it stands, from an empty folder to an executed plan."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parent.parent / "docs" / "adding-a-predicate.md"
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def steps() -> list[tuple[str, str]]:
    """The tutorial's blocks in their order: a file's name and its text, or "sh" and commands."""
    text = PAGE.read_text(encoding="utf-8").partition("## What is learned")[0]
    found: list[tuple[str, str]] = []
    for kind, block in BLOCK.findall(text):
        named = re.match(r"# ([\w.]+):", block)
        found.append(("sh" if kind == "sh" else named.group(1) if named else kind, block))
    return found


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_the_tutorial_runs_from_an_empty_folder_to_an_executed_plan(tmp_path: Path) -> None:
    environment = {
        **os.environ,
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
    }
    environment["PYTHONPATH"] = str(PAGE.parent.parent)
    ran: list[str] = []
    said = ""
    for name, text in steps():
        if name != "sh":
            (tmp_path / name).write_text(text, encoding="utf-8")
            continue
        for line in text.splitlines():
            run = subprocess.run(
                line.split(),
                cwd=tmp_path,
                env=environment,
                capture_output=True,
                text=True,
                check=False,
                timeout=300,
            )
            assert run.returncode == 0, f"{line}\n{run.stdout}\n{run.stderr}"
            ran.append(line.split()[0])
            said += run.stdout

    assert ran == [
        "python",
        "tamp-learn",
        "tamp-learn",
        "tamp-solve",
        "tamp-verify",
        "tamp-execute",
    ]
    assert len(list((tmp_path / "demos").glob("*.yaml"))) == 24
    assert "+  (:derived (left_of ?o - movable ?o2 - movable)" in said
    assert "place  cup  left_of plate" in said and "Goal reached" in said
    assert len(list((tmp_path / "pictures").glob("*.png"))) == 5
    plan = json.loads((tmp_path / "plan.json").read_text(encoding="utf-8"))
    assert [action["name"] for action in plan["actions"]] == ["move", "pick", "move", "place"]
