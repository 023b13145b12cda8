"""A plan made by hand whose every number is known, and its motions in time."""

from __future__ import annotations

import numpy as np

from tamp.export.trajectory import timed_actions
from tamp.geometric.loading.robots import ROBOTS
from tests.plan.making import arm, base, close, let_go, plan_of

ROBOT = ROBOTS["panda_mobile"]()
ARM = tuple(joint.name for joint in ROBOT.joints)
FINGERS = tuple(finger.name for finger in ROBOT.fingers)
HOME = np.array(ROBOT.home)
DOWN = HOME + np.array([0.1, 0, 0, 0, 0, 0, 0])
PLAN = plan_of(
    ("move", ("b1",), [base([0, 1, 2], [[0, 0, 0], [0.5, 0, 0.1], [1, 0, 0.2]])]),
    (
        "pick",
        ("cup",),
        [arm([0, 1], [HOME, DOWN]), close("cup", 0.05), arm([0, 1], [DOWN, HOME], 0.05, "cup")],
    ),
    ("place", ("cup",), [let_go("cup", 0.05)]),
)
ACTIONS = timed_actions(PLAN, ROBOT)
