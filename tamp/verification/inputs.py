"""Inputs of the judge: the plan, the files that it was made from, and what they say."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.scene.classifier import Classifier
from tamp.plan.read import PlanFile
from tamp.plan.sources import plan_hashes, source_file, unquoted
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.parser import parse_domain, parse_facts, parse_goal
from tamp.symbolic.pddl.relations import Relation, relation_names, relation_of
from tamp.symbolic.pddl.structs import Domain, Fact, Formula, StreamFile
from tamp.verification.support_relations import SUPPORT_PREDICATES
from tamp.verification.trust import read_streams, streams_file


@dataclass(frozen=True)
class InputFiles:
    """The plan, and the files that it is judged by.

    Attributes:
        plan: As read.
        problem: The problem's file.
        domain: The domain's file.
        given: The files that were given, None for those that the plan names, by their role.
    """

    plan: PlanFile
    problem: Path
    domain: Path
    given: Mapping[str, Path | None]


@dataclass(frozen=True)
class Inputs:
    """All that a plan is judged by, read.

    Attributes:
        files: Where it was read from.
        loaded: The scene, the initial facts and the goal as passages.
        domain: Parsed.
        objects: All objects with their types.
        initial: The problem's initial facts.
        goal: The problem's.
        streams_file: Where the streams are, if anywhere.
        streams: Parsed, if there are any.
        asked: The relations that a classifier decides, by name.
    """

    files: InputFiles
    loaded: LoadedProblem
    domain: Domain
    objects: dict[str, tuple[str, ...]]
    initial: frozenset[Fact]
    goal: Formula
    streams_file: Path | None
    streams: StreamFile | None
    asked: Mapping[str, tuple[Relation, Classifier]]

    @property
    def decided(self) -> frozenset[str]:
        """Return the predicates that classifiers decide."""
        return frozenset(
            name for relation, _ in self.asked.values() for name in relation.predicates
        )


def find_files(
    plan: PlanFile,
    problem: str | Path | None,
    domain: str | Path | None,
    streams: str | Path | None,
) -> InputFiles:
    """Find the files: those that are given before those that the plan names."""
    named = {"problem": problem, "domain": domain, "streams": streams}
    given = {role: None if file is None else Path(file) for role, file in named.items()}
    return InputFiles(
        plan=plan,
        problem=source_file(plan, "problem", given["problem"]),
        domain=source_file(plan, "domain", given["domain"]),
        given=given,
    )


def read_inputs(files: InputFiles, classifiers: Mapping[str, Classifier]) -> Inputs:
    """Read what a plan is judged by."""
    plan = files.plan
    named = plan_hashes(
        plan,
        problem=None if files.given["problem"] is None else files.problem,
        domain=None if files.given["domain"] is None else files.domain,
    )
    with unquoted(plan.file, named):
        loaded = load_scene(files.problem, plan.robot if plan.robot_given else None)
        domain = parse_domain(read_pddl(files.domain), files.domain)

    objects = _objects(plan, domain)
    initial = _given(loaded, domain, objects)
    goal = parse_goal(
        loaded.goal.text, domain, objects, loaded.path,
        line_offset=loaded.goal.line - 1, column_offset=loaded.goal.column - 1,
    )  # fmt: skip
    own_streams = streams_file(plan, files.given["streams"], files.domain)
    declared = read_streams(plan, own_streams, domain)
    return Inputs(
        files=files,
        loaded=loaded,
        domain=domain,
        objects=objects,
        initial=initial,
        goal=goal,
        streams_file=own_streams,
        streams=declared,
        asked=_asked(classifiers, declared, domain),
    )


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
        if relation is not None and relation.predicates & SUPPORT_PREDICATES.keys():
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
