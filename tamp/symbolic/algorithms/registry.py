"""The algorithms by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from tamp.symbolic.algorithms.adaptive import solve_adaptive
from tamp.symbolic.algorithms.incremental import solve_incremental
from tamp.symbolic.algorithms.result import Progress, Result, StreamTask
from tamp.system.deadline import Deadline

Algorithm = Callable[[StreamTask, Callable[[str], Any], Deadline, Progress], Result]

ALGORITHMS: Mapping[str, Algorithm] = {"adaptive": solve_adaptive, "incremental": solve_incremental}
