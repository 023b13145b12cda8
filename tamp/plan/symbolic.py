"""The plan file of a problem in PDDL alone: how it is told from one with a scene."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tamp.system.reading import read_json

FORMAT, VERSION = "tamp-symbolic-plan", 1
"""What such a file says of itself."""


def is_symbolic(plan: dict[str, Any] | Path) -> bool:
    """Tell whether a plan file, or its content, is one without scene and robot."""
    content = plan if isinstance(plan, dict) else read_json(plan)
    return isinstance(content, dict) and content.get("format") == FORMAT
