"""The judge: a plan file in, a report out."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.pddl.files import read_pddl
from tamp.pddl.parser import parse_domain, parse_facts, parse_goal
from tamp.pddl.structs import Domain, Fact
from tamp.simulation.physics import World
from tamp.verification.certified import Certified
from tamp.verification.files import plan_hashes, source_file, unquoted
from tamp.verification.formulas import substitute
from tamp.verification.plan_file import PlanFile, read_plan
from tamp.verification.replay import Replay
from tamp.verification.report import Report, Violation
from tamp.verification.semantics import Semantics
from tamp.verification.start import check_files, check_initial, check_objects
from tamp.verification.sweep import Sweeper
from tamp.verification.symbolic import is_symbolic, verify_symbolic
from tamp.world.load import LoadedProblem, load_scene
from tamp.world.robot import ROBOTS


def verify(
    plan: dict[str, Any] | str | Path, problem: str | Path | None = None, domain: str | Path | None = None
) -> Report:
    """Replay a plan with PDDL's semantics and pybullet's kinematics and collision detection.

    Args:
        plan: A plan file, or its content.
        problem: The problem's file, instead of the one that the plan names.
        domain: The domain's file, instead of the one that the plan names.

    Raises:
        InputError: The plan file is malformed, or a file that it was made from is missing or malformed.
    """
    began = time.monotonic()
    document = plan if isinstance(plan, dict) else Path(plan)
    if is_symbolic(document):
        given = [None if file is None else Path(file) for file in (problem, domain)]
        return verify_symbolic(document, *given)
    read = read_plan(document)
    problem_file = source_file(read, "problem", None if problem is None else Path(problem))
    domain_file = source_file(read, "domain", None if domain is None else Path(domain))
    named = plan_hashes(
        read, problem=None if problem is None else problem_file, domain=None if domain is None else domain_file
    )
    with unquoted(read.file, named):
        loaded = load_scene(problem_file)
        parsed = parse_domain(read_pddl(domain_file), domain_file)
    objects = _objects(read, parsed)
    given = _given(loaded, parsed, objects)
    goal = parse_goal(
        loaded.goal.text, parsed, objects, loaded.path,
        line_offset=loaded.goal.line - 1, column_offset=loaded.goal.column - 1,
    )  # fmt: skip
    robot = ROBOTS[loaded.scene.robot.model]()
    semantics = Semantics(parsed, objects)
    violations = [
        *check_files(read, {"problem": problem_file, "domain": domain_file}, loaded.meshes),
        *check_objects(read, loaded.scene, parsed),
    ]
    if read.robot != loaded.scene.robot.model:
        violations.append(Violation("initial", f"the problem's robot is {loaded.scene.robot.model}, not {read.robot}"))
    own_goal = parse_goal(read.goal, parsed, objects, read.file)
    if substitute(own_goal, {}) != substitute(goal, {}):
        violations.append(Violation("goal", "the plan's goal is not the problem's"))
    trusted: Counter[str] = Counter()
    with World(loaded.scene, robot) as world:
        sweeper = Sweeper(world, robot)
        certified = Certified(read, world, robot, sweeper, parsed)
        violations += check_initial(read, loaded.scene, parsed, given, certified.known)
        static = [fact for fact in read.initial if fact[0] in certified.known and fact not in given]
        violations += certified.check([*read.certified, *static], trusted)
        for body in loaded.scene.bodies.values():
            world.place(body.name, body.pose.matrix)
        replay = Replay(read, world, robot, sweeper, semantics, certified)
        replay.run(goal)
        violations += replay.log.violations
        return Report(
            name=read.file.name if read.file else "the plan",
            violations=tuple(violations),
            actions=len(read.actions),
            duration=replay.course.time,
            states=replay.findings.states,
            nearest=replay.findings.nearest,
            trusted=dict(sorted(trusted.items())),
            notes=tuple(replay.notes),
            seconds=time.monotonic() - began,
        )


def _objects(plan: PlanFile, domain: Domain) -> dict[str, tuple[str, ...]]:
    """All objects with their types.

    Raises:
        InputError: A fact or an action names one that the plan does not have.
    """
    values = {name: (value.type,) for name, value in plan.values.items() if value.type in domain.types}
    objects = {**domain.constants, **{name: ("object",) for name in plan.values}, **values, **plan.objects}
    facts = [(fact, "initial") for fact in plan.initial] + [(fact, "certified") for fact in plan.certified]
    terms = [(term, where) for fact, where in facts for term in fact[1:]]
    terms += [(term, f"actions[{at}].arguments") for at, action in enumerate(plan.actions) for term in action.arguments]
    for term, where in terms:
        if term not in objects:
            raise InputError(f"{where}: unknown object '{term}'", file=plan.file, found=term, choices=sorted(objects))
    return objects


def _given(loaded: LoadedProblem, domain: Domain, objects: dict[str, tuple[str, ...]]) -> frozenset[Fact]:
    facts: set[Fact] = set()
    for passage in loaded.init:
        facts |= parse_facts(
            passage.text, domain, objects, loaded.path,
            line_offset=passage.line - 1, column_offset=passage.column - 1,
        )  # fmt: skip
    return frozenset(facts)
