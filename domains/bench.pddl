; An arm that does not drive carries bodies between surfaces and containers: the cupboard's domain without the drives.
; Between actions the arm is at its home configuration; a pick or a place reaches out from there and returns.
(define (domain bench)
  (:requirements :typing :equality :negative-preconditions :derived-predicates :universal-preconditions
                 :conditional-effects :action-costs)
  (:types
    movable fixed - body
    body surface container - object      ; a table is both a body and a surface
    pose grasp base-conf reach motion - object)
  (:predicates
    ; the state
    (at-pose ?o - movable ?p - pose)
    (holding ?o - movable ?g - grasp)
    (hand-empty)
    ; what streams certify
    (pose ?o - movable ?p - pose)
    (supported ?o - movable ?p - pose ?s - surface)
    (contained ?o - movable ?p - pose ?c - container)
    (reachable ?o - movable ?p - pose)
    (grasp ?o - movable ?g - grasp)
    (standing ?b - base-conf)
    (kin ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    (pick-motion ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    (place-motion ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    (pose-clear ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (approach ?o - movable ?p - pose ?g - grasp)
    (approach-clear ?o - movable ?p - pose ?g - grasp ?o2 - movable ?p2 - pose)
    (reach-clear ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?o2 - movable ?p2 - pose)
    ; what the scene says at the start: a body stands on another one
    (rests-on ?o - movable ?p - pose ?below - movable)
    ; what follows
    (on ?o - body ?s - surface)
    (inside ?o - body ?c - container)
    (loaded ?o - movable)
    (pose-blocked ?o - movable ?p - pose)
    (approach-blocked ?o - movable ?p - pose ?g - grasp)
    (reach-blocked ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach))
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
  (:derived (approach-blocked ?o - movable ?p - pose ?g - grasp)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (approach-clear ?o ?p ?g ?o2 ?p2)))))
  (:derived (reach-blocked ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (reach-clear ?o ?p ?g ?b ?q ?o2 ?p2)))))

  (:action pick
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (pick-motion ?o ?p ?g ?b ?q ?t)
                       (hand-empty) (at-pose ?o ?p)
                       (not (loaded ?o)) (not (approach-blocked ?o ?p ?g)) (not (reach-blocked ?o ?p ?g ?b ?q)))
    :effect (and (holding ?o ?g) (not (hand-empty)) (not (at-pose ?o ?p))
                 (increase (total-cost) 1)))

  (:action place
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (place-motion ?o ?p ?g ?b ?q ?t)
                       (holding ?o ?g)
                       (not (pose-blocked ?o ?p)) (not (approach-blocked ?o ?p ?g)) (not (reach-blocked ?o ?p ?g ?b ?q)))
    :effect (and (at-pose ?o ?p) (hand-empty) (not (holding ?o ?g))
                 (increase (total-cost) 1))))
