; Blocks on a line, one gripper: untyped, as domains for PDDLStream are.
(define (domain line)
  (:requirements :strips :equality)
  (:constants @ground)
  (:predicates
    (Block ?b) (Region ?r) (Placeable ?b ?r)
    (Pose ?b ?p) (Conf ?q) (Traj ?t)
    (Contained ?b ?p ?r) (Kin ?b ?q ?p) (Motion ?q1 ?t ?q2) (Collision ?b1 ?p1 ?b2 ?p2)
    (AtPose ?b ?p) (AtConf ?q) (Holding ?b) (HandEmpty) (CanMove)
    (In ?b ?r) (UnsafePose ?b ?p))
  (:functions (Distance ?q1 ?q2))

  (:action move
    :parameters (?q1 ?t ?q2)
    :precondition (and (Motion ?q1 ?t ?q2) (AtConf ?q1) (CanMove))
    :effect (and (AtConf ?q2) (not (AtConf ?q1)) (not (CanMove)) (increase (total-cost) (Distance ?q1 ?q2))))
  (:action pick
    :parameters (?b ?p ?q)
    :precondition (and (Kin ?b ?q ?p) (AtConf ?q) (AtPose ?b ?p) (HandEmpty))
    :effect (and (Holding ?b) (CanMove) (not (AtPose ?b ?p)) (not (HandEmpty)) (increase (total-cost) 1)))
  (:action place
    :parameters (?b ?p ?q)
    :precondition (and (Kin ?b ?q ?p) (AtConf ?q) (Holding ?b) (not (UnsafePose ?b ?p)))
    :effect (and (AtPose ?b ?p) (HandEmpty) (CanMove) (not (Holding ?b)) (increase (total-cost) 1)))

  (:derived (In ?b ?r) (exists (?p) (and (Contained ?b ?p ?r) (AtPose ?b ?p))))
  (:derived (UnsafePose ?b ?p)
    (exists (?b2 ?p2) (and (Pose ?b ?p) (Pose ?b2 ?p2) (not (= ?b ?b2)) (Collision ?b ?p ?b2 ?p2) (AtPose ?b2 ?p2)))))
