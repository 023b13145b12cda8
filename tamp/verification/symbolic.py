"""The judge of purely symbolic plans: PDDL's semantics, asked action by action."""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.plan.sources import sha256, unquoted
from tamp.plan.symbolic import VERSION
from tamp.plan.violation import Violation
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.formatter import to_text
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Action, Atom, Fact, Task
from tamp.system.json_fields import Field, clipped
from tamp.system.reading import is_file, read_json
from tamp.verification.formulas import flat, ground
from tamp.verification.report import Report
from tamp.verification.semantics import Semantics, State

COST_TOLERANCE = 1e-6
"""By which a stated cost may differ from the domain's."""


def verify_symbolic(
    plan: dict[str, Any] | Path, problem: Path | None = None, domain: Path | None = None
) -> Report:
    """Run a plan through the domain's actions and compare what it says with what they do.

    Args:
        plan: A plan file of format "tamp-symbolic-plan", or its content.
        problem: The problem's file, instead of the one that the plan names.
        domain: The domain's file, instead of the one that the plan names.

    Raises:
        InputError: The plan file is malformed, or a file that it was made from is missing or
            malformed.
    """
    began = time.monotonic()
    file = None if isinstance(plan, dict) else plan
    root = Field(plan if isinstance(plan, dict) else read_json(plan), "", file)
    if root["version"].value != VERSION:
        version = clipped(str(root["version"].value))
        raise root["version"].wrong(f"version {version} is not known, only {VERSION}")

    violations: list[Violation] = []
    files: dict[str, Path] = {}
    hashes: dict[Path, str | None] = {}
    for role, given in (("problem", problem), ("domain", domain)):
        source = root["inputs"][role]
        files[role] = _file(Path(source["path"].text()), given, role, file)
        hashes[files[role]] = source["sha256"].text() if given is None else None
        if sha256(files[role]) != source["sha256"].text():
            violations.append(
                Violation(
                    "hash", f"the {role} {files[role]} is not the one that the plan was made from"
                )
            )

    with unquoted(file, hashes):
        parsed = parse_domain(read_pddl(files["domain"]), files["domain"])
        task = parse_task(read_pddl(files["problem"]), parsed, files["problem"])
    actions = root["actions"].items()
    violations += _run(task, actions, root["cost"].number())

    return Report(
        name=file.name if file else "the plan",
        violations=tuple(violations),
        actions=len(actions),
        duration=0.0,
        states=len(actions) + 1,
        nearest=None,
        trusted={},
        notes=(),
        seconds=time.monotonic() - began,
    )


def _run(task: Task, actions: list[Field], stated: float) -> list[Violation]:
    semantics = Semantics(task.domain, {**task.domain.constants, **task.objects})
    state, total = State.of(task.initial), 0.0
    violations: list[Violation] = []

    for index, field in enumerate(actions):
        name, arguments = field["name"], [item.text() for item in field["arguments"].items()]
        action = semantics.actions.get(name.text())
        if action is None:
            raise name.wrong(
                f"unknown action '{name.text()}'",
                found=name.text(),
                choices=tuple(semantics.actions),
            )
        _check_arguments(field["arguments"], action, arguments, semantics)

        for parameter, argument in zip(action.parameters, arguments, strict=True):
            if not semantics.fits(argument, parameter.types):
                what = f"{argument} is no {' or '.join(parameter.types)}"
                violations.append(Violation("precondition", what, index, action.name))
        unmet = [
            f"{to_text(formula)} does not hold"
            for formula in semantics.unmet(action, arguments, state)
        ]
        violations += [Violation("precondition", what, index, action.name) for what in unmet]

        cost = _cost(task, action, arguments)
        if cost is None:
            violations.append(Violation("cost", "its cost is not known", index, action.name))
        elif abs(cost - field["cost"].number()) > COST_TOLERANCE:
            what = f"it costs {cost:g}, not {field['cost'].number():g}"
            violations.append(Violation("cost", what, index, action.name))

        total += cost or 0.0
        state = semantics.apply(action, arguments, state)

    missing = [part for part in flat(task.goal) if not semantics.holds(part, state)]
    violations += [Violation("goal", f"{to_text(part)} does not hold") for part in missing]
    if abs(total - stated) > COST_TOLERANCE:
        violations.append(Violation("cost", f"the plan costs {total:g}, not {stated:g}"))
    return violations


def _check_arguments(
    field: Field, action: Action, arguments: list[str], semantics: Semantics
) -> None:
    if len(arguments) != len(action.parameters):
        raise field.wrong(
            f"'{action.name}' takes {len(action.parameters)} arguments, not {len(arguments)}"
        )
    for argument in arguments:
        if argument not in semantics.objects:
            raise field.wrong(
                f"unknown object '{argument}'",
                found=argument,
                choices=tuple(sorted(semantics.objects)),
            )


def _cost(task: Task, action: Action, arguments: list[str]) -> float | None:
    if not isinstance(action.cost, Atom):
        return float(action.cost)
    binding = dict(zip((p.name for p in action.parameters), arguments, strict=True))
    costs: Mapping[Fact, float] = task.costs
    return costs.get(ground(action.cost, binding))


def _file(named: Path, given: Path | None, role: str, plan: Path | None) -> Path:
    """Find the problem's or domain's file: the user's, else where the plan says, else beside it."""
    beside = [plan.parent / named.name] if plan else []
    for file in (named, *beside) if given is None else (given,):
        if is_file(file):
            return file
    if given is not None:
        raise InputError(f"no such file: {given}")
    raise InputError(
        f"the plan's {role} {named} is missing", file=plan, remedy=f"Give --{role} FILE"
    )
