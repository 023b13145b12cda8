"""Where a figure comes from: commit, machine, versions."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest

from tamp.benchmark.provenance import provenance


def test_provenance_names_commit_machine_and_versions() -> None:
    found = provenance()
    assert found["machine"]["cores"] == os.cpu_count() and found["machine"]["cpu"]
    commit = found["commit"].removesuffix("+changes")
    assert commit == "unknown" or (len(commit) >= 7 and set(commit) <= set("0123456789abcdef"))
    assert {"tamp", "python", "numpy"} <= found.keys()


@pytest.mark.parametrize(
    ("changed", "commit"), [("", "abc1234"), (" M tamp/errors.py\n", "abc1234+changes")]
)
def test_a_checkout_with_changes_says_so(
    changed: str, commit: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def git(command: list[str], **_: object) -> SimpleNamespace:
        return SimpleNamespace(stdout="abc1234\n" if "rev-parse" in command else changed)

    monkeypatch.setattr(subprocess, "run", git)
    assert provenance.__wrapped__()["commit"] == commit


def test_without_git_the_commit_is_unknown(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    assert provenance.__wrapped__()["commit"] == "unknown"
