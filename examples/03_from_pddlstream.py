"""A problem written for PDDLStream: its two PDDL files as they are, and a map of Python functions.

Blocks of width 1 stand on a line. The red region is free but for a block in its middle that may have to move away.
"""

import random
from collections.abc import Iterator
from pathlib import Path

from tamp.pddlstream import PDDLProblem, from_fn, from_gen_fn, from_test, solve

HERE = Path(__file__).parent / "line"
REGIONS = {"ground": (-10.0, 10.0), "red": (4.0, 6.5)}
START = {"a": -3.0, "b": 0.0, "c": 5.2}
HOME = (-5.0,)


def sample_pose(block: str, region: str) -> Iterator[tuple[float]]:
    left, right = REGIONS[region]
    while True:
        yield (random.uniform(left + 0.5, right - 0.5),)


def inside(block: str, pose: float, region: str) -> bool:
    left, right = REGIONS[region]
    return left + 0.5 <= pose <= right - 0.5


problem = PDDLProblem(
    domain_pddl=(HERE / "domain.pddl").read_text(),
    constant_map={"@ground": "ground"},
    stream_pddl=(HERE / "stream.pddl").read_text(),
    stream_map={
        "sample-pose": from_gen_fn(sample_pose),
        "inverse-kinematics": from_fn(lambda block, pose: ((pose,),)),
        "plan-motion": from_fn(lambda start, end: ([start, end],)),
        "test-region": from_test(inside),
        "distance": lambda start, end: abs(end[0] - start[0]),
        "collision": lambda block, pose, other, at: abs(pose - at) < 1.0,
    },
    init=[("CanMove",), ("HandEmpty",), ("Conf", HOME), ("AtConf", HOME)]
    + [("Region", region) for region in REGIONS]
    + [("Block", block) for block in START]
    + [(name, block, pose) for block, pose in START.items() for name in ("Pose", "AtPose")]
    + [("Placeable", block, "red") for block in ("a", "b")],
    goal=("and", ("In", "a", "red"), ("In", "b", "red"), ("HandEmpty",)),
)

random.seed(0)
solution = solve(problem, max_time=20.0, seed=0)
print(solution.outcome.value)
for action in solution.plan or []:
    print(f"  {action.name:6}", *action.args)
print(f"cost {solution.cost:.1f}, {len(solution.certificate)} facts certified, {solution.seconds:.2f} s")
