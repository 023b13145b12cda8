(define (stream line)
  (:function (Distance ?q1 ?q2)
    (and (Conf ?q1) (Conf ?q2)))
  (:predicate (Collision ?b1 ?p1 ?b2 ?p2)
    (and (Pose ?b1 ?p1) (Pose ?b2 ?p2)))
  (:rule
    :inputs (?b)
    :domain (Block ?b)
    :certified (Placeable ?b @ground))

  (:stream sample-pose
    :inputs (?b ?r)
    :domain (and (Placeable ?b ?r) (Region ?r))
    :outputs (?p)
    :certified (and (Pose ?b ?p) (Contained ?b ?p ?r)))
  (:stream inverse-kinematics
    :inputs (?b ?p)
    :domain (Pose ?b ?p)
    :outputs (?q)
    :certified (and (Conf ?q) (Kin ?b ?q ?p)))
  (:stream plan-motion
    :inputs (?q1 ?q2)
    :domain (and (Conf ?q1) (Conf ?q2))
    :outputs (?t)
    :certified (and (Traj ?t) (Motion ?q1 ?t ?q2)))
  (:stream test-region
    :inputs (?b ?p ?r)
    :domain (and (Pose ?b ?p) (Placeable ?b ?r))
    :certified (Contained ?b ?p ?r)))
