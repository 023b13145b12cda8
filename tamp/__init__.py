"""Task and motion planning for mobile manipulators, with samplers that can be learned.

problem = tamp.load_problem("four_objects"); solution = tamp.solve(problem, max_time=30.0, seed=0)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tamp.errors import InputError as InputError
    from tamp.geometric.scene.pose import Pose as Pose
    from tamp.geometric.scene.scene import Scene as Scene
    from tamp.geometric.stability.placement import Placement as Placement
    from tamp.plan.write import write_plan as write_plan
    from tamp.planner.problem import Problem as Problem
    from tamp.planner.problem import load_problem as load_problem
    from tamp.planner.solution import Action as Action
    from tamp.planner.solution import Solution as Solution
    from tamp.planner.solve import solve as solve
    from tamp.stream import Call as Call
    from tamp.stream import Rejection as Rejection
    from tamp.stream import RejectionKind as RejectionKind
    from tamp.symbolic.algorithms.result import Outcome as Outcome

_HOMES = {
    "Action": "tamp.planner.solution",
    "Call": "tamp.stream",
    "InputError": "tamp.errors",
    "Outcome": "tamp.symbolic.algorithms.result",
    "Placement": "tamp.geometric.stability.placement",
    "Pose": "tamp.geometric.scene.pose",
    "Problem": "tamp.planner.problem",
    "Rejection": "tamp.stream",
    "RejectionKind": "tamp.stream",
    "Scene": "tamp.geometric.scene.scene",
    "Solution": "tamp.planner.solution",
    "load_problem": "tamp.planner.problem",
    "solve": "tamp.planner.solve",
    "write_plan": "tamp.plan.write",
}
"""Public names and the modules that they are imported from when first used: `import tamp` costs
nothing."""


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tamp' has no attribute '{name}'")
    import importlib

    return getattr(importlib.import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted(_HOMES)
