#!/usr/bin/env bash
# A sliding joint whose axis is not of unit length moves another way in each half of the readers of URDF.
#
# Valid: URDF's <axis> says a direction ("should be normalized", not must); <axis xyz="0 0 2"/> is met in files made by
# exporters. The joint is set to 0.3 m.
#
# Seen 2026-11-29 on Python 3.11, Linux x86-64, way of the child along z:
#   pinocchio 4.1.0      0.3
#   mujoco-core 4.0.1    0.3
#   pybullet 3.2.7       0.6      the same model at another place, no warning
#   yourdfpy 0.0.60      0.6
# All four agree on a turning joint with that axis.
source "$(dirname "$(realpath "$0")")/prelude"
install yourdfpy==0.0.60 pin==4.1.0 pybullet==3.2.7 mujoco-core==4.0.1
cat > look.py <<'PYTHON'
import math

import mujoco
import numpy as np
import pinocchio
import pybullet
import yourdfpy

BODY = (
    '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
)
JOINT = '<parent link="{}"/><child link="{}"/><axis xyz="0 0 2"/><limit lower="-1" upper="1" effort="1" velocity="1"/>'
open("lift.urdf", "w").write(
    f'<robot name="lift"><link name="base">{BODY}</link><link name="post">{BODY}</link><link name="arm">{BODY}</link>'
    f'<joint name="a_slide" type="prismatic">{JOINT.format("base", "post")}</joint>'
    f'<joint name="b_turn" type="revolute">{JOINT.format("post", "arm")}</joint></robot>'
)
WAY, TURN = 0.3, 0.5

model = pinocchio.buildModelFromUrdf("lift.urdf")
data = model.createData()
pinocchio.framesForwardKinematics(model, data, np.array([WAY, TURN]))
slid, turned = data.oMf[model.getFrameId("post")], data.oMf[model.getFrameId("arm")]
ways = {"pinocchio": slid.translation[2]}
turns = {"pinocchio": math.atan2(turned.rotation[1, 0], turned.rotation[0, 0])}

compiled = mujoco.MjModel.from_xml_path("lift.urdf")
state = mujoco.MjData(compiled)
state.qpos[:] = WAY, TURN
mujoco.mj_kinematics(compiled, state)
ways["mujoco"] = state.body("post").xpos[2]
rotation = state.body("arm").xmat.reshape(3, 3)
turns["mujoco"] = math.atan2(rotation[1, 0], rotation[0, 0])

pybullet.connect(pybullet.DIRECT)
body = pybullet.loadURDF("lift.urdf", useFixedBase=True)
for joint, value in enumerate((WAY, TURN)):
    pybullet.resetJointState(body, joint, value)
links = [pybullet.getLinkState(body, link, computeForwardKinematics=True) for link in range(2)]
ways["pybullet"] = links[0][4][2]
turns["pybullet"] = pybullet.getEulerFromQuaternion(links[1][5])[2]

urdf = yourdfpy.URDF.load("lift.urdf")
urdf.update_cfg([WAY, TURN])
ways["yourdfpy"] = urdf.get_transform("post", "base")[2, 3]
T = urdf.get_transform("arm", "base")
turns["yourdfpy"] = math.atan2(T[1, 0], T[0, 0])

for name in ways:
    print(f"{name:10} way {ways[name]:.3f} m   turn {turns[name]:.3f} rad")
assert {name: round(float(way), 3) for name, way in ways.items()} == {
    "pinocchio": 0.3, "mujoco": 0.3, "pybullet": 0.6, "yourdfpy": 0.6
}
assert all(abs(turn - TURN) < 1e-6 for turn in turns.values())
PYTHON
"$PY" look.py
