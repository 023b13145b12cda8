"""A solution of `one_object` made by hand: nothing is planned."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tamp.geometric.scene.pose import Pose
from tamp.geometric.values import BaseConf, Grasp
from tamp.planner.problem import load_problem
from tamp.planner.solution import Action, Solution
from tamp.planner.timed_trajectories import Segment, Trajectory
from tamp.symbolic.algorithms.result import Outcome

GRASP = Grasp("Soup_Can", Pose((0.0, 0.0, 0.1)), 0.066)
RIDER = ("Lid", Pose((0.0, 0.0, 0.06)))
TIMES = np.array([0.0, 2.0])

MOVE = Action(
    "move",
    ("q0", "t1", "q1"),
    (),
    Trajectory((Segment("base", TIMES, np.array([[0.0, 0, 0], [1, -1e-12, 0.25]]), 0.08),)),
    0.0,
)
PICK = Action(
    "pick",
    ("soup_can", "p0", "g0"),
    ("soup_can",),
    Trajectory(
        (
            Segment("gripper", TIMES / 4, np.array([[0.08], [0.066]]), 0.08, attach=GRASP, load=(RIDER,)),
            Segment("arm", TIMES, np.zeros((2, 7)), 0.066, "Soup_Can", arm="left"),
            Segment("gripper", TIMES / 4, np.array([[0.066], [0.08]]), 0.066, detach="Soup_Can"),
        )
    ),
    2.0,
)  # fmt: skip


def solution_of(**fields: Any) -> Solution:
    """Two actions: the base drives a metre in two seconds; the hand closes, lifts and opens in three."""
    solved = Solution(
        load_problem("one_object"),
        Outcome.SOLVED,
        seed=3,
        algorithm="adaptive",
        plan=(MOVE, PICK),
        values={"q0": BaseConf(0.0, 0.0, 0.0), "g0": GRASP},
    )
    return replace(solved, **fields)
