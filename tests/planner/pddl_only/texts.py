"""Problems in PDDL for these tests: errands with a van, and shopping with a ticket."""

DOMAIN = """\
(define (domain errands)
  (:requirements :adl :derived-predicates :action-costs)
  (:types place thing - object car truck - thing)
  (:constants home - place)
  (:predicates (at ?t - thing ?p - place) (road ?a ?b - place) (broken ?t - thing) (served ?p - place)
    (linked ?a ?b - place) (unused ?t - thing))
  (:functions (total-cost) - number (length ?a ?b - place) - number)
  (:derived (linked ?a ?b - place) (or (road ?a ?b) (exists (?c - place) (and (road ?a ?c) (linked ?c ?b)))))
  (:action drive
    :parameters (?t - thing ?a ?b - place)
    :precondition (and (at ?t ?a) (road ?a ?b) (not (broken ?t)) (imply (= ?b home) (served ?a)))
    :effect (and (at ?t ?b) (not (at ?t ?a)) (when (not (linked ?b home)) (broken ?t))
                 (forall (?p - place) (when (= ?p ?b) (served ?p))) (increase (total-cost) (length ?a ?b))))
  (:action tow
    :parameters (?t - (either car truck)) :precondition (broken ?t)
    :effect (and (not (broken ?t)) (increase (total-cost) 10))))
"""

PROBLEM = """\
(define (problem round)
  (:domain errands)
  (:objects a b c - place van - truck)
  (:init (at van home) (road home a) (road a home) (road a b) (road b c) (road home b) (road b home)
         (= (length home a) 3) (= (length a home) 3) (= (length a b) 1) (= (length b c) 1)
         (= (length home b) 5) (= (length b home) 2) (= (total-cost) 0))
  (:goal (and (exists (?p - place) (and (served ?p) (not (linked ?p home)))) (not (broken van))))
  (:metric minimize (total-cost)))
"""

SHOP = """\
(define (domain shop)
  (:requirements :strips :typing :action-costs)
  (:types item)
  (:predicates (have ?i - item) (ticket))
  (:functions (total-cost) - number)
  (:action buy-ticket :effect (and (ticket) (increase (total-cost) 5)))
  (:action get :parameters (?i - item) :precondition (ticket) :effect (and (have ?i) (increase (total-cost) 1)))
  (:action take :parameters (?i - item) :effect (and (have ?i) (increase (total-cost) 3))))
"""

SHOPPING = """\
(define (problem shopping) (:domain shop) (:objects a b c d - item) (:init (= (total-cost) 0))
  (:goal (and (have a) (have b) (have c) (have d))) (:metric minimize (total-cost)))
"""
