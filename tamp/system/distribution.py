"""Name the distribution that installs this package, its version, and the command that fetches an
extra of it.

The import name is `tamp`, the distribution is `tamp-planner`: on the public index `tamp` is
somebody else's package.
"""

from __future__ import annotations

import importlib.metadata

DISTRIBUTION = "tamp-planner"
UNKNOWN_VERSION = "unknown"


def distribution_version(name: str = DISTRIBUTION) -> str:
    """Return the installed version of a distribution, "unknown" where it is not installed."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return UNKNOWN_VERSION


def install_command(extra: str) -> str:
    """Return the shell command that installs what an optional extra ("bench", "learn", "ray")
    needs.
    """
    return f"pip install '{DISTRIBUTION}[{extra}]'"
