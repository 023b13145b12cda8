"""Options of an execution: the grasp, who replans, what disturbs, which engine."""

from __future__ import annotations

from dataclasses import dataclass, field

from tamp.execution.relations import Named
from tamp.execution.replan import Replanner
from tamp.geometric.samplers.sampler import Classifier


@dataclass(frozen=True)
class ExecutionOptions:
    """The options of an execution: how a plan is carried out.

    Attributes:
        grasp: "friction", or "constraint": the fingers bind what they close on.
        replanner: Who plans anew on a deviation; nobody lets the plan go on as it is.
        disturbance: What somebody does to the scene, one of DISTURBANCES.
        seed: Of the disturbance and of planning anew.
        classifiers: Relation to a classifier and its name, for their opinion of the goal.
        own: The same of the user's own relations, which these decide.
        engine: The physics engine, one of ENGINES; None for the default.
    """

    grasp: str = "friction"
    replanner: Replanner | None = None
    disturbance: str | None = None
    seed: int = 0
    classifiers: Named = field(default_factory=dict[str, "tuple[str, Classifier]"])
    own: Named = field(default_factory=dict[str, "tuple[str, Classifier]"])
    engine: str | None = None
