; Where the bench's values come from: those of the cupboard, all from where the robot stands. A relation is grounded by two streams: sample-<relation> and test-<relation>.
(define (stream bench)
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

  (:stream test-reachable
    :inputs (?o ?p) :domain (pose ?o ?p)
    :certified (reachable ?o ?p))
  ; The hand alone among the fixed bodies, before there is an arm or a base: cheap, and it fails for the same reasons.
  (:stream test-approach
    :inputs (?o ?p ?g) :domain (and (pose ?o ?p) (grasp ?o ?g))
    :certified (approach ?o ?p ?g))
  (:stream inverse-kinematics-here
    :inputs (?o ?p ?g ?b) :domain (and (pose ?o ?p) (reachable ?o ?p) (grasp ?o ?g) (approach ?o ?p ?g) (standing ?b))
    :outputs (?q) :certified (kin ?o ?p ?g ?b ?q))

  (:stream test-pose-clear
    :inputs (?o ?p ?o2 ?p2) :domain (and (pose ?o ?p) (pose ?o2 ?p2))
    :certified (pose-clear ?o ?p ?o2 ?p2))
  (:stream test-approach-clear
    :inputs (?o ?p ?g ?o2 ?p2) :domain (and (approach ?o ?p ?g) (pose ?o2 ?p2))
    :certified (approach-clear ?o ?p ?g ?o2 ?p2))
  (:stream test-reach-clear
    :inputs (?o ?p ?g ?b ?q ?o2 ?p2) :domain (and (kin ?o ?p ?g ?b ?q) (pose ?o2 ?p2))
    :certified (reach-clear ?o ?p ?g ?b ?q ?o2 ?p2))

  (:stream plan-pick
    :inputs (?o ?p ?g ?b ?q) :domain (kin ?o ?p ?g ?b ?q)
    :fluents (at-pose)
    :outputs (?t) :certified (pick-motion ?o ?p ?g ?b ?q ?t))
  (:stream plan-place
    :inputs (?o ?p ?g ?b ?q) :domain (kin ?o ?p ?g ?b ?q)
    :fluents (at-pose)
    :outputs (?t) :certified (place-motion ?o ?p ?g ?b ?q ?t)))
