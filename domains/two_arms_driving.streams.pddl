; Where the values of several arms on a base that drives come from: those of the cupboard, each for one of the arms. A relation
; is grounded by two streams: sample-<relation> and test-<relation>.
(define (stream two_arms_driving)
  (:stream sample-grasp-by
    :inputs (?a ?o) :domain (and (arm ?a) (movable ?o))
    :outputs (?g) :certified (grasp ?a ?o ?g))

  ; A generator may look at the scene, but certifies nothing about it: collisions have tests of their own.
  (:stream sample-on
    :inputs (?o ?s) :domain (and (movable ?o) (surface ?s))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (supported ?o ?p ?s) (grounded ?o ?p)))
  (:stream sample-inside
    :inputs (?o ?c) :domain (and (movable ?o) (container ?c))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (contained ?o ?p ?c) (grounded ?o ?p)))

  (:stream test-reachable-by
    :inputs (?a ?o ?p) :domain (and (arm ?a) (pose ?o ?p))
    :certified (reachable ?a ?o ?p))
  ; The hand alone among the fixed bodies, before there is an arm or a base: cheap, and it fails for the same reasons.
  (:stream test-approach-by
    :inputs (?a ?o ?p ?g) :domain (and (pose ?o ?p) (grasp ?a ?o ?g))
    :certified (approach ?a ?o ?p ?g))
  (:stream base-placement-by
    :inputs (?a ?o ?p ?g)
    :domain (and (reachable ?a ?o ?p) (grasp ?a ?o ?g) (approach ?a ?o ?p ?g))
    :outputs (?b ?q) :certified (and (standing ?b) (kin ?a ?o ?p ?g ?b ?q)))

  (:stream test-pose-clear
    :inputs (?o ?p ?o2 ?p2) :domain (and (pose ?o ?p) (pose ?o2 ?p2))
    :certified (pose-clear ?o ?p ?o2 ?p2))
  (:stream test-approach-clear-by
    :inputs (?a ?o ?p ?g ?o2 ?p2) :domain (and (approach ?a ?o ?p ?g) (pose ?o2 ?p2))
    :certified (approach-clear ?a ?o ?p ?g ?o2 ?p2))
  (:stream test-reach-clear-by
    :inputs (?a ?o ?p ?g ?b ?q ?o2 ?p2) :domain (and (kin ?a ?o ?p ?g ?b ?q) (pose ?o2 ?p2))
    :certified (reach-clear ?a ?o ?p ?g ?b ?q ?o2 ?p2))

  (:stream plan-base-motion-by
    :inputs (?b) :domain (standing ?b)
    :fluents (at-base at-pose holding)
    :outputs (?t) :certified (base-motion ?b ?t))
  (:stream plan-pick-by
    :inputs (?a ?o ?p ?g ?b ?q) :domain (kin ?a ?o ?p ?g ?b ?q)
    :fluents (at-pose holding)
    :outputs (?t) :certified (pick-motion ?a ?o ?p ?g ?b ?q ?t))
  (:stream plan-place-by
    :inputs (?a ?o ?p ?g ?b ?q) :domain (kin ?a ?o ?p ?g ?b ?q)
    :fluents (at-pose holding)
    :outputs (?t) :certified (place-motion ?a ?o ?p ?g ?b ?q ?t))

  ; Where one arm gives a body to another one, in the air: both can hold it there at once.
  (:stream sample-handover
    :inputs (?a ?o ?g ?a2 ?g2 ?b) :domain (and (grasp ?a ?o ?g) (grasp ?a2 ?o ?g2) (standing ?b))
    :outputs (?p ?q ?q2) :certified (exchange ?a ?o ?g ?a2 ?g2 ?b ?p ?q ?q2))
  (:stream plan-handover
    :inputs (?a ?o ?g ?a2 ?g2 ?b ?p ?q ?q2) :domain (exchange ?a ?o ?g ?a2 ?g2 ?b ?p ?q ?q2)
    :fluents (at-pose holding)
    :outputs (?t) :certified (handover-motion ?a ?o ?g ?a2 ?g2 ?b ?p ?q ?q2 ?t)))
