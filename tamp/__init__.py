"""Task and motion planning for mobile manipulators, with samplers that can be learned.

problem = tamp.load_problem("four_objects"); solution = tamp.solve(problem, max_time=30.0, seed=0)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tamp.algorithms.solution import Outcome as Outcome
    from tamp.api import solve as solve
    from tamp.call import Call as Call
    from tamp.errors import InputError as InputError
    from tamp.plan_file import write_plan as write_plan
    from tamp.problem import Problem as Problem
    from tamp.problem import load_problem as load_problem
    from tamp.rejection import Rejection as Rejection
    from tamp.solution import Action as Action
    from tamp.solution import Solution as Solution
    from tamp.world.pose import Pose as Pose
    from tamp.world.scene import Scene as Scene

_HOMES = {
    "Action": "tamp.solution",
    "Call": "tamp.call",
    "InputError": "tamp.errors",
    "Outcome": "tamp.algorithms.solution",
    "Pose": "tamp.world.pose",
    "Problem": "tamp.problem",
    "Rejection": "tamp.rejection",
    "Scene": "tamp.world.scene",
    "Solution": "tamp.solution",
    "load_problem": "tamp.problem",
    "solve": "tamp.api",
    "write_plan": "tamp.plan_file",
}
"""Public names and the modules that they are imported from when first used: `import tamp` costs nothing."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tamp' has no attribute '{name}'")
    import importlib

    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted(_HOMES)
