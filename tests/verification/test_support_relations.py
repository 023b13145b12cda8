"""What plan and goal say of supports is compared with what the bodies rest on."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box, Scene
from tamp.simulation.engines import open_world
from tamp.simulation.world import World
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import And, Atom, Fact, Formula
from tamp.system.files import find_domain
from tamp.verification.semantics import Semantics, State
from tamp.verification.support_relations import SUPPORT_PREDICATES, SupportRelations
from tamp.verification.violation_log import ViolationLog
from tests.geometric.making import body, crate, scene, table
from tests.plan.making import plan_of

DOMAIN = parse_domain(find_domain("cupboard").read_text(encoding="utf-8"))
SCENE = scene(
    table(),
    crate(at=(2.0, 0.0)),
    body("cup", Box((0.06, 0.06, 0.1)), (0.0, 0.0, 0.551)),
    body("lid", Box((0.06, 0.06, 0.02)), (0.2, 0.0, 0.511)),
)
OBJECTS = {
    "table": ("fixed", "surface"),
    "crate_inside": ("container",),
    "cup": ("movable",),
    "lid": ("movable",),
    "p": ("pose",),
    "q": ("pose",),
}
AT: tuple[Fact, ...] = (("at-pose", "cup", "p"), ("at-pose", "lid", "q"))


@dataclass
class Judged:
    """A world, and what is said of it."""

    world: World
    log: ViolationLog
    scene: Scene = SCENE

    def relations(self, *certified: Fact) -> SupportRelations:
        semantics = Semantics(DOMAIN, OBJECTS)
        plan = plan_of(certified=certified)
        return SupportRelations(plan, self.world, semantics, set(SUPPORT_PREDICATES), self.log)

    def said(self) -> list[str]:
        return [one.message for one in self.log.violations]


@pytest.fixture
def judged() -> Iterator[Judged]:
    with open_world(SCENE) as world:
        yield Judged(world, ViolationLog())


@pytest.mark.parametrize(
    ("fact", "why"),
    [
        (("supported", "cup", "p", "table"), None),
        (("supported", "cup", "p", "shelf"), "there is no such surface"),
        (("contained", "cup", "p", "crate_inside"), "it protrudes by"),
        (("rests-on", "cup", "p", "table"), None),
        (("rests-on", "cup", "p", "lid"), "it rests on table"),
        (("grounded", "cup", "p"), None),
        (("borne", "cup", "p", "lid", "q"), "it rests on table"),
    ],
)
def test_a_certified_support_is_what_the_bodies_say(
    fact: Fact, why: str | None, judged: Judged
) -> None:
    judged.relations(fact).check_relations(State.of(AT), frozenset())
    (said,) = judged.said() or ("",)
    assert said.startswith(f"({' '.join(fact)}) does not hold: {why}" if why else "")
    assert bool(said) is (why is not None)


def test_it_is_checked_in_the_first_state_with_the_body_there_and_once(judged: Judged) -> None:
    checked = judged.relations(("rests-on", "cup", "p", "lid"))
    checked.check_relations(State.of(AT[1:]), frozenset())
    assert judged.said() == []
    checked.check_relations(State.of(AT), frozenset())
    checked.check_relations(State.of(AT), frozenset())
    assert len(judged.said()) == 1


def test_a_body_in_the_air_does_not_stand_unless_it_is_held(judged: Judged) -> None:
    checked = judged.relations()
    checked.check(frozenset())
    assert judged.said() == [] and checked.notes == []
    judged.world.place("cup", Pose((0.0, 0.0, 0.7)).matrix)
    checked.check(frozenset({"cup"}))
    assert judged.said() == []
    checked.check(frozenset())
    assert judged.said() == ["cup does not stand: nothing is within 10 mm below it"]


def test_what_floats_at_the_start_is_noted_and_not_the_plans_fault(judged: Judged) -> None:
    judged.world.place("lid", Pose((0.2, 0.0, 0.9)).matrix)
    checked = judged.relations()
    assert checked.notes == ["lid stands on nothing at the start, as the problem says"]
    checked.check(frozenset())
    assert judged.said() == []


def goal(*atoms: Fact) -> Formula:
    return And(tuple(Atom(fact[0], fact[1:]) for fact in atoms))


def test_a_goal_is_asked_of_the_bodies_and_the_reason_is_that_of_its_own_facts(
    judged: Judged,
) -> None:
    wanted = goal(("on", "cup", "table"))
    facts = State.of({*AT, ("supported", "cup", "p", "table")})
    judged.relations().check_goal(wanted, facts, frozenset())
    assert judged.said() == []

    judged.world.place("cup", Pose((0.0, 0.0, 0.7)).matrix)
    judged.relations().check_goal(wanted, facts, frozenset())
    (said,) = judged.said()
    assert said.startswith("(and (on cup table)) does not hold in the geometry at the end: ")
    assert said.count("(on cup table)") == 2 and "lid" not in said and "crate" not in said
