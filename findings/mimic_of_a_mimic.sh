#!/usr/bin/env bash
# A joint that mimics a joint that mimics another: five readers of URDF, four answers.
#
# Valid: URDF's <mimic> names "the joint to mimic" and does not ask that it be driven itself. Underactuated fingers are
# written so. Joints here: a, b = 2 a + 0.1, c = 0.5 b. At a = 0.4 the angles are 0.4, 0.9, 0.45.
#
# Seen 2026-11-29 on Python 3.11, Linux x86-64:
#   yourdfpy 0.0.60            [0.4, 0.9, 0.0]     c stays at its offset; a line on stderr says so, the call succeeds
#   pinocchio 4.1.0            ValueError          with mimic=True; names are in an order that it takes otherwise
#   pybullet 3.2.7             3 free joints       <mimic> is not read
#   roboticstoolbox 1.5.0      3 free joints       likewise
#   mujoco-core 4.0.1          2 equalities        b follows a, c follows b: the chain
source "$(dirname "$(realpath "$0")")/prelude"
install yourdfpy==0.0.60 pin==4.1.0 pybullet==3.2.7 mujoco-core==4.0.1 roboticstoolbox-python==1.5.0
cat > hand.py <<'PYTHON'
LINK = (
    '<link name="{}"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
JOINT = (
    '<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/><axis xyz="0 0 1"/>'
    '<limit lower="-3" upper="3" effort="1" velocity="1"/>{}</joint>'
)
links = [LINK.format(name) for name in ("palm", "near", "middle", "far")]
joints = [
    JOINT.format("a", "palm", "near", ""),
    JOINT.format("b", "near", "middle", '<mimic joint="a" multiplier="2" offset="0.1"/>'),
    JOINT.format("c", "middle", "far", '<mimic joint="b" multiplier="0.5"/>'),
]
open("hand.urdf", "w").write(f'<robot name="hand">{"".join(links + joints)}</robot>')
PYTHON
"$PY" hand.py
cat > look.py <<'PYTHON'
import math
import os
import warnings

warnings.simplefilter("ignore")
import mujoco
import pinocchio
import pybullet
import roboticstoolbox
import yourdfpy

model = yourdfpy.URDF.load("hand.urdf")
model.update_cfg([0.4])
pairs = (("palm", "near"), ("near", "middle"), ("middle", "far"))
turns = [model.get_transform(child, parent) for parent, child in pairs]
angles = [round(math.atan2(T[1, 0], T[0, 0]), 6) + 0.0 for T in turns]
print("yourdfpy", angles)
assert angles == [0.4, 0.9, 0.0]

try:
    pinocchio.buildModelFromUrdf("hand.urdf", mimic=True)
    refused = False
except ValueError:
    refused = True
print("pinocchio refuses", refused)
assert refused

pybullet.connect(pybullet.DIRECT)
body = pybullet.loadURDF("hand.urdf")
free = sum(pybullet.getJointInfo(body, i)[2] == pybullet.JOINT_REVOLUTE for i in range(pybullet.getNumJoints(body)))
print("pybullet free joints", free)
assert free == 3

count = roboticstoolbox.Robot.URDF(os.path.abspath("hand.urdf")).n
print("roboticstoolbox joints", count)
assert count == 3

compiled = mujoco.MjModel.from_xml_path("hand.urdf")
follows = [
    (compiled.joint(int(one)).name, compiled.joint(int(other)).name)
    for one, other in zip(compiled.eq_obj1id, compiled.eq_obj2id)
]
print("mujoco equalities", follows, compiled.eq_data[:, :2].tolist())
assert follows == [("b", "a"), ("c", "b")]
assert compiled.eq_data[:, :2].tolist() == [[0.1, 2.0], [0.0, 0.5]]
PYTHON
"$PY" look.py
