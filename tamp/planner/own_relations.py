"""Relations of the user's own in a problem: asked of classifiers at the start and where negated.

A classifier decides wherever the relation is asked for: its facts of the initial state are among
the initial facts, and where a condition needs the relation to be false, that is certified by a
stream of its own, for poses of any origin. A relation without a classifier is unknown until a
stream certifies it.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import partial

from tamp.errors import InputError
from tamp.geometric.context import Context
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY, Classifier
from tamp.geometric.streams.user_relations import fails_relation
from tamp.planner.relation_samplers import Served
from tamp.relations.observed import ClassifierAnswers, moved, observe, refuse_silent
from tamp.stream import StreamKind
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.pddl.complement import atoms_of_conditions, complement_name, with_complements
from tamp.symbolic.pddl.relations import (
    POSE,
    Relation,
    failing,
    needed_false,
    relation_names,
    relation_of,
)
from tamp.symbolic.pddl.structs import Domain, Fact, Formula, StreamFile

CLASSIFIER_REMEDY = (
    "Give it a classifier: --sampler {0}=FILE.py with classify, "
    "or weights of 100 labels, some of them negative"
)

MAX_ARGUMENTS_TOLD = 3
"""Arguments that a warning about a classifier names."""


@dataclass(frozen=True)
class Decided:
    """A task in which classifiers have decided what they can.

    Attributes:
        domain: With the complements of what some condition needs to be false.
        goal: Over these.
        facts: What the classifiers say about the initial state.
        streams: Certify the complements.
        complements: Their predicates, of which the user's files know nothing.
        classifiers: By relation, of those that were asked.
        relations: The same relations.
        warnings: What is odd about a classifier.
    """

    domain: Domain
    goal: Formula
    facts: frozenset[Fact] = frozenset()
    streams: tuple[BoundStream, ...] = ()
    complements: frozenset[str] = frozenset()
    classifiers: Mapping[str, Classifier] = field(default_factory=dict[str, Classifier])
    relations: Mapping[str, Relation] = field(default_factory=dict[str, Relation])
    warnings: tuple[str, ...] = ()


def decided(
    served: Served,
    declared: StreamFile,
    domain: Domain,
    goal: Formula,
    objects: Mapping[str, tuple[str, ...]],
    facts: Collection[Fact],
    context: Context,
) -> Decided:
    """Ask the classifiers of the user's own relations about the initial state.

    Args:
        served: The objects.
        declared: The streams.
        domain: The domain.
        goal: The goal.
        objects: Types by name.
        facts: The initial facts.
        context: Of the scene.

    Raises:
        InputError: A condition needs to know that a relation does not hold, and nothing says so; or
            a classifier answers nothing.
    """
    relations: dict[str, Relation] = {}
    own = [name for name in relation_names(declared) if name not in SAMPLERS]
    for name in own:
        if name in served.generators or name in served.classifiers:
            relation = relation_of(declared, domain, name)
            if relation is not None and name in served.classifiers:
                relations[name] = relation
            elif relation is not None:
                _refuse_unknown(relation, domain, goal, served.undecided.get(name))

    unused = tuple(
        f"no stream is named 'sample-{name}' or 'test-{name}': "
        f"the grounding of '{name}' is not used"
        for name in dict.fromkeys((*served.generators, *served.classifiers))
        if name not in own and name not in SAMPLERS
    )
    asked = {atom.predicate for atom, _ in atoms_of_conditions(domain, goal)}
    relations = {name: one for name, one in relations.items() if one.predicates & asked}

    classifiers = {name: served.classifiers[name] for name in relations}
    seen = {
        name: _observed(one, classifiers[name], domain, objects, facts, context)
        for name, one in relations.items()
    }
    known = frozenset(fact for one in seen.values() for fact in one.holds)
    warnings = unused + tuple(
        line for name, one in seen.items() for line in _odd(relations[name], one)
    )

    negated = {
        name: one for name, one in relations.items() if needed_false(domain, goal, one.predicates)
    }
    if not negated:
        return Decided(
            domain, goal, known, classifiers=classifiers, relations=relations, warnings=warnings
        )
    for relation in negated.values():
        _check_poses(relation, domain)

    names = {
        one: complement_name(one, domain)
        for relation in negated.values()
        for one in relation.predicates
    }
    false = {(names[fact[0]], *fact[1:]) for name in negated for fact in seen[name].fails}
    streams = tuple(
        BoundStream(
            failing(one, domain),
            partial(fails_relation, context, classifier=classifiers[name]),
            (),
            kind=StreamKind.TESTS,
        )
        for name, one in negated.items()
    )

    rewritten, wanted = with_complements(domain, goal, names)
    hidden = frozenset(names.values())
    return Decided(
        rewritten, wanted, known | false, streams, hidden, classifiers, relations, warnings
    )


def _observed(
    relation: Relation,
    classifier: Classifier,
    domain: Domain,
    objects: Mapping[str, tuple[str, ...]],
    facts: Collection[Fact],
    context: Context,
) -> ClassifierAnswers:
    at = {fact[1]: fact[2] for fact in facts if fact[0] in (POSE, "at-pose") and len(fact) == 3}
    held = context.holding
    scene = moved(context.scene, {}, () if held is None else (held.body,))
    seen = observe(relation, classifier, scene, domain, objects, facts, at)
    refuse_silent(relation.name, seen)
    return seen


def _refuse_unknown(relation: Relation, domain: Domain, goal: Formula, why: str | None) -> None:
    atom = needed_false(domain, goal, relation.predicates)
    if atom is None:
        return
    place, name = atom.place, relation.name
    said = f"({' '.join((atom.predicate, *atom.terms))})"
    reason = f"its classifier cannot tell yet: {why}" if why else "it has no classifier"
    raise InputError(
        f"whether {said} does not hold has to be known here, "
        f"and '{name}' is unknown until a plan makes it true: "
        f"{reason}",
        file=place.file if place else None,
        line=place.line if place else None,
        column=place.column if place else None,
        remedy=CLASSIFIER_REMEDY.format(name),
    )


def _check_poses(relation: Relation, domain: Domain) -> None:
    declared = domain.predicates.get(POSE)
    if relation.poses and (declared is None or len(declared.parameters) != 2):
        what = (
            f"whether '{relation.name}' does not hold is asked of every pose, "
            "and the domain has no (pose ?o ?p)"
        )
        raise InputError(
            what, file=domain.file, remedy="Declare it, and certify it of what is sampled"
        )


def _odd(relation: Relation, seen: ClassifierAnswers) -> list[str]:
    """Warn of a classifier that failed, or that ignores the place that it is asked about."""
    found: list[str] = []
    for words, why in list(seen.unanswered.items())[:MAX_ARGUMENTS_TOLD]:
        said = " ".join((relation.name, *words))
        found.append(
            f"whether ({said}) holds at the start is not known: "
            f"asked of it, the classifier failed: {why}"
        )

    if (
        len(relation.arguments) == 2
        and len(relation.bodies) == 1
        and relation.arguments[0] in relation.bodies
    ):
        by_body: dict[str, list[float]] = {}
        for (body, _), answer in seen.answers.items():
            by_body.setdefault(body, []).append(answer)
        same = [
            body
            for body, answers in by_body.items()
            if answers[1:] and min(answers) >= LIKELY_PROBABILITY
        ]
        if same:
            found.append(
                f"'{relation.name}' holds of {same[0]} at the start "
                "whatever its second argument is: its classifier "
                "should look at that, too, if it matters where the body is"
            )

    return found
