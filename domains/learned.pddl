; A mobile manipulator carries bodies between surfaces and containers, those of movable bodies too: towers, trays, boxes.
; Like the cupboard, but a pose on a body that moves counts for one pose of that body: on and inside hold of the two together.
; Between actions the arm is at its home configuration; a pick or a place reaches out from there and returns.
(define (domain learned)
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
    (at-base ?b - base-conf)
    (riding ?o - movable ?p - pose ?below - movable ?pb - pose)  ; as it stood at ?p on ?below at ?pb
    ; what streams certify
    (pose ?o - movable ?p - pose)
    (grounded ?o - movable ?p - pose)                 ; nothing that moves is under it
    (supported ?o - movable ?p - pose ?s - surface)
    (contained ?o - movable ?p - pose ?c - container)
    (borne ?o - movable ?p - pose ?below - movable ?pb - pose)
    (stacked ?o - movable ?p - pose ?s - surface ?below - movable ?pb - pose)
    (packed ?o - movable ?p - pose ?c - container ?below - movable ?pb - pose)
    (sampled ?o - movable ?p - pose)                  ; drawn for itself, or a start
    (shifted ?o - movable ?p - pose ?below - movable ?pb - pose ?pb2 - pose ?p2 - pose)
    (reachable ?o - movable ?p - pose)
    (grasp ?o - movable ?g - grasp)
    (standing ?b - base-conf)
    (kin ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    (base-motion ?b - base-conf ?t - motion)
    (pick-motion ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    (place-motion ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    (pose-clear ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (approach ?o - movable ?p - pose ?g - grasp)
    (approach-clear ?o - movable ?p - pose ?g - grasp ?o2 - movable ?p2 - pose)
    (reach-clear ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?o2 - movable ?p2 - pose)
    ; what the scene says: places of fixed bodies; and what the goal may want on a place of a movable one
    (anchored ?s - object)
    (portable ?o - movable)                                      ; the goal wants it somewhere, with what is on it
    (stackable ?o - movable ?s - object ?below - movable)
    ; of the goal: it leaves open where ?o is; it wants ?o on or in this place; where it may leave ?o
    (unbound ?o - movable)
    (meant ?o - movable ?s - object)
    (settled ?o - movable ?p - pose)
    ; what follows
    (on ?o - body ?s - surface)
    (inside ?o - body ?c - container)
    (loaded ?o - movable ?p - pose)
    (busy ?o - movable)
    (pose-blocked ?o - movable ?p - pose)
    (approach-blocked ?o - movable ?p - pose ?g - grasp)
    (reach-blocked ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    ; stack: learned from 12 + 12 demonstrations
    (wanted-stack ?o - movable ?o2 - movable)  ; the planner says of which the goal may want it
    (also-stack ?o - movable ?o2 - movable)
    (proposed-stack ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (stack-pose ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (stack ?o - movable ?o2 - movable)
    ; pack: learned from 12 + 12 demonstrations
    (wanted-pack ?o - movable ?o2 - movable)  ; the planner says of which the goal may want it
    (also-pack ?o - movable ?o2 - movable)
    (proposed-pack ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (pack-pose ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (pack ?o - movable ?o2 - movable)
    ; left_of: learned from 12 + 12 demonstrations
    (wanted-left_of ?o - movable ?o2 - movable)  ; the planner says of which the goal may want it
    (also-left_of ?o - movable ?o2 - movable)
    (proposed-left_of ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (left_of-pose ?o - movable ?p - pose ?o2 - movable ?p2 - pose)
    (left_of ?o - movable ?o2 - movable)
    ; between: learned from 12 + 12 demonstrations
    (wanted-between ?o - movable ?o2 - movable ?o3 - movable)  ; the planner says of which the goal may want it
    (also-between ?o - movable ?o2 - movable ?o3 - movable)
    (proposed-between ?o - movable ?p - pose ?o2 - movable ?p2 - pose ?o3 - movable ?p3 - pose)
    (between-pose ?o - movable ?p - pose ?o2 - movable ?p2 - pose ?o3 - movable ?p3 - pose)
    (between ?o - movable ?o2 - movable ?o3 - movable))
  (:functions (total-cost))

  (:derived (on ?o - body ?s - surface)
    (exists (?p - pose) (and (supported ?o ?p ?s) (at-pose ?o ?p))))
  (:derived (on ?o - body ?s - surface)
    (exists (?p - pose ?below - movable ?pb - pose)
      (and (stacked ?o ?p ?s ?below ?pb) (at-pose ?o ?p) (at-pose ?below ?pb))))
  (:derived (inside ?o - body ?c - container)
    (exists (?p - pose) (and (contained ?o ?p ?c) (at-pose ?o ?p))))
  (:derived (inside ?o - body ?c - container)
    (exists (?p - pose ?below - movable ?pb - pose)
      (and (packed ?o ?p ?c ?below ?pb) (at-pose ?o ?p) (at-pose ?below ?pb))))
  (:derived (loaded ?o - movable ?p - pose)
    (exists (?o2 - movable ?p2 - pose) (and (borne ?o2 ?p2 ?o ?p) (at-pose ?o2 ?p2))))
  (:derived (busy ?o - movable)
    (exists (?o2 - movable ?p2 - pose ?below - movable ?pb - pose)
      (and (riding ?o2 ?p2 ?below ?pb) (not (= ?o ?below)))))
  (:derived (pose-blocked ?o - movable ?p - pose)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (pose-clear ?o ?p ?o2 ?p2)))))
  (:derived (approach-blocked ?o - movable ?p - pose ?g - grasp)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (approach-clear ?o ?p ?g ?o2 ?p2)))))
  (:derived (reach-blocked ?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach)
    (exists (?o2 - movable ?p2 - pose)
      (and (at-pose ?o2 ?p2) (not (= ?o ?o2)) (not (reach-clear ?o ?p ?g ?b ?q ?o2 ?p2)))))
  (:derived (stack ?o - movable ?o2 - movable)
    (exists (?p - pose ?p2 - pose) (and (stack-pose ?o ?p ?o2 ?p2) (at-pose ?o ?p) (at-pose ?o2 ?p2))))
  (:derived (pack ?o - movable ?o2 - movable)
    (exists (?p - pose ?p2 - pose) (and (pack-pose ?o ?p ?o2 ?p2) (at-pose ?o ?p) (at-pose ?o2 ?p2))))
  (:derived (left_of ?o - movable ?o2 - movable)
    (exists (?p - pose ?p2 - pose) (and (left_of-pose ?o ?p ?o2 ?p2) (at-pose ?o ?p) (at-pose ?o2 ?p2))))
  (:derived (between ?o - movable ?o2 - movable ?o3 - movable)
    (exists (?p - pose ?p2 - pose ?p3 - pose) (and (between-pose ?o ?p ?o2 ?p2 ?o3 ?p3) (at-pose ?o ?p) (at-pose ?o2 ?p2) (at-pose ?o3 ?p3))))

  (:action move
    :parameters (?b - base-conf ?t - motion)
    :precondition (base-motion ?b ?t)
    :effect (and (forall (?from - base-conf) (when (at-base ?from) (not (at-base ?from))))
                 (at-base ?b)
                 (increase (total-cost) 1)))

  (:action pick
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (pick-motion ?o ?p ?g ?b ?q ?t)
                       (hand-empty) (at-base ?b) (at-pose ?o ?p)
                       (not (loaded ?o ?p)) (not (busy ?o))
                       (not (approach-blocked ?o ?p ?g)) (not (reach-blocked ?o ?p ?g ?b ?q)))
    :effect (and (holding ?o ?g) (not (hand-empty)) (not (at-pose ?o ?p))
                 (increase (total-cost) 1)))

  (:action place
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion)
    :precondition (and (place-motion ?o ?p ?g ?b ?q ?t)
                       (holding ?o ?g) (at-base ?b) (grounded ?o ?p)
                       (not (pose-blocked ?o ?p)) (not (approach-blocked ?o ?p ?g)) (not (reach-blocked ?o ?p ?g ?b ?q)))
    :effect (and (at-pose ?o ?p) (hand-empty) (not (holding ?o ?g))
                 (increase (total-cost) 1)))

  (:action place-on
    :parameters (?o - movable ?p - pose ?g - grasp ?b - base-conf ?q - reach ?t - motion
                 ?below - movable ?pb - pose)
    :precondition (and (place-motion ?o ?p ?g ?b ?q ?t)
                       (holding ?o ?g) (at-base ?b)
                       (borne ?o ?p ?below ?pb) (at-pose ?below ?pb)
                       (not (pose-blocked ?o ?p)) (not (approach-blocked ?o ?p ?g)) (not (reach-blocked ?o ?p ?g ?b ?q)))
    :effect (and (at-pose ?o ?p) (hand-empty) (not (holding ?o ?g))
                 (increase (total-cost) 1)))

  ; What is on a tray goes where the tray goes. These two say so, nothing moves: from ride to alight only the tray is handled.
  (:action ride
    :parameters (?o - movable ?p - pose ?below - movable ?pb - pose)
    :precondition (and (portable ?below) (sampled ?o ?p) (borne ?o ?p ?below ?pb)
                       (hand-empty) (at-pose ?o ?p) (at-pose ?below ?pb)
                       (not (loaded ?o ?p)) (not (busy ?below)))
    :effect (and (riding ?o ?p ?below ?pb) (not (at-pose ?o ?p))
                 (increase (total-cost) 0)))

  (:action alight
    :parameters (?o - movable ?p - pose ?below - movable ?pb - pose ?pb2 - pose ?p2 - pose)
    :precondition (and (shifted ?o ?p ?below ?pb ?pb2 ?p2)
                       (hand-empty) (riding ?o ?p ?below ?pb) (at-pose ?below ?pb2))
    :effect (and (at-pose ?o ?p2) (not (riding ?o ?p ?below ?pb))
                 (increase (total-cost) 0))))
