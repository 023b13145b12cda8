; A body with several arms drives, and carries bodies between surfaces and containers: the domain two_arms with the base of
; the cupboard's. Between actions all arms are at home, in which the base drives with what they hold; while one arm moves,
; base and other arms hold still.
(define (domain two_arms_driving)
  (:requirements :typing :equality :negative-preconditions :derived-predicates :universal-preconditions
                 :conditional-effects :action-costs)
  (:types
    movable fixed - body
    body surface container - object      ; a table is both a body and a surface
    arm pose grasp base-conf reach motion - object)
  (:predicates
    ; the state
    (at-pose ?o - movable ?p - pose)
    (holding ?a - arm ?o - movable ?g - grasp)
    (hand-empty ?a - arm)
    (at-base ?b - base-conf)
    ; what streams certify
    (pose ?o - movable ?p - pose)
    (grounded ?o - movable ?p - pose)                 ; it stands there, and nothing that moves is under it
    (supported ?o - movable ?p - pose ?s - surface)
    (contained ?o - movable ?p - pose ?c - container)
    (reachable ?a - arm ?o - movable ?p - pose)
    (grasp ?a - arm ?o - movable ?g - grasp)
    (standing ?b - base-conf)
    (kin ?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    (base-motion ?b - base-conf ?t - motion)
    (pick-motion ?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    (place-motion ?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    ; ?a and ?a2 hold it at once, at ?p in the air
    (exchange ?a - arm ?o - movable ?g - grasp ?a2 - arm ?g2 - grasp ?b - base-conf ?p - pose ?q - reach ?q2 - reach)
    (handover-motion ?a - arm ?o - movable ?g - grasp ?a2 - arm ?g2 - grasp ?b - base-conf ?p - pose ?q - reach ?q2 - reach
                     ?t - motion)
    (pose-clear ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (approach ?a - arm ?o - movable ?p - pose ?g - grasp)
    (approach-clear ?a - arm ?o - movable ?p - pose ?g - grasp ?o2 - movable ?p2 - pose)
    (reach-clear ?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?o2 - movable ?p2 - pose)
    ; what the scene says at the start: a body stands on another one
    (rests-on ?o - movable ?p - pose ?below - movable)
    ; what follows
    (on ?o - body ?s - surface)
    (inside ?o - body ?c - container)
    (loaded ?o - movable)
    (pose-blocked ?o - movable ?p - pose)
    (approach-blocked ?a - arm ?o - movable ?p - pose ?g - grasp)
    (reach-blocked ?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach))
  (:functions (total-cost))

  (:derived (on ?o - body ?s - surface)
    (exists (?p - pose) (and (supported ?o ?p ?s) (at-pose ?o ?p))))
  (:derived (inside ?o - body ?c - container)
    (exists (?p - pose) (and (contained ?o ?p ?c) (at-pose ?o ?p))))
  (:derived (loaded ?o - movable)
    (exists (?o2 - movable ?p2 - pose) (and (rests-on ?o2 ?p2 ?o) (at-pose ?o2 ?p2))))
  (:derived (pose-blocked ?o - movable ?p - pose)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (pose-clear ?o ?p ?o2 ?p2)))))
  (:derived (approach-blocked ?a - arm ?o - movable ?p - pose ?g - grasp)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (approach-clear ?a ?o ?p ?g ?o2 ?p2)))))
  (:derived (reach-blocked ?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (reach-clear ?a ?o ?p ?g ?b ?q ?o2 ?p2)))))

  (:action move
    :parameters (?b - base-conf ?t - motion)
    :precondition (base-motion ?b ?t)
    :effect (and (forall (?from - base-conf) (when (at-base ?from) (not (at-base ?from))))
                 (at-base ?b)
                 (increase (total-cost) 1)))

  ; What is reached is a condition of its own: the search then avoids the arm that does not get there.
  (:action pick
    :parameters (?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (reachable ?a ?o ?p) (approach ?a ?o ?p ?g) (kin ?a ?o ?p ?g ?b ?q) (pick-motion ?a ?o ?p ?g ?b ?q ?t)
                       (hand-empty ?a) (at-base ?b) (at-pose ?o ?p) (not (loaded ?o))
                       (not (approach-blocked ?a ?o ?p ?g)) (not (reach-blocked ?a ?o ?p ?g ?b ?q)))
    :effect (and (holding ?a ?o ?g) (not (hand-empty ?a)) (not (at-pose ?o ?p))
                 (increase (total-cost) 1)))

  (:action place
    :parameters (?a - arm ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (reachable ?a ?o ?p) (approach ?a ?o ?p ?g) (kin ?a ?o ?p ?g ?b ?q) (place-motion ?a ?o ?p ?g ?b ?q ?t)
                       (holding ?a ?o ?g) (at-base ?b) (grounded ?o ?p)
                       (not (pose-blocked ?o ?p)) (not (approach-blocked ?a ?o ?p ?g)) (not (reach-blocked ?a ?o ?p ?g ?b ?q)))
    :effect (and (at-pose ?o ?p) (hand-empty ?a) (not (holding ?a ?o ?g))
                 (increase (total-cost) 1)))

  (:action handover
    :parameters (?a - arm ?o - movable ?g - grasp ?a2 - arm ?g2 - grasp ?b - base-conf ?p - pose ?q - reach ?q2 - reach
                 ?t - motion)
    :precondition (and (exchange ?a ?o ?g ?a2 ?g2 ?b ?p ?q ?q2) (handover-motion ?a ?o ?g ?a2 ?g2 ?b ?p ?q ?q2 ?t)
                       (holding ?a ?o ?g) (hand-empty ?a2) (at-base ?b) (not (= ?a ?a2)))
    :effect (and (holding ?a2 ?o ?g2) (hand-empty ?a) (not (holding ?a ?o ?g)) (not (hand-empty ?a2))
                 (increase (total-cost) 1))))
