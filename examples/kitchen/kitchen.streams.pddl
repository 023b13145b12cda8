; The cupboard's streams, and those of `lying` and `near`, marked with NEW.
(define (stream kitchen)
  (:stream sample-grasp
    :inputs (?o) :domain (movable ?o)
    :outputs (?g) :certified (grasp ?o ?g))

  ; A generator may look at the scene, but certifies nothing about it: collisions have tests of their own.
  (:stream sample-on
    :inputs (?o ?s) :domain (and (movable ?o) (surface ?s))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (supported ?o ?p ?s)))
  (:stream sample-inside
    :inputs (?o ?c) :domain (and (movable ?o) (container ?c))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (contained ?o ?p ?c)))

  ; NEW: a learned generator
  (:stream sample-lying
    :inputs (?o ?s) :domain (and (movable ?o) (surface ?s))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (laid ?o ?p ?s)))
  ; NEW: a generator and a classifier in Python; a pose among the inputs is that of the body before it.
  ; `supported` keeps it finite: near what stands on a surface, not near what is near what is near ...
  (:stream sample-near
    :inputs (?o ?o2 ?p2 ?s) :domain (and (movable ?o) (supported ?o2 ?p2 ?s))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (proposed-near ?o ?p ?o2 ?p2)))
  (:stream test-near
    :inputs (?o ?p ?o2 ?p2) :domain (proposed-near ?o ?p ?o2 ?p2)
    :certified (near-pose ?o ?p ?o2 ?p2))

  (:stream test-reachable
    :inputs (?o ?p) :domain (pose ?o ?p)
    :certified (reachable ?o ?p))
  ; The hand alone among the fixed bodies, before there is an arm or a base: cheap, and it fails for the same reasons.
  (:stream test-approach
    :inputs (?o ?p ?g) :domain (and (pose ?o ?p) (grasp ?o ?g))
    :certified (approach ?o ?p ?g))
  (:stream inverse-kinematics
    :inputs (?o ?p ?g) :domain (and (pose ?o ?p) (reachable ?o ?p) (grasp ?o ?g) (approach ?o ?p ?g))
    :outputs (?b ?q) :certified (and (standing ?b) (kin ?o ?p ?g ?b ?q)))

  (:stream test-pose-clear
    :inputs (?o ?p ?o2 ?p2) :domain (and (pose ?o ?p) (pose ?o2 ?p2))
    :certified (pose-clear ?o ?p ?o2 ?p2))
  (:stream test-approach-clear
    :inputs (?o ?p ?g ?o2 ?p2) :domain (and (approach ?o ?p ?g) (pose ?o2 ?p2))
    :certified (approach-clear ?o ?p ?g ?o2 ?p2))
  (:stream test-reach-clear
    :inputs (?o ?p ?g ?b ?q ?o2 ?p2) :domain (and (kin ?o ?p ?g ?b ?q) (pose ?o2 ?p2))
    :certified (reach-clear ?o ?p ?g ?b ?q ?o2 ?p2))

  (:stream plan-base-motion
    :inputs (?b) :domain (standing ?b)
    :fluents (at-base at-pose holding)
    :outputs (?t) :certified (base-motion ?b ?t))
  (:stream plan-pick
    :inputs (?o ?p ?g ?b ?q) :domain (kin ?o ?p ?g ?b ?q)
    :fluents (at-pose)
    :outputs (?t) :certified (pick-motion ?o ?p ?g ?b ?q ?t))
  (:stream plan-place
    :inputs (?o ?p ?g ?b ?q) :domain (kin ?o ?p ?g ?b ?q)
    :fluents (at-pose)
    :outputs (?t) :certified (place-motion ?o ?p ?g ?b ?q ?t)))
