"""The commands: each is guarded (`tamp.system.guard`) before what it needs is imported, which takes
a second.
"""

from __future__ import annotations

from typing import NoReturn

from tamp.system.guard import guarded


def solve() -> NoReturn:
    """Run tamp-solve."""
    guarded("tamp.commands.solve")


def verify() -> NoReturn:
    """Run tamp-verify."""
    guarded("tamp.commands.verify")


def execute() -> NoReturn:
    """Run tamp-execute."""
    guarded("tamp.commands.solve", "execute")


def export() -> NoReturn:
    """Run tamp-export."""
    guarded("tamp.commands.export")


def view() -> NoReturn:
    """Run tamp-view."""
    guarded("tamp.commands.view")


def bench() -> NoReturn:
    """Run tamp-bench."""
    guarded("tamp.commands.bench")


def learn() -> NoReturn:
    """Run tamp-learn."""
    guarded("grounding.cli")


def robot() -> NoReturn:
    """Run tamp-robot."""
    guarded("tamp.commands.robot")


def demo() -> NoReturn:
    """Run tamp-demo."""
    guarded("grounding.demonstrate.command")
