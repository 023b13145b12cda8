"""Whether the goal holds in what is seen."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from tamp.errors import InputError
from tamp.execution.deviation import FAR, TURNED
from tamp.execution.expected import RELATIONS, Expected
from tamp.execution.report import GoalFact
from tamp.execution.truth import Truth
from tamp.pddl.structs import Atom, Fact, Formula
from tamp.streams.choice import ANY, Registry
from tamp.streams.relations import Classifier
from tamp.verification.formulas import flat, show
from tamp.verification.semantics import State
from tamp.verification.start import apart

FLUENTS = frozenset({"holding", "hand-empty", "at-pose"})
"""Facts that are seen and not believed."""


def judged(
    goal: Formula, expected: Expected, truth: Truth, held: str | None, classifiers: Mapping[str, tuple[str, Classifier]]
) -> tuple[GoalFact, ...]:
    """Each part of the goal, by the geometry; and what the classifiers of its relations say.

    Other relations than `on` and `inside` hold as the plan has them for bodies that are where the plan put them.
    """
    facts = {(name, *row) for name, rows in expected.state.facts.items() for row in rows if name not in FLUENTS}
    facts |= {("hand-empty",)} if held is None else set()
    facts |= {fact for fact in expected.state.facts.get("holding", set()) if held and fact[0] == held.lower()}
    facts |= {("at-pose", body, pose) for body, pose in _in_place(expected, truth, held)}
    state = State.of(facts | truth.facts)
    semantics = expected.semantics.without(RELATIONS)
    found: list[GoalFact] = []
    for part in flat(goal):
        holds = semantics.holds(part, state)
        name, probability = _classified(part, truth, classifiers)
        why = None if holds else _reason(part, truth, held) or _moved(part, facts, expected)
        found.append(GoalFact(show(part), holds, why, name, probability))
    return tuple(found)


def classifiers_of(registry: Registry) -> dict[str, tuple[str, Classifier]]:
    """Relation to the name and the object of the first learned classifier whose weights are there."""
    found: dict[str, tuple[str, Classifier]] = {}
    for relation, makers in registry.items():
        if relation == ANY:
            continue
        for name, make in makers.items():
            classifier = _made(make)
            if classifier is not None:
                found[relation] = name, classifier
                break
    return found


def _made(make: Callable[[], object]) -> Classifier | None:
    try:
        made = make()
    except InputError:  # no weights
        return None
    return made if isinstance(made, Classifier) else None


def _classified(
    part: Formula, truth: Truth, classifiers: Mapping[str, tuple[str, Classifier]]
) -> tuple[str | None, float | None]:
    if not isinstance(part, Atom) or part.predicate not in classifiers:
        return None, None
    name, classifier = classifiers[part.predicate]
    scene = truth.scene
    names = {one.lower(): one for one in (*scene.bodies, *scene.surfaces, *scene.cavities)}
    if not all(term in names for term in part.terms):
        return None, None
    return name, float(classifier.classify(scene, [names[term] for term in part.terms]))


def _in_place(expected: Expected, truth: Truth, held: str | None) -> Iterator[tuple[str, str]]:
    """Bodies and poses, in PDDL's names, of those that are seen where the plan has them."""
    bodies = {name.lower(): name for name in truth.scene.movable if name != held}
    for terms in expected.state.all("at-pose"):
        value = expected.plan.values.get(terms[-1])
        if len(terms) != 2 or terms[0] not in bodies or value is None or value.type != "pose":
            continue
        moved, turned = apart(value.data, truth.scene.bodies[bodies[terms[0]]].pose.matrix)
        if moved < FAR and turned < TURNED:
            yield terms[0], terms[1]


def _moved(part: Formula, facts: set[Fact], expected: Expected) -> str | None:
    """That a body of a relation of the user's own is elsewhere than the plan has it."""
    if not isinstance(part, Atom) or part.predicate in RELATIONS:
        return None
    placed = {terms[0] for terms in expected.state.all("at-pose")}
    seen = {fact[1] for fact in facts if fact[0] == "at-pose"}
    gone = [body for body in part.terms if body in placed - seen]
    return f"{gone[0]} is not where the plan put it" if gone else None


def _reason(part: Formula, truth: Truth, held: str | None) -> str | None:
    if not isinstance(part, Atom) or not part.terms:
        return None
    body = part.terms[0]
    if held is not None and body == held.lower():
        return "it is in the hand"
    if body not in {name.lower() for name in truth.scene.bodies}:
        return "it is gone"
    return truth.reasons.get((part.predicate, *part.terms))
