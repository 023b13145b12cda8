"""The judge: a plan file in, a report out."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

from tamp.errors import InputError
from tamp.geometric.loading.robots import load_robot
from tamp.geometric.scene.classifier import Classifier
from tamp.plan.read import PlanFile, read_plan
from tamp.plan.robot_check import check_robot
from tamp.plan.sources import check_files
from tamp.plan.symbolic import is_symbolic
from tamp.plan.violation import Violation
from tamp.simulation.engines import asked_engines, open_world
from tamp.symbolic.pddl.parser import parse_goal
from tamp.verification.certified_facts import Certified
from tamp.verification.collision_sweep import Sweeper
from tamp.verification.formulas import substitute
from tamp.verification.initial_state import check_initial, check_objects
from tamp.verification.inputs import Inputs, find_files, read_inputs
from tamp.verification.relations import ObservedRelations
from tamp.verification.replay import Replay
from tamp.verification.report import Report
from tamp.verification.semantics import Semantics
from tamp.verification.symbolic import verify_symbolic
from tamp.verification.trust import (
    certifiable,
    domain_note,
    other_files,
    trusted_relations,
)
from tamp.verification.two_engines import compared
from tamp.verification.violation_log import ViolationLog

NO_CLASSIFIERS: Mapping[str, Classifier] = MappingProxyType({})


def verify(
    plan: dict[str, Any] | str | Path,
    problem: str | Path | None = None,
    domain: str | Path | None = None,
    *,
    streams: str | Path | None = None,
    classifiers: Mapping[str, Classifier] = NO_CLASSIFIERS,
    engine: str | None = None,
) -> Report:
    """Replay a plan with PDDL's semantics and an engine's kinematics and collision detection.

    Args:
        plan: A plan file, or its content.
        problem: The problem's file, instead of the one that the plan names.
        domain: The domain's file, instead of the one that the plan names.
        streams: The streams' file, instead of the one that the plan names.
        classifiers: What says whether a relation of the user's own holds, by the relation; without
            it the plan's word is taken, and the report says so.
        engine: One of ENGINES, or "both": then MuJoCo decides, and the report says what pybullet
            sees otherwise. None takes the default.

    Raises:
        InputError: The plan file is malformed, or a file that it was made from is missing or
            malformed; a classifier of a relation that there is not; an engine that is unknown or
            not installed.
    """
    began = time.monotonic()
    engines = asked_engines(engine)
    document = plan if isinstance(plan, dict) else Path(plan)
    if is_symbolic(document):
        if classifiers or streams is not None:
            raise InputError(
                "a plan of a problem in PDDL alone has no streams, "
                "and no relation of a scene to ask about"
            )
        given = [None if file is None else Path(file) for file in (problem, domain)]
        return verify_symbolic(document, *given)

    files = find_files(read_plan(document), problem, domain, streams)
    inputs = read_inputs(files, classifiers)
    opinions = [_judge(inputs, name, began) for name in engines]
    return opinions[0] if len(opinions) == 1 else compared(*opinions)


def _judge(inputs: Inputs, engine: str, began: float) -> Report:
    """Replay the plan; the time of the report counts from `began`, monotonic seconds."""
    plan, loaded, domain = inputs.files.plan, inputs.loaded, inputs.domain
    robot = load_robot(loaded.scene.robot.model)
    check_robot(plan, robot)
    semantics = Semantics(domain, inputs.objects)
    sources = {"problem": inputs.files.problem, "domain": inputs.files.domain}
    violations = [
        *check_files(plan, sources, loaded.meshes),
        *_check_header(inputs, [arm.arm for arm in robot.arms]),
    ]

    trusted: Counter[str] = Counter()
    with open_world(loaded.scene, robot, name=engine) as world:
        sweeper = Sweeper(world, robot)
        certified = Certified(plan, world, robot, sweeper, domain)
        stated = certified.checkable | inputs.decided | certifiable(plan, domain, inputs.streams)
        arms = [arm.arm for arm in robot.arms]
        violations += check_initial(plan, loaded.scene, domain, inputs.initial, stated, arms)
        static = [fact for fact in plan.initial if fact[0] in stated and fact not in inputs.initial]
        violations += certified.check([*plan.certified, *static], trusted)

        for body in loaded.scene.bodies.values():
            world.place(body.name, body.pose.matrix)
        log = ViolationLog()
        relations = ObservedRelations(plan, world, domain, inputs.asked, log)
        replay = Replay(plan, world, robot, sweeper, semantics, certified, relations, log)
        replay.run(inputs.goal)
        violations += log.violations
        decided = certified.checkable | inputs.decided
        report = _report(inputs, violations, trusted, relations, replay, decided, began)
        return replace(report, engine=engine)


def _report(
    inputs: Inputs,
    violations: Sequence[Violation],
    trusted: Mapping[str, int],
    relations: ObservedRelations,
    replay: Replay,
    decided: AbstractSet[str],
    began: float,
) -> Report:
    """Put the report together; `decided` are the predicates that were checked."""
    files, plan = inputs.files, inputs.files.plan
    on_trust = {
        *trusted_relations(
            plan, inputs.domain, inputs.goal, inputs.streams, decided, inputs.initial
        ),
        *relations.silent,
    }
    unsaid = [
        f"'{name}' is taken on trust: {why}" for name, why in sorted(relations.silent.items())
    ]
    names_domain = files.given["domain"] is not None
    others = {role: files.given[role] for role in ("domain", "streams")}
    return Report(
        name=plan.file.name if plan.file else "the plan",
        violations=tuple(violations),
        actions=len(plan.actions),
        duration=replay.course.time,
        states=replay.findings.states,
        nearest=replay.findings.nearest,
        trusted={
            name: count for name, count in sorted(trusted.items()) if name not in inputs.decided
        },
        notes=(
            *replay.notes,
            *_robot_note(plan),
            *unsaid,
            *domain_note(inputs.loaded, files.domain, names_domain),
        ),
        on_trust=tuple(sorted(on_trust)),
        other_files=other_files(plan, inputs.loaded, files.domain, inputs.streams_file, others),
        asked=dict(sorted(relations.answers.items())),
        seconds=time.monotonic() - began,
    )


def _robot_note(plan: PlanFile) -> tuple[str, ...]:
    """Say that the robot is not the problem's, where it was given beside the problem."""
    return (f"with the robot {plan.robot}, given beside the problem",) if plan.robot_given else ()


def _check_header(inputs: Inputs, arms: Sequence[str]) -> Iterator[Violation]:
    """Check that the plan's objects, robot and goal are the problem's."""
    plan, scene, domain = inputs.files.plan, inputs.loaded.scene, inputs.domain
    yield from check_objects(plan, scene, domain, arms)
    if plan.robot != scene.robot.model:
        message = f"the problem's robot is {scene.robot.model}, not {plan.robot}"
        yield Violation("initial", message)

    own_goal = parse_goal(plan.goal, domain, inputs.objects, plan.file)
    if substitute(own_goal, {}) != substitute(inputs.goal, {}):
        yield Violation("goal", "the plan's goal is not the problem's")
