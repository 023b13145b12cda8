"""The judge: a plan file in, a report out."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.robot.robot import ROBOTS
from tamp.geometric.scene.classifier import Classifier
from tamp.geometric.scene.scene import Scene
from tamp.plan.read import PlanFile, read_plan
from tamp.plan.sources import check_files, plan_hashes, source_file, unquoted
from tamp.plan.symbolic import is_symbolic
from tamp.plan.violation import Violation
from tamp.simulation.physics import World
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.parser import parse_domain, parse_facts, parse_goal
from tamp.symbolic.pddl.relations import Relation, relation_names, relation_of
from tamp.symbolic.pddl.structs import Domain, Fact, Formula, StreamFile
from tamp.verification.certified_facts import Certified
from tamp.verification.collision_sweep import Sweeper
from tamp.verification.formulas import substitute
from tamp.verification.initial_state import check_initial, check_objects
from tamp.verification.relations import Relations
from tamp.verification.replay import Replay
from tamp.verification.report import Report
from tamp.verification.semantics import Semantics
from tamp.verification.support_relations import RELATIONS
from tamp.verification.symbolic import verify_symbolic
from tamp.verification.trust import (
    certifiable,
    domain_note,
    other_files,
    read_streams,
    streams_file,
    trusted_relations,
)
from tamp.verification.violation_log import Log

NO_CLASSIFIERS: Mapping[str, Classifier] = MappingProxyType({})


def verify(
    plan: dict[str, Any] | str | Path,
    problem: str | Path | None = None,
    domain: str | Path | None = None,
    *,
    streams: str | Path | None = None,
    classifiers: Mapping[str, Classifier] = NO_CLASSIFIERS,
) -> Report:
    """Replay a plan with PDDL's semantics and pybullet's kinematics and collision detection.

    Args:
        plan: A plan file, or its content.
        problem: The problem's file, instead of the one that the plan names.
        domain: The domain's file, instead of the one that the plan names.
        streams: The streams' file, instead of the one that the plan names.
        classifiers: What says whether a relation of the user's own holds, by the relation; without
            it the plan's word is taken, and the report says so.

    Raises:
        InputError: The plan file is malformed, or a file that it was made from is missing or
            malformed; a classifier of a relation that there is not.
    """
    began = time.monotonic()
    document = plan if isinstance(plan, dict) else Path(plan)
    if is_symbolic(document):
        if classifiers or streams is not None:
            raise InputError(
                "a plan of a problem in PDDL alone has no streams, "
                "and no relation of a scene to ask about"
            )
        given = [None if file is None else Path(file) for file in (problem, domain)]
        return verify_symbolic(document, *given)

    read = read_plan(document)
    problem_file = source_file(read, "problem", None if problem is None else Path(problem))
    domain_file = source_file(read, "domain", None if domain is None else Path(domain))
    named = plan_hashes(
        read,
        problem=None if problem is None else problem_file,
        domain=None if domain is None else domain_file,
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

    own_streams = streams_file(read, None if streams is None else Path(streams), domain_file)
    declared = read_streams(read, own_streams, parsed)
    asked = _asked(classifiers, declared, parsed)
    robot = ROBOTS[loaded.scene.robot.model]()
    semantics = Semantics(parsed, objects)

    violations = [
        *check_files(read, {"problem": problem_file, "domain": domain_file}, loaded.meshes),
        *_check_header(read, loaded.scene, parsed, objects, goal),
    ]
    trusted: Counter[str] = Counter()
    with World(loaded.scene, robot) as world:
        sweeper = Sweeper(world, robot)
        certified = Certified(read, world, robot, sweeper, parsed)
        decided = {name for relation, _ in asked.values() for name in relation.predicates}
        stated = certified.known | decided | certifiable(read, parsed, declared)

        violations += check_initial(read, loaded.scene, parsed, given, stated)
        static = [fact for fact in read.initial if fact[0] in stated and fact not in given]
        violations += certified.check([*read.certified, *static], trusted)

        for body in loaded.scene.bodies.values():
            world.place(body.name, body.pose.matrix)
        log = Log()
        relations = Relations(read, world, parsed, asked, log)
        replay = Replay(read, world, robot, sweeper, semantics, certified, relations, log)
        replay.run(goal)
        violations += log.violations

        settled = certified.known | decided
        on_trust = {
            *trusted_relations(read, parsed, goal, declared, settled, given),
            *relations.silent,
        }
        unsaid = [
            f"'{name}' is taken on trust: {why}" for name, why in sorted(relations.silent.items())
        ]

        others = {"domain": domain, "streams": streams}
        given_files = {role: None if file is None else Path(file) for role, file in others.items()}
        return Report(
            name=read.file.name if read.file else "the plan",
            violations=tuple(violations),
            actions=len(read.actions),
            duration=replay.course.time,
            states=replay.findings.states,
            nearest=replay.findings.nearest,
            trusted={name: count for name, count in sorted(trusted.items()) if name not in decided},
            notes=(*replay.notes, *unsaid, *domain_note(loaded, domain_file, domain is not None)),
            on_trust=tuple(sorted(on_trust)),
            other_files=other_files(read, loaded, domain_file, own_streams, given_files),
            asked=dict(sorted(relations.answers.items())),
            seconds=time.monotonic() - began,
        )


def _check_header(
    plan: PlanFile,
    scene: Scene,
    domain: Domain,
    objects: dict[str, tuple[str, ...]],
    goal: Formula,
) -> Iterator[Violation]:
    """Check that the plan's objects, robot and goal are the problem's."""
    yield from check_objects(plan, scene, domain)
    if plan.robot != scene.robot.model:
        message = f"the problem's robot is {scene.robot.model}, not {plan.robot}"
        yield Violation("initial", message)

    own_goal = parse_goal(plan.goal, domain, objects, plan.file)
    if substitute(own_goal, {}) != substitute(goal, {}):
        yield Violation("goal", "the plan's goal is not the problem's")


def _asked(
    classifiers: Mapping[str, Classifier], streams: StreamFile | None, domain: Domain
) -> dict[str, tuple[Relation, Classifier]]:
    """Find the relations of the classifiers.

    Raises:
        InputError: There is no such relation, or its facts do not say of what it is to be asked.
    """
    found: dict[str, tuple[Relation, Classifier]] = {}
    for name, classifier in classifiers.items():
        if streams is None:
            remedy = "Give them: --streams FILE"
            raise InputError(
                f"of what '{name}' is asked, the streams say, and they are not there", remedy=remedy
            )

        names = relation_names(streams)
        if name not in names:
            raise InputError(
                f"the streams have no relation '{name}'",
                file=streams.file,
                found=name,
                choices=names,
            )

        relation = relation_of(streams, domain, name)
        if relation is not None and relation.predicates & RELATIONS.keys():
            raise InputError(f"'{name}' is decided by the bodies' geometry, no classifier is asked")
        if relation is None:
            what = (
                f"the facts of '{name}' do not say by bodies, poses and places alone that it holds"
            )
            raise InputError(
                what,
                file=streams.file,
                remedy="docs/adding-a-predicate.md says what its streams are like",
            )
        found[name] = relation, classifier
    return found


def _objects(plan: PlanFile, domain: Domain) -> dict[str, tuple[str, ...]]:
    """Return all objects with their types.

    Raises:
        InputError: A fact or an action names one that the plan does not have.
    """
    values = {
        name: (value.type,) for name, value in plan.values.items() if value.type in domain.types
    }

    objects = {
        **domain.constants,
        **{name: ("object",) for name in plan.values},
        **values,
        **plan.objects,
    }

    facts = [(fact, "initial") for fact in plan.initial] + [
        (fact, "certified") for fact in plan.certified
    ]
    terms = [(term, where) for fact, where in facts for term in fact[1:]]
    terms += [
        (term, f"actions[{at}].arguments")
        for at, action in enumerate(plan.actions)
        for term in action.arguments
    ]

    for term, where in terms:
        if term not in objects:
            raise InputError(
                f"{where}: unknown object '{term}'",
                file=plan.file,
                found=term,
                choices=sorted(objects),
            )

    return objects


def _given(
    loaded: LoadedProblem, domain: Domain, objects: dict[str, tuple[str, ...]]
) -> frozenset[Fact]:
    facts: set[Fact] = set()
    for passage in loaded.init:
        facts |= parse_facts(
            passage.text, domain, objects, loaded.path,
            line_offset=passage.line - 1, column_offset=passage.column - 1,
        )  # fmt: skip
    return frozenset(facts)
