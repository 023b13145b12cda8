"""The commands: each is guarded (`tamp.guard`) before what it needs is imported, which takes a second."""

from __future__ import annotations

from typing import NoReturn

from tamp.guard import guarded


def solve() -> NoReturn:
    """Run tamp-solve."""
    guarded("tamp.cli")


def verify() -> NoReturn:
    """Run tamp-verify."""
    guarded("tamp.verification.cli")


def execute() -> NoReturn:
    """Run tamp-execute."""
    guarded("tamp.cli", "execute")


def export() -> NoReturn:
    """Run tamp-export."""
    guarded("tamp.export.cli")


def view() -> NoReturn:
    """Run tamp-view."""
    guarded("tamp.view.cli")


def bench() -> NoReturn:
    """Run tamp-bench."""
    guarded("tamp.bench.cli")


def learn() -> NoReturn:
    """Run tamp-learn."""
    guarded("grounding.cli")
