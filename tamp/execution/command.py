"""The execution that `tamp-execute` and `tamp-solve --execute` have in common: from a plan file to
a report.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tamp.errors import InputError
from tamp.execution.disturbance import DISTURBANCES
from tamp.execution.execute import execute
from tamp.execution.execution_options import ExecutionOptions
from tamp.execution.goal import classifiers_of
from tamp.execution.grasp_modes import GRASPS
from tamp.execution.relations import named_classifiers
from tamp.execution.replan import Replanner, is_given
from tamp.execution.report import Execution
from tamp.geometric.samplers.choice import Registry, sampler_choices
from tamp.geometric.samplers.python_file import given_by_files
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.plan.open import Stored, open_plan
from tamp.planner.solve import ALGORITHMS
from tamp.simulation.engines import engine


@dataclass(frozen=True)
class Options:
    """The options of an execution: see `tamp-execute --help`."""

    grasp: str = "friction"
    replan: bool = False
    disturb: str | None = None
    seed: int = 0
    time: float = 30.0
    problem: Path | None = None
    sampler: tuple[str, ...] = ()
    engine: str | None = None


def check(options: Options) -> None:
    """Refuse names that nobody knows before time is spent on a plan.

    Raises:
        InputError: An unknown grasp or disturbance; an engine that is unknown or not installed; a
            time that is not positive.
    """
    if options.grasp not in GRASPS:
        raise InputError(f"unknown grasp '{options.grasp}'", found=options.grasp, choices=GRASPS)
    if options.disturb is not None and options.disturb not in DISTURBANCES:
        what = f"unknown disturbance '{options.disturb}'"
        raise InputError(what, found=options.disturb, choices=DISTURBANCES)
    engine(options.engine)
    if not options.time > 0.0:
        raise InputError(f"--time: the time must be positive, not {options.time:g}")


def carry_out(file: Path, options: Options, registry: Registry) -> Execution:
    """Carry out a plan file in physics.

    Args:
        file: The plan.
        options: How.
        registry: The learned groundings, for their opinion of the goal and for planning anew.

    Raises:
        InputError: The plan file is malformed, of another version, or what it was made from has
            changed; a sampler that it needs for planning anew is not to be had.
    """
    check(options)
    chosen = sampler_choices(options.sampler)
    names, objects = given_by_files(chosen)
    stored = open_plan(file, options.problem)
    if options.replan:
        _check_options(stored, names)
    execution_options = ExecutionOptions(
        grasp=options.grasp,
        replanner=Replanner(stored, registry, options.time, options.seed, names, objects)
        if options.replan
        else None,
        disturbance=options.disturb,
        seed=abs(options.seed),
        classifiers=classifiers_of(registry),
        own=named_classifiers(stored, names, objects, registry, chosen),
        engine=options.engine,
    )
    return execute(stored, execution_options)


def _check_options(stored: Stored, named: Mapping[str, str]) -> None:
    """Check the plan's own options; an object in Python that served a relation of the user's own is
    not in the file.
    """
    algorithm = stored.plan.algorithm
    if algorithm not in ALGORITHMS:
        what = f"options.algorithm: unknown algorithm '{algorithm}'"
        raise InputError(what, file=stored.plan.file, found=algorithm, choices=ALGORITHMS)
    for relation, text in stored.plan.samplers.items():
        if is_given(text) and relation not in named and relation not in SAMPLERS:
            what = (
                f"to plan anew, '{relation}' needs the object in Python that the plan was made with"
            )
            raise InputError(what, remedy=f"Name its file: --sampler {relation}=FILE.py")
