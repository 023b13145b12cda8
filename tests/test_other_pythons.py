"""What Python 3.12 and 3.13 have no wheels of, torch and pybullet, no test needs to be collected."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

WITHOUT = """
import sys
sys.modules["torch"] = sys.modules["pybullet"] = sys.modules["pybullet_data"] = None
import pytest
sys.exit(pytest.main(["--collect-only", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *sys.argv[1:]]))
"""


@pytest.mark.slow
def test_every_test_is_collected_without_torch_and_pybullet(root: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", WITHOUT, "tests"],
        cwd=root,
        capture_output=True,
        text=True,
        check=False,
        timeout=500,
    )
    assert done.returncode == 0, done.stdout[-3000:]
    assert "tests/grounding/test_registry.py::" in done.stdout
    assert "[pybullet]" not in done.stdout
