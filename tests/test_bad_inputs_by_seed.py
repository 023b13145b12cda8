"""A sample of `benchmarks.bad_inputs`: whatever is spoilt, it is one error with its file, and nothing is lost."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.mark.slow
def test_no_bad_input_is_more_than_one_error() -> None:
    words = [sys.executable, "-m", "benchmarks.bad_inputs", "--cases", "40", "--seed", "7"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=500, check=False)
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-5000:]
    assert "0 of 40 fail" in done.stdout
