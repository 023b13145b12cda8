"""Relations of the user's own, asked of their classifiers in the states that the judge sees."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import product

from tamp.geometric.scene.classifier import LIKELY_PROBABILITY, Classifier, Unanswered, probability
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.plan.read import PlanFile
from tamp.relations.observed import moved, scene_names
from tamp.simulation.world import World
from tamp.symbolic.pddl.relations import Relation, instances
from tamp.symbolic.pddl.structs import Domain, Fact
from tamp.verification.initial_state import has_standard_meaning
from tamp.verification.semantics import State
from tamp.verification.violation_log import ViolationLog


class ObservedRelations:
    """Puts what classifiers say in the place of what the plan says of their relations.

    Args:
        plan: The plan.
        world: Moved by a replay.
        domain: The plan's.
        asked: The relations with their classifiers.
        log: Where the plan's facts are noted that a classifier denies.

    Attributes:
        answers: How often each classifier answered.
        silent: Relations of which a classifier could not tell something, and why.
    """

    def __init__(
        self,
        plan: PlanFile,
        world: World,
        domain: Domain,
        asked: Mapping[str, tuple[Relation, Classifier]],
        log: ViolationLog,
    ) -> None:
        self._plan, self._world, self._domain, self._asked, self._log = (
            plan,
            world,
            domain,
            asked,
            log,
        )
        self._stated = {fact: "initial" for fact in plan.initial} | {
            fact: "certified" for fact in plan.certified
        }
        self._static = [*plan.initial, *plan.certified]
        self._elsewhere: dict[Fact, bool | None] = {}
        self._denied: set[Fact] = set()
        self.answers: Counter[str] = Counter()
        self.silent: dict[str, str] = {}

    def observed(self, state: State, in_hand: frozenset[str]) -> State:
        """Add to a state what classifiers say of bodies now, and would say of the plan's poses."""
        if not self._asked:
            return state
        facts: set[Fact] = {(name, *row) for name, rows in state.facts.items() for row in rows}
        at = (
            {row[0]: row[1] for row in state.all("at-pose")}
            if has_standard_meaning(self._domain, "at-pose")
            else {}
        )
        for relation, classifier in self._asked.values():
            for fact, answer in self._said(relation, classifier, at, in_hand):
                if answer is None:  # it cannot tell: the plan's word stands, on trust
                    continue
                (facts.add if answer else facts.discard)(fact)
                if not answer:
                    self._deny(relation, fact)
        return State.of(facts)

    def _said(
        self,
        relation: Relation,
        classifier: Classifier,
        at: Mapping[str, str],
        in_hand: frozenset[str],
    ) -> Iterator[tuple[Fact, bool | None]]:
        """Yield facts of a relation, and whether they hold; None if the classifier cannot tell."""
        world = self._world
        seen = {name: Pose.from_matrix(world.pose(name)) for name in world.scene.bodies}
        scene = moved(world.scene, seen, in_hand)
        names = scene_names(world.scene)
        poses = self._poses(at)

        for bound in instances(
            relation, self._domain, self._plan.objects, self._static, poses, names
        ):
            bodies = [bound[variable] for variable in relation.bodies]
            for chosen in product(*(poses[body] for body in bodies)):
                where = dict(zip(bodies, chosen, strict=True))
                facts = relation.substitute(bound, where)
                words = [names[bound[variable]] for variable in relation.arguments]
                if all(at.get(body) == pose for body, pose in where.items()):
                    answer = self._ask(relation, classifier, scene, words)
                elif facts[0] in self._elsewhere:
                    answer = self._elsewhere[facts[0]]
                else:
                    placed = {names[body]: self._value(pose) for body, pose in where.items()}
                    there = moved(world.scene, seen | placed, in_hand - placed.keys())
                    answer = self._elsewhere[facts[0]] = self._ask(
                        relation, classifier, there, words
                    )
                yield from ((fact, answer) for fact in facts)

    def _poses(self, at: Mapping[str, str]) -> dict[str, list[str]]:
        """List the poses that the plan has of each body."""
        found: dict[str, dict[str, None]] = {body: {pose: None} for body, pose in at.items()}
        for fact in (*self._static, *(("at-pose", *row) for row in at.items())):
            if fact[0] in ("pose", "at-pose") and len(fact) == 3:
                found.setdefault(fact[1], {})[fact[2]] = None

        for relation, _ in self._asked.values():
            for atom in relation.facts:
                places = [
                    (atom.terms.index(body), atom.terms.index(pose))
                    for pose, body in relation.poses.items()
                ]
                rows = [fact[1:] for fact in self._static if fact[0] == atom.predicate]
                for body, pose in (
                    (row[i], row[j])
                    for row in rows
                    if len(row) == len(atom.terms)
                    for i, j in places
                ):
                    found.setdefault(body, {})[pose] = None

        names = scene_names(self._world.scene)
        return {
            body: names_of_poses
            for body, poses in found.items()
            if body in names and (names_of_poses := [pose for pose in poses if self._is_pose(pose)])
        }

    def _is_pose(self, name: str) -> bool:
        value = self._plan.values.get(name)
        return value is not None and value.type == "pose"

    def _value(self, pose: str) -> Pose:
        return Pose.from_matrix(self._plan.values[pose].data)

    def _ask(
        self, relation: Relation, classifier: Classifier, scene: Scene, words: list[str]
    ) -> bool | None:
        try:
            number = probability(classifier, scene, words)
        except Unanswered as error:
            self.silent.setdefault(
                relation.name, f"asked of ({' '.join((relation.name, *words))}), {error}"
            )
            return None
        if math.isnan(number):
            self.silent.setdefault(
                relation.name, f"it cannot tell of ({' '.join((relation.name, *words))})"
            )
            return None
        self.answers[relation.name] += 1
        return number >= LIKELY_PROBABILITY

    def _deny(self, relation: Relation, fact: Fact) -> None:
        """Note, once, that a fact of the plan does not hold."""
        kind = self._stated.get(fact)
        if kind is not None and fact not in self._denied:
            self._denied.add(fact)
            message = (
                f"({' '.join(fact)}) does not hold: the classifier of '{relation.name}' denies it"
            )
            self._log.add(
                kind,
                message,
                *(fact[1 + relation.facts[0].terms.index(body)] for body in relation.bodies),
            )
