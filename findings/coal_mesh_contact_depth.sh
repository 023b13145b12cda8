#!/usr/bin/env bash
# coal (hpp-fcl): the depth of a contact is 0 as soon as one of the two shapes is a triangle mesh.
#
# Expected: about the depth that the same box has as a primitive; or a note in Contact.penetration_depth's documentation.
# Code that pushes bodies apart by the depth, or that tolerates contacts up to one, sees nothing wrong.
#
# Seen 2026-11-29 with coal 3.0.3 (comes with pin 4.1.0), Python 3.11, Linux x86-64; two unit boxes, middles so far apart:
#   0.95 m   primitives: depth 0.05, distance -0.05      mesh against primitive: collides, depth 0, distance 0
#   0.60 m   primitives: depth 0.40, distance -0.40      mesh against primitive: collides, depth 0, distance 0
source "$(dirname "$(realpath "$0")")/prelude"
install pin==4.1.0 coal==3.0.3 numpy==2.4.6
cat > look.py <<'PYTHON'
import itertools

import coal
import numpy as np

CORNERS = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))
SIDES = [  # two triangles a side, corners counted as in CORNERS, outwards
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3),
]


def mesh():
    model = coal.BVHModelOBBRSS()
    vertices, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for corner in CORNERS:
        vertices.append(corner)
    for side in SIDES:
        triangles.append(coal.Triangle(*side))
    model.beginModel(len(SIDES), len(CORNERS))
    model.addSubModel(vertices, triangles)
    model.endModel()
    return model


def look(shape, gap):
    other, there = coal.Box(1, 1, 1), coal.Transform3s(np.eye(3), np.array([gap, 0.0, 0.0]))
    found = coal.CollisionResult()
    coal.collide(shape, coal.Transform3s(), other, there, coal.CollisionRequest(), found)
    distance = coal.distance(shape, coal.Transform3s(), other, there, coal.DistanceRequest(), coal.DistanceResult())
    return found.isCollision(), found.getContact(0).penetration_depth, distance


for gap in (0.95, 0.6):
    hits, depth, distance = look(coal.Box(1, 1, 1), gap)
    print(f"{gap} m apart, primitive: collides {hits}, depth {depth:.3f}, distance {distance:.3f}")
    assert hits and abs(abs(depth) - (1 - gap)) < 1e-6 and abs(distance + 1 - gap) < 1e-6
    hits, depth, distance = look(mesh(), gap)
    print(f"{gap} m apart, mesh:      collides {hits}, depth {depth:.3f}, distance {distance:.3f}")
    assert hits and abs(depth) < 1e-9 and abs(distance) < 1e-9
PYTHON
"$PY" look.py
