"""The scene in a domain's words: objects with types, facts that the domain declares, values behind names."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Box
from tamp.geometric.values import BaseConf, Grasp
from tamp.planner.initial_state import START_BASE, initial_state
from tamp.symbolic.pddl.parser import parse_domain
from tamp.symbolic.pddl.structs import Domain
from tests.geometric.making import body, crate, scene, table

PREDICATES = """(at-pose ?o - movable ?p - pose) (pose ?o ?p) (at-base ?b) (standing ?b) (hand-empty)
  (holding ?o ?g) (grasp ?o ?g) (supported ?o ?p ?s) (contained ?o ?p ?c) (rests-on ?o ?p ?b)"""
TYPED = parse_domain(f"""(define (domain typed) (:requirements :typing)
  (:types movable fixed - body body surface container pose grasp base-conf - object)
  (:predicates {PREDICATES}))""")
UNTYPED = parse_domain("""(define (domain untyped)
  (:predicates (movable ?o) (fixed ?o) (body ?o) (surface ?o) (at-pose ?o ?p) (hand-empty)))""")

CUP = body("Cup", Box((0.1, 0.1, 0.1)), (0.2, 0.0, 0.551), support="table")
LID = body("lid", Box((0.1, 0.1, 0.02)), (0.2, 0.0, 0.612), support="Cup", carriers=("Cup",))
TOY = body("toy", Box((0.1, 0.1, 0.1)), (2.0, 0.0, 0.071), support="crate_inside")
SCENE = scene(table(), crate(), CUP, LID, TOY, base=(0.1, -0.2, 0.3))


def facts(domain: Domain, *bodies: Body, holding: Grasp | None = None) -> set[tuple[str, ...]]:
    return initial_state(scene(*bodies) if bodies else SCENE, domain, holding).facts


def test_objects_have_the_types_that_the_scene_says() -> None:
    found = initial_state(SCENE, TYPED).objects
    assert found["cup"] == ("movable",) and found["crate"] == ("fixed",)
    assert found["table"] == ("fixed", "surface")  # a body and its only surface share the name
    assert found["crate_inside"] == ("container",)
    assert found["cup_start"] == ("pose",) and found[START_BASE] == ("base-conf",)


def test_names_are_lower_case_and_lead_to_the_scenes() -> None:
    values = initial_state(SCENE, TYPED).values
    assert values["cup"] == "Cup" and values["cup_start"] == CUP.pose
    assert values[START_BASE] == BaseConf(0.1, -0.2, 0.3)


def test_bodies_are_where_they_start_and_on_what_they_stand() -> None:
    found = facts(TYPED)
    assert {("pose", "cup", "cup_start"), ("at-pose", "cup", "cup_start"), ("hand-empty",)} <= found
    assert ("supported", "cup", "cup_start", "table") in found
    assert ("contained", "toy", "toy_start", "crate_inside") in found
    assert ("at-base", START_BASE) in found and ("standing", START_BASE) in found
    assert not any(fact[0] == "at-pose" and fact[1] in ("table", "crate") for fact in found)


def test_only_what_moves_is_rested_on() -> None:
    rests = {fact for fact in facts(TYPED) if fact[0] == "rests-on"}
    assert rests == {
        ("rests-on", "lid", "lid_start", "cup")
    }  # once, though it is support and carrier


def test_a_surface_of_a_movable_body_carries_its_body_along() -> None:
    tray = replace(table("tray"), movable=True, pose=Pose((0, 0, 0.25)))
    found = facts(TYPED, tray, replace(CUP, support="tray"))
    assert ("rests-on", "cup", "cup_start", "tray") in found and (
        "supported",
        "cup",
        "cup_start",
        "tray",
    ) in found


def test_what_is_in_the_hand_is_nowhere_else() -> None:
    grasp = Grasp("Cup", Pose((0, 0, 0.1)), 0.05)
    state = initial_state(SCENE, TYPED, grasp)
    assert {("grasp", "cup", "cup_held"), ("holding", "cup", "cup_held")} <= state.facts
    assert ("hand-empty",) not in state.facts
    assert not any(
        fact[0] in ("pose", "at-pose", "supported") and fact[1] == "cup" for fact in state.facts
    )
    assert state.values["cup_held"] is grasp and "cup_start" not in state.objects


def test_predicates_take_the_place_of_types() -> None:
    found = facts(UNTYPED)
    assert {
        ("movable", "cup"),
        ("body", "cup"),
        ("fixed", "table"),
        ("surface", "table"),
        ("body", "table"),
    } <= found
    assert ("body", "crate_inside") not in found
    assert initial_state(SCENE, UNTYPED).objects["cup"] == ()
    assert initial_state(SCENE, UNTYPED).objects["cup_start"] == ("object",)


def test_what_the_domain_does_not_declare_or_declares_otherwise_is_left_out() -> None:
    bare = parse_domain("(define (domain bare) (:predicates (at-pose ?o) (hand-empty)))")
    assert facts(bare) == {("hand-empty",)}


@pytest.mark.parametrize("taken", ["cup_start", "Cup_Start"])
def test_a_body_keeps_a_name_that_a_value_would_take(taken: str) -> None:
    made = scene(table(), CUP, body(taken, Box((0.1, 0.1, 0.1)), (0.4, 0, 0.551)))
    state = initial_state(made, TYPED)
    assert state.values["cup_start"] == taken and state.values["cup_start_"] == CUP.pose
    assert ("at-pose", "cup", "cup_start_") in state.facts


def test_a_constant_of_the_domain_keeps_its_name_too() -> None:
    named = parse_domain(f"""(define (domain named) (:requirements :typing)
      (:types movable fixed - body body surface container pose grasp base-conf - object)
      (:constants base_start - base-conf) (:predicates {PREDICATES}))""")
    assert ("at-base", "base_start_") in facts(named)
