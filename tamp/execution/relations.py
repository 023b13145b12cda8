"""Relations of the user's own in what is seen: their classifiers decide, where there are any."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from tamp.errors import InputError
from tamp.execution.expected import Expected
from tamp.execution.observation import ObservedScene
from tamp.geometric.samplers.choice import USER_OBJECT, Grounding, Registry, factory, parse_choice
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY, Classifier
from tamp.geometric.streams.registry import STREAMS
from tamp.plan.open import PlanBundle
from tamp.plan.sources import source_file
from tamp.relations.observed import ClassifierAnswers, moved, observe
from tamp.symbolic.pddl.complement import atoms_of_conditions
from tamp.symbolic.pddl.relations import (
    SAMPLE_PREFIX,
    Relation,
    needed_false,
    relation_names,
    relation_of,
)
from tamp.symbolic.pddl.structs import Domain, Fact, Formula, StreamFile
from tamp.verification.trust import read_streams, streams_file

Named = Mapping[str, tuple[str, Classifier]]
"""Relation to a classifier and what it is called."""


@dataclass(frozen=True)
class Own:
    """The user's own relations of a plan.

    Attributes:
        asked: Those with a classifier: the relation, what the classifier is called, and itself.
        trusted: Those on which the goal rests without one: what the plan certified holds while its
            bodies are there.
    """

    asked: Mapping[str, tuple[Relation, str, Classifier]]
    trusted: tuple[str, ...] = ()

    def observe(
        self, truth: ObservedScene, held: str | None, expected: Expected, at: Mapping[str, str]
    ) -> dict[str, ClassifierAnswers]:
        """Observe what the classifiers say of what is seen, by relation; `at` names the poses of
        bodies that stand.
        """
        scene = moved(truth.scene, {}, () if held is None else (held,))
        facts = expected.plan.initial
        return {
            name: observe(
                relation, classifier, scene, expected.domain, expected.plan.objects, facts, at
            )
            for name, (relation, _, classifier) in self.asked.items()
        }

    def missed(self, truth: ObservedScene, held: str | None, expected: Expected) -> frozenset[Fact]:
        """Return relations that should hold by the plan and do not, as (relation, *arguments) in
        PDDL's names.
        """
        at = {row[0]: row[1] for row in expected.state.all("at-pose") if len(row) == 2}
        placed = {name.lower() for name in truth.scene.movable if name != held}
        there = {body: pose for body, pose in at.items() if body in placed}
        seen = self.observe(truth, held, expected, there)
        return frozenset(
            (name, *words)
            for name, (relation, _, _) in self.asked.items()
            for words, answer in seen[name].answers.items()
            if not math.isnan(answer)
            and answer < LIKELY_PROBABILITY
            and all(
                fact in expected.state
                for fact in relation.substitute(
                    dict(zip(relation.arguments, words, strict=True)), there
                )
            )
        )


def own_relations(stored: PlanBundle, domain: Domain, goal: Formula, classifiers: Named) -> Own:
    """Collect the user's own relations that a plan's goal rests on, or its actions.

    Args:
        stored: The plan.
        domain: Its domain.
        goal: Its goal.
        classifiers: Those that there are.

    Raises:
        InputError: The goal needs to know that a relation does not hold, and it has no classifier.
    """
    streams = read_streams(
        stored.plan,
        streams_file(stored.plan, None, source_file(stored.plan, "domain", None)),
        domain,
    )
    if streams is None:
        return Own({})

    asked: dict[str, tuple[Relation, str, Classifier]] = {}
    trusted: list[str] = []
    bare = replace(domain, actions=())
    asked_by_rules = {atom.predicate for atom, _ in atoms_of_conditions(bare, goal)}

    for name in _own_names(stored, streams, classifiers):
        relation = relation_of(streams, domain, name)
        if relation is None:
            continue
        if name in classifiers:
            asked[name] = (relation, *classifiers[name])
        elif relation.predicates & asked_by_rules:
            atom = needed_false(bare, goal, relation.predicates)
            if atom is not None:
                raise _unknown(
                    name, f"({' '.join((atom.predicate, *atom.terms))})", stored.loaded.path
                )
            trusted.append(name)

    return Own(asked, tuple(sorted(trusted)))


def named_classifiers(
    stored: PlanBundle,
    names: Mapping[str, str],
    objects: Mapping[str, Grounding],
    registry: Registry,
    files: Mapping[str, str],
) -> dict[str, tuple[str, Classifier]]:
    """Load the classifiers of the user's own relations: of files that the plan or the command line
    names, and of objects.

    What the plan names and is not there any more is left out; what the command line names must be
    there.

    Args:
        stored: The plan.
        names: Samplers that the command line names, over the plan's.
        objects: Those in Python.
        registry: The learned ones.
        files: By relation, the files that the objects are of.

    Raises:
        InputError: A sampler on the command line that there is not.
    """
    found: dict[str, tuple[str, Classifier]] = {}
    planned: dict[str, str] = stored.document.get("options", {}).get("samplers", {})
    for relation, text in {**planned, **names}.items():
        if relation in SAMPLERS or text.partition(":")[0] == USER_OBJECT:
            continue
        try:
            choice = parse_choice(relation, text, registry)
            made = factory(relation, choice, registry)()
        except InputError:
            if relation in names:
                raise
            continue
        if isinstance(made, Classifier):
            found[relation] = Path(choice.name).name, made
    for relation, item in objects.items():
        if relation not in SAMPLERS and isinstance(item, Classifier):
            found[relation] = Path(files.get(relation, type(item).__name__)).name, item
    return found


def _own_names(stored: PlanBundle, streams: StreamFile, classifiers: Named) -> Iterable[str]:
    planned: dict[str, str] = stored.document.get("options", {}).get("samplers", {})
    sampled = [
        stream.name.removeprefix(SAMPLE_PREFIX) for stream in streams.streams if stream.outputs
    ]
    named = {*planned, *classifiers, *sampled}
    return [
        name
        for name in relation_names(streams)
        if name in named and name not in SAMPLERS and f"sample-{name}" not in STREAMS
    ]


def _unknown(name: str, said: str, file: Path) -> InputError:
    what = (
        f"whether {said} does not hold has to be known at the end, "
        f"and '{name}' has no classifier here"
    )
    return InputError(
        what, file=file, remedy=f"Name its file: --sampler {name}=FILE.py, or FILE.safetensors"
    )
