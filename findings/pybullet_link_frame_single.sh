#!/usr/bin/env bash
# pybullet: getLinkState tells the same link's place twice, once in double and once in single precision.
#
# Expected: with computeForwardKinematics the link's frame (entries 4 and 5) is as exact as its centre of mass (entry 0).
# For a link whose two frames coincide both entries are the same point.
#
# Seen 2026-11-29 with pybullet 3.2.7, Python 3.11, Linux x86-64: entry 0 is exact, entry 4 is rounded to a float: 1.5 um
# off at 100 m from the origin, 1.6 mm at 45 km (where a map's coordinates may put a robot).
source "$(dirname "$(realpath "$0")")/prelude"
install pybullet==3.2.7 numpy==2.4.6
cat > look.py <<'PYTHON'
import numpy as np
import pybullet

BODY = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
open("arm.urdf", "w").write(
    f'<robot name="arm"><link name="base">{BODY}</link><link name="tip">{BODY}</link><joint name="j" type="revolute">'
    '<parent link="base"/><child link="tip"/><origin xyz="0.1 0.2 0.3"/><axis xyz="0 0 1"/>'
    '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>'
)
pybullet.connect(pybullet.DIRECT)
for far in (0.0, 100.0, 45_000.0):
    arm = pybullet.loadURDF("arm.urdf", basePosition=[far, 0, 0], useFixedBase=True)
    state = pybullet.getLinkState(arm, 0, computeForwardKinematics=True)
    true = far + 0.1
    mass, frame = abs(state[0][0] - true), abs(state[4][0] - true)
    print(f"{far:8.0f} m: entry 0 off by {1e6 * mass:.4f} um, entry 4 by {1e6 * frame:.1f} um")
    assert mass < 1e-9
    assert state[4][0] == float(np.float32(true))
PYTHON
"$PY" look.py
