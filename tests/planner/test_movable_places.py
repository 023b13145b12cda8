"""Places of movable bodies: which bodies have a top, which pairs a goal allows, circles of goals."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box, Cavity, Cylinder, Part, Scene, Surface
from tamp.planner.movable_places import (
    check_circle,
    circle,
    place_facts,
    remedied,
    with_tops,
)
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import (
    And,
    Atom,
    Domain,
    Exists,
    Fact,
    Forall,
    Formula,
    Not,
    Or,
    Parameter,
)
from tamp.system.files import find_domain
from tests.geometric.making import body, cuboid, hull, scene, table


@pytest.fixture(scope="module")
def carriers() -> Domain:
    file = find_domain("carriers")
    return parse_domain(read_pddl(file), file)


def tray(name: str = "Tray", **more: object) -> Body:
    top = Surface(name, name, Pose((0.0, 0.0, 0.01)), (0.3, 0.3))
    return body(name, Box((0.3, 0.3, 0.02)), (0.0, 0.0, 0.51), surfaces=(top,), **more)


def cube(name: str, **more: object) -> Body:
    return body(name, Box((0.06, 0.06, 0.06)), (0.0, 0.0, 0.53), **more)


def kitchen() -> Scene:
    return scene(table(), tray(), cube("Cup"), cube("Jar"))


def on(one: str, place: str) -> Atom:
    return Atom("on", (one, place))


def facts(goal: Formula, domain: Domain, where: Scene | None = None) -> set[Fact]:
    return place_facts(where or kitchen(), domain, goal)


def pairs(goal: Formula, domain: Domain, where: Scene | None = None) -> set[tuple[str, ...]]:
    return {fact[1:] for fact in facts(goal, domain, where) if fact[0] == "stackable"}


# ---------------------------------------------------------------- which pairs a goal allows


def test_places_of_fixed_bodies_are_anchored_in_pddls_case(carriers: Domain) -> None:
    anchored = {fact for fact in facts(And(()), carriers) if fact[0] == "anchored"}
    assert anchored == {("anchored", "table")}


def test_a_goal_that_names_both_allows_that_pair_alone(carriers: Domain) -> None:
    assert pairs(on("cup", "tray"), carriers) == {("cup", "tray", "tray")}
    assert pairs(on("cup", "table"), carriers) == set()


def test_a_variable_stands_for_every_body_but_the_place_itself(carriers: Domain) -> None:
    some = Exists((Parameter("?o", ("movable",)),), on("?o", "tray"))
    assert pairs(some, carriers) == {("cup", "tray", "tray"), ("jar", "tray", "tray")}
    anywhere = Forall((Parameter("?s", ("surface",)),), on("cup", "?s"))
    assert pairs(anywhere, carriers) == {("cup", "tray", "tray")}


@pytest.mark.parametrize(
    "goal",
    [
        Not(on("cup", "tray")),
        Or((on("cup", "tray"), on("jar", "table"))),
        And((on("cup", "tray"),)),
    ],
)
def test_atoms_are_found_wherever_they_stand(goal: Formula, carriers: Domain) -> None:
    assert pairs(goal, carriers) == {("cup", "tray", "tray")}


def test_a_place_has_the_name_of_its_body_below(carriers: Domain) -> None:
    inside = Cavity("drawer", "Box", Pose((0.0, 0.0, 0.01)), (0.2, 0.2, 0.1))
    box = body("Box", Box((0.2, 0.2, 0.02)), (0.0, 0.0, 0.51), cavities=(inside,))
    wanted = Atom("inside", ("cup", "drawer"))
    assert pairs(wanted, carriers, scene(table(), box, cube("Cup"))) == {("cup", "drawer", "box")}


def test_a_rule_of_ones_own_may_mean_any_two_of_its_arguments(carriers: Domain) -> None:
    rule = replace(carriers.derived[0], head=replace(carriers.derived[0].head, predicate="near"))
    own = replace(carriers, derived=(*carriers.derived, rule))
    assert "near" in own.derived_predicates
    goal = Atom("near", ("cup", "tray"))
    assert pairs(goal, own) == {("cup", "tray", "tray")}
    assert pairs(Atom("unknown", ("cup", "tray")), own) == set()


# ---------------------------------------------------------------- what is carried with its load


def portable(goal: Formula, domain: Domain, where: Scene) -> set[str]:
    return {fact[1] for fact in facts(goal, domain, where) if fact[0] == "portable"}


def test_a_body_that_goes_with_two_others_on_it_is_a_tray(carriers: Domain) -> None:
    goal = And((on("cup", "tray"), on("jar", "tray"), on("tray", "table")))
    assert portable(goal, carriers, kitchen()) == {"tray"}


def test_the_base_of_a_tower_is_put_down_first(carriers: Domain) -> None:
    goal = And((on("cup", "tray"), on("tray", "table")))
    assert portable(goal, carriers, kitchen()) == set()


def test_what_is_on_it_already_may_ride_along(carriers: Domain) -> None:
    goal = And((on("cup", "tray"), on("tray", "table")))
    loaded = scene(table(), tray(), cube("Cup", carriers=("Tray",)), cube("Jar"))
    assert portable(goal, carriers, loaded) == {"tray"}


def test_a_tray_that_the_goal_leaves_where_it_is_is_not_carried(carriers: Domain) -> None:
    goal = And((on("cup", "tray"), on("jar", "tray")))
    assert portable(goal, carriers, kitchen()) == set()


# ---------------------------------------------------------------- tops


def test_a_flat_top_becomes_a_surface_of_the_bodys_name() -> None:
    (top,) = with_tops(scene(cube("Cup"))).bodies["Cup"].surfaces
    assert (top.name, top.body) == ("Cup", "Cup")
    assert top.pose.position == pytest.approx((0.0, 0.0, 0.03))
    assert top.size == pytest.approx((0.06, 0.06))


@pytest.mark.parametrize(
    "bodied",
    [
        table("fixed", (1.0, 1.0)),
        cube("bare", bare=True),
        body("thin", Box((0.019, 0.3, 0.1)), (0.0, 0.0, 0.5)),
        Body(
            "cup",
            (
                Part(Box((0.1, 0.1, 0.1))),
                Part(hull(cuboid((0.1, 0.1, 0.1))), Pose((0.1, 0, 0))),
            ),
            Pose(),
            True,
        ),
    ],
    ids=lambda one: one.name,
)
def test_what_is_fixed_declared_narrow_or_of_several_hulls_has_none(bodied: Body) -> None:
    assert with_tops(scene(bodied)).bodies[bodied.name] is bodied


def test_a_lying_can_has_no_top() -> None:
    lying = replace(
        body("can", Cylinder(0.03, 0.1), (0.0, 0.0, 0.5)),
        pose=Pose.from_xyz_rpy((0.0, 0.0, 0.5), (1.5707963, 0.0, 0.0)),
    )
    assert not with_tops(scene(lying)).bodies["can"].surfaces
    assert with_tops(scene(replace(lying, pose=Pose()))).bodies["can"].surfaces


# ---------------------------------------------------------------- circles, and the remedy


@pytest.mark.parametrize(
    ("goal", "chain"),
    [
        (And((on("cup", "jar"), on("jar", "cup"))), ("cup", "jar", "cup")),
        (
            And((on("cup", "jar"), on("jar", "tray"), on("tray", "cup"))),
            ("cup", "jar", "tray", "cup"),
        ),
        (And((on("cup", "jar"), on("jar", "tray"), on("tray", "table"))), ()),
        (on("cup", "cup"), ("cup", "cup")),
        (Or((on("cup", "jar"), on("jar", "cup"))), ()),  # one of them is enough
        (And((Not(on("cup", "jar")), on("jar", "cup"))), ()),
    ],
)
def test_a_circle_is_found_in_a_conjunction(goal: Formula, chain: tuple[str, ...]) -> None:
    assert circle(goal, kitchen()) == chain


def test_a_circle_goes_through_the_names_of_places() -> None:
    inside = Cavity("drawer", "Box", Pose((0.0, 0.0, 0.01)), (0.2, 0.2, 0.1))
    box = body("Box", Box((0.2, 0.2, 0.02)), (0.0, 0.0, 0.51), cavities=(inside,))
    goal = And((Atom("inside", ("tray", "drawer")), on("box", "tray")))
    assert circle(goal, scene(tray(), box)) == ("tray", "box", "tray")


def test_a_circle_is_an_error_at_the_goals_line() -> None:
    loaded = load_scene("stack")
    (first, second) = (name.lower() for name in loaded.scene.movable[:2])
    with pytest.raises(InputError, match=f"{first} on {second} on {first}") as caught:
        check_circle(loaded, And((on(first, second), on(second, first))))
    assert (caught.value.file, caught.value.line) == (str(loaded.path), loaded.goal.line)
    check_circle(loaded, on(first, second))


def test_only_a_movable_in_a_places_stead_gets_the_remedy(carriers: Domain) -> None:
    file = find_domain("cupboard")
    cupboard = parse_domain(read_pddl(file), file)
    error = InputError("'cup' is a movable, not a surface", line=3)
    assert "carriers" in (remedied(error, cupboard).remedy or "")
    assert remedied(error, cupboard).line == 3
    assert remedied(error, carriers) is error
    other = InputError("unknown object 'cup'")
    assert remedied(other, cupboard) is other
    told = InputError("'cup' is a movable, not a surface", remedy="Another one")
    assert remedied(told, cupboard) is told
