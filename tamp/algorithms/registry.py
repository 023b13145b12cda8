"""The algorithms by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from tamp.algorithms.adaptive import solve_adaptive
from tamp.algorithms.incremental import solve_incremental
from tamp.algorithms.solution import Progress, Result, StreamTask
from tamp.clock import Deadline

Algorithm = Callable[[StreamTask, Callable[[str], Any], Deadline, Progress], Result]

ALGORITHMS: Mapping[str, Algorithm] = {"adaptive": solve_adaptive, "incremental": solve_incremental}
