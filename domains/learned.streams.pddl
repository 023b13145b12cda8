; Where the values of learned.pddl come from. A relation is grounded by two streams: sample-<relation> and test-<relation>.
(define (stream learned)
  (:stream sample-grasp
    :inputs (?o) :domain (movable ?o)
    :outputs (?g) :certified (grasp ?o ?g))

  ; A generator may look at the scene, but certifies nothing about it: collisions have tests of their own.
  (:stream sample-on
    :inputs (?o ?s) :domain (and (movable ?o) (surface ?s) (anchored ?s))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (supported ?o ?p ?s) (grounded ?o ?p) (sampled ?o ?p)))
  (:stream sample-inside
    :inputs (?o ?c) :domain (and (movable ?o) (container ?c) (anchored ?c))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (contained ?o ?p ?c) (grounded ?o ?p) (sampled ?o ?p)))
  ; Where the goal may leave a body: only there others are put onto it.
  (:rule :inputs (?o ?p) :domain (and (unbound ?o) (pose ?o ?p)) :certified (settled ?o ?p))
  (:rule :inputs (?o ?p ?s) :domain (and (meant ?o ?s) (supported ?o ?p ?s)) :certified (settled ?o ?p))
  (:rule :inputs (?o ?p ?c) :domain (and (meant ?o ?c) (contained ?o ?p ?c)) :certified (settled ?o ?p))
  (:rule :inputs (?o ?p ?s ?below ?pb) :domain (and (meant ?o ?s) (stacked ?o ?p ?s ?below ?pb) (settled ?below ?pb))
         :certified (settled ?o ?p))
  (:rule :inputs (?o ?p ?c ?below ?pb) :domain (and (meant ?o ?c) (packed ?o ?p ?c ?below ?pb) (settled ?below ?pb))
         :certified (settled ?o ?p))

  ; On a body that moves, where it stands at ?pb.
  (:stream sample-on-movable
    :inputs (?o ?s ?below ?pb) :domain (and (stackable ?o ?s ?below) (surface ?s) (settled ?below ?pb))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (stacked ?o ?p ?s ?below ?pb) (borne ?o ?p ?below ?pb) (sampled ?o ?p)))
  (:stream sample-inside-movable
    :inputs (?o ?c ?below ?pb) :domain (and (stackable ?o ?c ?below) (container ?c) (settled ?below ?pb))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (packed ?o ?p ?c ?below ?pb) (borne ?o ?p ?below ?pb) (sampled ?o ?p)))

  ; Where it is when the body below has been carried from ?pb to ?pb2.
  (:stream shift-on
    :inputs (?o ?p ?s ?below ?pb ?pb2)
    :domain (and (portable ?below) (sampled ?o ?p) (stacked ?o ?p ?s ?below ?pb) (pose ?below ?pb2))
    :outputs (?p2) :certified (and (pose ?o ?p2) (stacked ?o ?p2 ?s ?below ?pb2) (borne ?o ?p2 ?below ?pb2)
                                   (shifted ?o ?p ?below ?pb ?pb2 ?p2)))
  (:stream shift-inside
    :inputs (?o ?p ?c ?below ?pb ?pb2)
    :domain (and (portable ?below) (sampled ?o ?p) (packed ?o ?p ?c ?below ?pb) (pose ?below ?pb2))
    :outputs (?p2) :certified (and (pose ?o ?p2) (packed ?o ?p2 ?c ?below ?pb2) (borne ?o ?p2 ?below ?pb2)
                                   (shifted ?o ?p ?below ?pb ?pb2 ?p2)))

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
    :fluents (at-base at-pose holding riding)
    :outputs (?t) :certified (base-motion ?b ?t))
  (:stream plan-pick
    :inputs (?o ?p ?g ?b ?q) :domain (kin ?o ?p ?g ?b ?q)
    :fluents (at-pose riding)
    :outputs (?t) :certified (pick-motion ?o ?p ?g ?b ?q ?t))
  (:stream plan-place
    :inputs (?o ?p ?g ?b ?q) :domain (kin ?o ?p ?g ?b ?q)
    :fluents (at-pose riding)
    :outputs (?t) :certified (place-motion ?o ?p ?g ?b ?q ?t))
  ; stack: learned from 12 + 12 demonstrations
  (:stream sample-stack
    :inputs (?o ?o2 ?p2)
    :domain (and (wanted-stack ?o ?o2) (settled ?o2 ?p2))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (borne ?o ?p ?o2 ?p2) (sampled ?o ?p) (proposed-stack ?o ?p ?o2 ?p2)))
  (:stream test-stack
    :inputs (?o ?p ?o2 ?p2) :domain (proposed-stack ?o ?p ?o2 ?p2)
    :certified (stack-pose ?o ?p ?o2 ?p2))
  (:stream test-stack-also
    :inputs (?o ?p ?o2 ?p2)
    :domain (and (also-stack ?o ?o2) (settled ?o ?p) (settled ?o2 ?p2))
    :certified (stack-pose ?o ?p ?o2 ?p2))
  (:rule :inputs (?o ?p ?o2 ?p2)
    :domain (and (wanted-stack ?o ?o2) (stack-pose ?o ?p ?o2 ?p2))
    :certified (settled ?o ?p))
  ; pack: learned from 12 + 12 demonstrations
  (:stream sample-pack
    :inputs (?o ?o2 ?p2)
    :domain (and (wanted-pack ?o ?o2) (settled ?o2 ?p2))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (borne ?o ?p ?o2 ?p2) (sampled ?o ?p) (proposed-pack ?o ?p ?o2 ?p2)))
  (:stream test-pack
    :inputs (?o ?p ?o2 ?p2) :domain (proposed-pack ?o ?p ?o2 ?p2)
    :certified (pack-pose ?o ?p ?o2 ?p2))
  (:stream test-pack-also
    :inputs (?o ?p ?o2 ?p2)
    :domain (and (also-pack ?o ?o2) (settled ?o ?p) (settled ?o2 ?p2))
    :certified (pack-pose ?o ?p ?o2 ?p2))
  (:rule :inputs (?o ?p ?o2 ?p2)
    :domain (and (wanted-pack ?o ?o2) (pack-pose ?o ?p ?o2 ?p2))
    :certified (settled ?o ?p))
  ; left_of: learned from 12 + 12 demonstrations
  (:stream sample-left_of
    :inputs (?o ?o2 ?p2 ?s)
    :domain (and (wanted-left_of ?o ?o2) (supported ?o2 ?p2 ?s) (settled ?o2 ?p2))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (supported ?o ?p ?s) (grounded ?o ?p) (sampled ?o ?p) (proposed-left_of ?o ?p ?o2 ?p2)))
  (:stream sample-left_of-inside
    :inputs (?o ?o2 ?p2 ?c)
    :domain (and (wanted-left_of ?o ?o2) (contained ?o2 ?p2 ?c) (settled ?o2 ?p2))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (contained ?o ?p ?c) (grounded ?o ?p) (sampled ?o ?p) (proposed-left_of ?o ?p ?o2 ?p2)))
  (:stream sample-left_of-on-movable
    :inputs (?o ?o2 ?p2 ?s ?below ?pb)
    :domain (and (wanted-left_of ?o ?o2) (stacked ?o2 ?p2 ?s ?below ?pb) (settled ?o2 ?p2))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (stacked ?o ?p ?s ?below ?pb) (borne ?o ?p ?below ?pb) (sampled ?o ?p) (proposed-left_of ?o ?p ?o2 ?p2)))
  (:stream sample-left_of-inside-movable
    :inputs (?o ?o2 ?p2 ?c ?below ?pb)
    :domain (and (wanted-left_of ?o ?o2) (packed ?o2 ?p2 ?c ?below ?pb) (settled ?o2 ?p2))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (packed ?o ?p ?c ?below ?pb) (borne ?o ?p ?below ?pb) (sampled ?o ?p) (proposed-left_of ?o ?p ?o2 ?p2)))
  (:stream test-left_of
    :inputs (?o ?p ?o2 ?p2) :domain (proposed-left_of ?o ?p ?o2 ?p2)
    :certified (left_of-pose ?o ?p ?o2 ?p2))
  (:stream test-left_of-also
    :inputs (?o ?p ?o2 ?p2)
    :domain (and (also-left_of ?o ?o2) (settled ?o ?p) (settled ?o2 ?p2))
    :certified (left_of-pose ?o ?p ?o2 ?p2))
  (:rule :inputs (?o ?p ?o2 ?p2)
    :domain (and (wanted-left_of ?o ?o2) (left_of-pose ?o ?p ?o2 ?p2))
    :certified (settled ?o ?p))
  ; between: learned from 12 + 12 demonstrations
  (:stream sample-between
    :inputs (?o ?o2 ?p2 ?o3 ?p3 ?s)
    :domain (and (wanted-between ?o ?o2 ?o3) (supported ?o2 ?p2 ?s) (supported ?o3 ?p3 ?s) (settled ?o2 ?p2) (settled ?o3 ?p3))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (supported ?o ?p ?s) (grounded ?o ?p) (sampled ?o ?p) (proposed-between ?o ?p ?o2 ?p2 ?o3 ?p3)))
  (:stream sample-between-inside
    :inputs (?o ?o2 ?p2 ?o3 ?p3 ?c)
    :domain (and (wanted-between ?o ?o2 ?o3) (contained ?o2 ?p2 ?c) (contained ?o3 ?p3 ?c) (settled ?o2 ?p2) (settled ?o3 ?p3))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (contained ?o ?p ?c) (grounded ?o ?p) (sampled ?o ?p) (proposed-between ?o ?p ?o2 ?p2 ?o3 ?p3)))
  (:stream sample-between-on-movable
    :inputs (?o ?o2 ?p2 ?o3 ?p3 ?s ?below ?pb)
    :domain (and (wanted-between ?o ?o2 ?o3) (stacked ?o2 ?p2 ?s ?below ?pb) (stacked ?o3 ?p3 ?s ?below ?pb) (settled ?o2 ?p2) (settled ?o3 ?p3))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (stacked ?o ?p ?s ?below ?pb) (borne ?o ?p ?below ?pb) (sampled ?o ?p) (proposed-between ?o ?p ?o2 ?p2 ?o3 ?p3)))
  (:stream sample-between-inside-movable
    :inputs (?o ?o2 ?p2 ?o3 ?p3 ?c ?below ?pb)
    :domain (and (wanted-between ?o ?o2 ?o3) (packed ?o2 ?p2 ?c ?below ?pb) (packed ?o3 ?p3 ?c ?below ?pb) (settled ?o2 ?p2) (settled ?o3 ?p3))
    :fluents (at-pose)
    :outputs (?p) :certified (and (pose ?o ?p) (packed ?o ?p ?c ?below ?pb) (borne ?o ?p ?below ?pb) (sampled ?o ?p) (proposed-between ?o ?p ?o2 ?p2 ?o3 ?p3)))
  (:stream test-between
    :inputs (?o ?p ?o2 ?p2 ?o3 ?p3) :domain (proposed-between ?o ?p ?o2 ?p2 ?o3 ?p3)
    :certified (between-pose ?o ?p ?o2 ?p2 ?o3 ?p3))
  (:stream test-between-also
    :inputs (?o ?p ?o2 ?p2 ?o3 ?p3)
    :domain (and (also-between ?o ?o2 ?o3) (settled ?o ?p) (settled ?o2 ?p2) (settled ?o3 ?p3))
    :certified (between-pose ?o ?p ?o2 ?p2 ?o3 ?p3))
  (:rule :inputs (?o ?p ?o2 ?p2 ?o3 ?p3)
    :domain (and (wanted-between ?o ?o2 ?o3) (between-pose ?o ?p ?o2 ?p2 ?o3 ?p3))
    :certified (settled ?o ?p)))
