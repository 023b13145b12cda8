"""Pictures of a simulated world, drawn without a window or a graphics card."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tamp.simulation.physics import World, load_bullet
from tamp.world.pose import Array, Pose
from tamp.world.scene import Hull

ROBOT_COLOUR = (0.93, 0.93, 0.95, 1.0)
BASE_COLOUR = (0.25, 0.3, 0.38, 1.0)
FLOOR_COLOUR = (0.86, 0.84, 0.8, 1.0)


def picture(
    world: World, eye: Sequence[float], target: Sequence[float], size: tuple[int, int], angle: float = 40.0
) -> Array:
    """What a camera sees.

    Args:
        world: Its bodies, in the colours of the scene, and its robot.
        eye: Where the camera is, metres in the world.
        target: What it looks at.
        size: Columns and rows.
        angle: Of view from top to bottom, degrees.

    Returns:
        Rows x columns x RGB in [0, 1].
    """
    bullet, client = load_bullet(), world.client
    for name, solids in world.solids.items():
        for solid in solids:
            colour = world.scene.bodies[name].colour
            bullet.changeVisualShape(solid.handle, solid.link, rgbaColor=colour, physicsClientId=client)
    for name, solid in world.links.items():
        colour = BASE_COLOUR if name == "base" else ROBOT_COLOUR
        bullet.changeVisualShape(solid.handle, solid.link, rgbaColor=colour, physicsClientId=client)
    bullet.changeVisualShape(world.floor.handle, -1, rgbaColor=FLOOR_COLOUR, physicsClientId=client)
    shells = [shell for name in world.solids for shell in _shells(world, name)]
    view = bullet.computeViewMatrix(eye, target, (0.0, 0.0, 1.0))
    lens = bullet.computeProjectionMatrixFOV(angle, size[0] / size[1], 0.1, 20.0)
    _, _, pixels, _, _ = bullet.getCameraImage(
        *size, view, lens, lightDirection=(2.0, -3.0, 6.0), shadow=1, lightAmbientCoeff=0.65, lightDiffuseCoeff=0.4,
        lightSpecularCoeff=0.05, renderer=bullet.ER_TINY_RENDERER, physicsClientId=client,
    )  # fmt: skip
    for shell in shells:
        bullet.removeBody(shell, physicsClientId=client)
    return np.reshape(np.asarray(pixels, dtype=float), (size[1], size[0], 4))[:, :, :3] / 255.0


def _shells(world: World, name: str) -> list[int]:
    """Something to see where a body's convex hulls are, which the engine does not draw."""
    bullet, client = load_bullet(), world.client
    body = world.scene.bodies[name]
    made: list[int] = []
    for part in body.parts:
        if isinstance(part.shape, Hull):
            shape = bullet.createVisualShape(
                bullet.GEOM_MESH,
                vertices=part.shape.vertices.tolist(),
                indices=part.shape.faces.ravel().tolist(),
                rgbaColor=body.colour,
                physicsClientId=client,
            )
            pose = Pose.from_matrix(world.pose(name)) @ part.pose
            made.append(bullet.createMultiBody(0.0, -1, shape, pose.position, pose.quaternion, physicsClientId=client))
    return made
