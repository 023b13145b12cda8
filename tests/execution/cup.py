"""A cup that stands on a table, and the domain in which it is taken into a crate."""

from __future__ import annotations

from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Box
from tamp.plan.read import TimedAction
from tamp.symbolic.pddl.parser import parse_domain
from tests.geometric.making import body, crate, scene, table

DOMAIN = parse_domain("""(define (domain d) (:requirements :typing :derived-predicates)
  (:types movable surface container pose grasp - object)
  (:predicates (at-pose ?o - movable ?p - pose) (holding ?o - movable ?g - grasp) (hand-empty)
    (supported ?o - movable ?p - pose ?s - surface) (contained ?o - movable ?p - pose ?c - container)
    (on ?o - movable ?s - surface) (inside ?o - movable ?c - container))
  (:derived (on ?o ?s) (exists (?p - pose) (and (supported ?o ?p ?s) (at-pose ?o ?p))))
  (:derived (inside ?o ?c) (exists (?p - pose) (and (contained ?o ?p ?c) (at-pose ?o ?p))))
  (:action pick :parameters (?o - movable ?p - pose ?g - grasp)
    :effect (and (not (at-pose ?o ?p)) (holding ?o ?g) (not (hand-empty))))
  (:action place :parameters (?o - movable ?p - pose ?g - grasp)
    :effect (and (at-pose ?o ?p) (not (holding ?o ?g)) (hand-empty))))""")


SCENE = scene(table(), crate(), body("Cup", Box((0.1, 0.1, 0.1)), (0.2, 0, 0.551)))


START, GOAL, GRASP = (
    Pose((0.2, 0, 0.551)).matrix,
    Pose((2.0, 0, 0.071)).matrix,
    Pose((0, 0, 0.1)).matrix,
)


def act(name: str, *arguments: str) -> TimedAction:
    return TimedAction(name, arguments, 0.0, 1.0, 1.0, ())


PICK, PLACE = act("pick", "cup", "p0", "g"), act("place", "cup", "p1", "g")
