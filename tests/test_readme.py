"""What README shows is what happens."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(language: str) -> list[str]:
    """The fenced blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", README, re.M | re.S)


def words(line: str) -> list[str]:
    """A line without its numbers, which differ from run to run."""
    return re.sub(r"[-+]?\d+(\.\d+)?", "#", line).split()


def test_the_program_runs(tmp_path: Path) -> None:
    (program,) = blocks("python")
    assert len(program.strip().splitlines()) <= 6
    run = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    assert "pick" in run.stdout


def test_the_command_prints_what_is_shown(tmp_path: Path) -> None:
    (shown,) = [block for block in blocks("console") if block.startswith("$ tamp-solve")]
    command, *expected = shown.strip().splitlines()
    program, *arguments = shlex.split(command.removeprefix("$ "))
    paths = [str(ROOT / word) if (ROOT / word).exists() else word for word in arguments]
    script = Path(sys.executable).with_name(program)
    run = subprocess.run(
        [str(script), *paths], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    printed = (run.stdout + run.stderr).splitlines()
    first, last = expected[0], expected[-1]
    assert words(first) in [words(line) for line in printed]
    assert words(last) in [words(line) for line in printed]
    assert (tmp_path / "plan.json").exists()


def test_commands_shown_exist() -> None:
    targets = set(re.findall(r"^([a-z]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M))
    shown = set(re.findall(r"\bmake ([a-z]+)\b", "\n".join(blocks("console"))))
    assert {"solve", "test"} <= shown <= targets


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    for target in re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8")):
        assert target.startswith("http") or (page.parent / target).exists(), target


def test_make_takes_pyenvs_python_where_the_one_on_the_path_does_not_run(tmp_path: Path) -> None:
    """pyenv puts each version's name on the path; those that are not chosen end with an error."""
    scripts = {"shims/python3.13": "exit 127", ".pyenv/versions/3.13.0/bin/python3.13": "exit 0"}
    for name, does in scripts.items():
        script = tmp_path / name
        script.parent.mkdir(parents=True)
        script.write_text(f"#!/bin/sh\n{does}\n")
        script.chmod(0o755)
    path = f"{tmp_path / 'shims'}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["make", "-n", "-B", ".venv/bin/python", "PYTHON=python3.13"], cwd=ROOT,
        env={**os.environ, "HOME": str(tmp_path), "PATH": path},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert f"{tmp_path}/.pyenv/versions/3.13.0/bin/python3.13 -m venv .venv" in done.stdout
