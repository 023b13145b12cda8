"""Plans by the book: which step breaks and why, over rules, quantifiers, types and facts of one state."""

from __future__ import annotations

import pytest

from tamp.symbolic.pddl.parser import parse_domain, parse_goal, parse_task
from tamp.symbolic.pddl.structs import Atom, Exists, Fact, Not, Parameter, Task
from tamp.symbolic.search.replay import violation

DOMAIN = parse_domain("""(define (domain shelf) (:requirements :adl :derived-predicates)
  (:types cup shelf - object)
  (:predicates (on ?c - cup ?s - shelf) (held ?c - cup) (free) (clean ?c - cup) (wet ?c - cup)
    (next ?s ?t - shelf) (near ?s ?t - shelf) (empty ?s - shelf) (seen ?x))
  (:derived (near ?s ?t) (or (next ?s ?t) (exists (?m - shelf) (and (next ?s ?m) (near ?m ?t)))))
  (:derived (empty ?s) (not (exists (?c - cup) (on ?c ?s))))
  (:action take :parameters (?c - cup ?s - shelf)
    :precondition (and (free) (on ?c ?s)) :effect (and (held ?c) (not (free)) (not (on ?c ?s))))
  (:action put :parameters (?c - cup ?s ?t - shelf)
    :precondition (and (held ?c) (near ?s ?t) (empty ?t))
    :effect (and (on ?c ?t) (free) (not (held ?c))))
  (:action shake :parameters () :precondition ()
    :effect (forall (?c - cup) (when (wet ?c) (and (not (wet ?c)) (clean ?c)))))
  (:action note :parameters () :precondition ()
    :effect (forall (?c - cup) (when (not (wet ?c)) (clean ?c))))
  (:action swap :parameters () :precondition () :effect (and (free) (not (free)))))""")
TASK = parse_task(
    """(define (problem p) (:domain shelf) (:objects mug jar - cup low mid top - shelf)
  (:init (on mug low) (on jar mid) (free) (next low mid) (next mid top) (wet jar))
  (:goal (on mug top)))""",
    DOMAIN,
)
TAKE, PUT = ("take", ("mug", "low")), ("put", ("mug", "low", "top"))


def told(
    *actions: tuple[str, tuple[str, ...]], goal: str = "(on mug top)", **more: object
) -> str | None:
    wanted = parse_goal(goal, DOMAIN, TASK.objects)
    task = Task(TASK.name, DOMAIN, TASK.objects, TASK.initial, wanted, {})
    return violation(task, actions, **more)  # type: ignore[arg-type]


def test_a_plan_that_leads_to_the_goal_has_nothing_wrong() -> None:
    """top is near low through mid, by a rule that rests on itself."""
    assert told(TAKE, PUT) is None
    assert told(goal="(on mug low)") is None


@pytest.mark.parametrize(
    ("actions", "words"),
    [
        ([("grab", ("mug",))], "step 1, (grab mug): there is no such action"),
        ([("take", ("mug",))], "step 1, (take mug): there is no such action"),
        ([("take", ("low", "low"))], "step 1, (take low low): 'low' is no cup"),
        ([("take", ("cat", "low"))], "step 1, (take cat low): 'cat' is no cup"),
        ([TAKE, TAKE], "step 2, (take mug low): the precondition does not hold, (free)"),
        (
            [TAKE, ("put", ("mug", "low", "mid"))],
            "step 2, (put mug low mid): the precondition does not hold, (empty mid)",
        ),
        (
            [TAKE, ("put", ("mug", "mid", "low"))],
            "step 2, (put mug mid low): the precondition does not hold, (near mid low)",
        ),
        ([TAKE], "the goal does not hold in the end, (on mug top)"),
    ],
)
def test_the_step_that_breaks_is_named_with_what_it_lacks(
    actions: list[tuple[str, tuple[str, ...]]], words: str
) -> None:
    assert told(*actions) == words


@pytest.mark.parametrize(
    ("goal", "holds"),
    [
        ("(forall (?c - cup) (exists (?s - shelf) (on ?c ?s)))", True),
        ("(forall (?c - cup) (on ?c low))", False),
        ("(exists (?c - cup) (and (on ?c mid) (wet ?c)))", True),
        ("(exists (?c - cup) (and (on ?c low) (wet ?c)))", False),
        ("(or (wet mug) (not (held mug)))", True),
        ("(forall (?c - cup) (imply (wet ?c) (on ?c mid)))", True),
        ("(forall (?s - shelf) (empty ?s))", False),
        ("(exists (?s - shelf) (and (empty ?s) (near low ?s)))", True),
        ("(and (cup mug) (not (= mug jar)))", True),
        ("(exists (?x) (and (shelf ?x) (not (cup ?x))))", True),
    ],
)
def test_conditions_hold_as_they_are_written(goal: str, holds: bool) -> None:
    assert (told(goal=goal) is None) is holds


def test_effects_look_at_the_state_before_and_adding_wins() -> None:
    assert told(("shake", ()), goal="(and (clean jar) (not (wet jar)) (not (clean mug)))") is None
    assert told(("note", ()), goal="(and (clean mug) (not (clean jar)))") is None
    assert told(("swap", ()), goal="(free)") is None


def test_a_variable_stands_for_objects_of_its_type_only() -> None:
    for type_, wrong in (("cup", None), ("shelf", "the goal does not hold in the end")):
        found = told(goal=f"(exists (?x - {type_}) (seen ?x))", facts=[("seen", "mug")])
        assert (found or "").startswith(wrong or "") and (found is None) is (wrong is None)


def test_what_streams_certified_holds_everywhere_or_in_the_states_that_it_was_shown() -> None:
    assert told(goal="(near top low)") == "the goal does not hold in the end, (near top low)"
    assert told(goal="(near top low)", facts=[("next", "top", "low")]) is None

    def shown(state: frozenset[Fact]) -> list[Fact]:
        return [("next", "top", "low")] if ("held", "mug") in state else []

    assert told(TAKE, goal="(near top low)", shown=shown) is None
    assert told(goal="(near top low)", shown=shown) is not None


def test_objects_made_by_streams_are_there_with_their_types() -> None:
    made = {"#s1": ("shelf",), "#c1": ("cup",)}
    put = ("put", ("mug", "low", "#s1"))
    near = [("next", "low", "#s1")]
    assert told(TAKE, put, goal="(held mug)", facts=near, objects=made) == (
        "the goal does not hold in the end, (held mug)"
    )
    wrong = told(TAKE, ("put", ("mug", "low", "#c1")), facts=near, objects=made)
    assert wrong == "step 2, (put mug low #c1): '#c1' is no shelf"
    assert "'#s1' is no shelf" in str(told(TAKE, put, facts=near))


def test_a_variable_of_a_quantifier_hides_one_of_its_name() -> None:
    """As made in Python; the parser renames them."""
    inner = Exists((Parameter("?c", ("cup",)),), Atom("wet", ("?c",)))
    outer = Exists((Parameter("?c", ("cup",)),), Not(inner))
    task = Task(TASK.name, DOMAIN, TASK.objects, TASK.initial, outer, {})
    assert violation(task, ()) is not None  # jar is wet whatever the outer one is
