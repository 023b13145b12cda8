"""Your own stream: a generator function in the place of a shipped one.

Here everything goes to the left half of a surface. A stream yields values, or a `Rejection` that says why a try gave
none; the planner counts these words, and they are what you read when there is no plan.
"""

from collections.abc import Iterator

import tamp
from tamp.geometric.context import Context


def left_half(context: Context, body: str, surface: str, call: tamp.Call) -> Iterator[tamp.Pose | tamp.Rejection]:
    """Upright poses of `body` on the half of `surface` where its y is positive."""
    place = context.scene.surfaces[surface]
    T_world_surface = context.scene.world_pose(place)
    height = 0.102 / 2 + 0.001  # half a can, and a millimetre of air: resting is not touching
    while True:
        x = call.rng.uniform(-0.4, 0.4) * place.size[0]
        y = call.rng.uniform(-0.4, 0.4) * place.size[1]
        if y < 0:
            yield tamp.Rejection("on the right half")
        else:
            yield T_world_surface @ tamp.Pose.from_xyz_yaw(x, y, height, call.rng.uniform(-3.14, 3.14))


problem = tamp.load_problem("one_object", functions={"sample-on": left_half})
solution = tamp.solve(problem, max_time=30.0, seed=0)
print(solution.outcome.value)
print(solution.statistics["sample-on"])
