#!/usr/bin/env bash
# MuJoCo reading URDF: a link named "world" is taken for MuJoCo's own world, and the joint that mounts it is dropped with its offset.
#
# Expected: the link stands where its joint puts it, as in other readers, or an error that the name is taken.
# Descriptions whose root is mounted on a link called "world" are common (xarm7's, for one): the robot then stands elsewhere, silently.
#
# Seen 2026-11-30 with mujoco-core 4.0.0 and pin 4.1.0, Python 3.11, Linux x86-64: a joint lifts link "world" by 0.5 m above the root
#   named "world"   MuJoCo: tip at 0.2 m, pinocchio: 0.7 m        named "mount"   both 0.7 m
source "$(dirname "$(realpath "$0")")/prelude"
install mujoco-core==4.0.0 pin==4.1.0 numpy==2.4.6
cat > look.py <<'PYTHON'
import mujoco
import numpy as np
import pinocchio


def urdf(name):
    body = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    return f"""<robot name="r">
<mujoco><compiler fusestatic="false"/></mujoco>
<link name="floor">{body}</link><link name="{name}">{body}</link><link name="tip">{body}</link>
<joint name="lift" type="fixed"><parent link="floor"/><child link="{name}"/><origin xyz="0 0 0.5"/></joint>
<joint name="turn" type="revolute"><parent link="{name}"/><child link="tip"/><origin xyz="0 0 0.2"/>
<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
</robot>"""


def heights(name):
    model = mujoco.MjModel.from_xml_string(urdf(name))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    here = float(data.body("tip").xpos[2])

    other = pinocchio.buildModelFromXML(urdf(name))
    state = other.createData()
    pinocchio.framesForwardKinematics(other, state, np.zeros(other.nq))
    return here, float(state.oMf[other.getFrameId("tip")].translation[2])


for name in ("world", "mount"):
    print(name, "MuJoCo {:.3f} m, pinocchio {:.3f} m".format(*heights(name)))
here, there = heights("world")
assert abs(there - 0.7) < 1e-9 and abs(here - 0.2) < 1e-9
assert np.allclose(heights("mount"), 0.7)
PYTHON
"$PY" look.py
