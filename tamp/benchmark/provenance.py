"""Provenance of a figure: commit, machine, versions. Without them it is worth nothing."""

from __future__ import annotations

import os
import platform
import socket
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

from tamp.system.distribution import distribution_version

FOLDER = Path(__file__).resolve().parent


@cache
def provenance() -> dict[str, Any]:
    """Return the provenance: commit (of the checkout that runs, with +changes, or "unknown"),
    machine and versions.
    """
    git = ["git", "-C", str(FOLDER)]
    commit = _said([*git, "rev-parse", "--short", "HEAD"])
    changed = _said([*git, "status", "--porcelain", "-uno"])
    return {
        "commit": (commit or "unknown") + ("+changes" if changed else ""),
        "machine": {"cpu": _cpu(), "cores": os.cpu_count(), "host": socket.gethostname()},
        "tamp": distribution_version(),
        "python": platform.python_version(),
        "numpy": distribution_version("numpy"),
    }


def _said(command: list[str]) -> str:
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
    except OSError:  # no git here
        return ""


def _cpu() -> str:
    listed = Path("/proc/cpuinfo")
    for line in listed.read_text(encoding="utf-8").splitlines() if listed.exists() else ():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()
