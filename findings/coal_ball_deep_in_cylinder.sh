#!/usr/bin/env bash
# coal (hpp-fcl): the depth of a ball that lies deep in a cylinder may be measured to a side that is not the nearest.
#
# Expected: the least way out, as for boxes: a ball that leaves by the near end of a can has that depth, whatever the side.
# Code that takes the signed distance for the least push apart, or that compares engines by it, is off by millimetres.
#
# Seen 2026-11-30 with coal 3.0.3 (comes with pin 4.1.0), Python 3.11, Linux x86-64; can of radius 21.2 and height 89.1 mm, ball of radius 10 mm:
#   middle 15.9 mm from the axis, 43.8 mm below the can's middle   least way out 10.75 mm (end)   coal 12.63 mm   MuJoCo 4.0.0 10.75 mm
source "$(dirname "$(realpath "$0")")/prelude"
install pin==4.1.0 coal==3.0.3 mujoco-core==4.0.0 numpy==2.4.6
cat > look.py <<'PYTHON'
import coal
import mujoco
import numpy as np

RADIUS, HEIGHT, BALL = 0.0212, 0.0891, 0.01
CENTRE = np.array([0.0159, 0.0096, -0.0438])

to_the_end = HEIGHT / 2 + CENTRE[2] + BALL
to_the_side = RADIUS - np.hypot(*CENTRE[:2]) + BALL
least = min(to_the_end, to_the_side)

at = coal.Transform3s(np.eye(3), CENTRE)
can = coal.Cylinder(RADIUS, HEIGHT)
found = -coal.distance(can, coal.Transform3s(), coal.Sphere(BALL), at, coal.DistanceRequest(), coal.DistanceResult())

model = mujoco.MjModel.from_xml_string(
    f"<mujoco><worldbody><geom type='cylinder' size='{RADIUS} {HEIGHT / 2}'/>"
    f"<geom type='sphere' size='{BALL}' pos='{CENTRE[0]} {CENTRE[1]} {CENTRE[2]}'/></worldbody></mujoco>"
)
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
other = -mujoco.mj_geomDistance(model, data, 0, 1, 1.0, None)

print(f"way out by the end {1e3 * to_the_end:.2f} mm, by the side {1e3 * to_the_side:.2f} mm")
print(f"coal {1e3 * found:.2f} mm, MuJoCo {1e3 * other:.2f} mm")
assert abs(least - to_the_end) < 1e-9 and abs(other - least) < 2e-4
assert found > least + 1e-3
PYTHON
"$PY" look.py
