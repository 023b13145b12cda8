"""From an instantiated plan to the steps of a skeleton."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from tamp.symbolic.algorithms.binding.skeleton import Step, Usage
from tamp.symbolic.algorithms.experience.stream_statistics import Experience
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import Guard, InstantiatedTask, Operator
from tamp.symbolic.search.plan_trace import Trace, trace
from tamp.symbolic.search.search import Plan

NOGOOD_PREDICATE = "(nogood)"
"""The predicate of the facts that stand for what binding learned; no PDDL name looks like it."""


def with_nogoods(
    instantiated: InstantiatedTask, experience: Experience
) -> tuple[InstantiatedTask, dict[Fact, float]]:
    """Guard the task by all nogoods that were learned; return it and the guards' prices."""
    if not experience.nogoods:
        return instantiated, {}
    guards: dict[Fact, list[Guard]] = {}
    prices: dict[Fact, float] = {}
    for number, ((fact, present), record) in enumerate(experience.nogoods.items()):
        name = (NOGOOD_PREDICATE, str(number))
        prices[name] = record.price
        guards.setdefault(fact, []).append(Guard(present, name))
    operators = tuple(
        _guarded(
            operator, [guard for fact in sorted(operator.static) for guard in guards.get(fact, ())]
        )
        for operator in instantiated.operators
    )
    return replace(instantiated, operators=operators), prices


def _guarded(operator: Operator, guards: list[Guard]) -> Operator:
    if not guards:
        return operator
    return replace(operator, guards=(*operator.guards, *guards))


def to_steps(
    instantiated: InstantiatedTask, plan: Plan, prices: Mapping[Fact, float]
) -> tuple[tuple[Step, ...], Trace]:
    """Return the plan's steps, and the trace that they come from."""
    traced = trace(instantiated, plan.operators, prices)
    steps: list[Step] = []
    for step in traced.steps:
        operator = step.operator
        usages = [
            Usage(guard.waived_by, guard.facts)
            for guard in step.guards
            if guard.waived_by is not None and guard.waived_by[0] != NOGOOD_PREDICATE
        ]

        steps.append(
            Step(
                name=operator.name,
                arguments=operator.arguments,
                state=step.state,
                read=step.read,
                added=step.added,
                deleted=step.deleted,
                static=step.unguarded,
                derived=step.derived,
                usages=tuple(sorted(usages, key=lambda usage: (usage.fact, sorted(usage.present)))),
                cost=operator.cost,
            )
        )

    return tuple(steps), traced
