"""Pick and place of blocks on a line, through PDDLStream's interface: the planner's own time, samplers are arithmetic.

    python -m benchmarks.line [--seeds N] [--time SECONDS]

The domain is that of examples/line. All blocks go from the ground into the red region, which has room for 1.5 times as
many; every plan is checked for overlaps before it counts.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from random import Random

from benchmarks import common
from tamp.pddlstream import Action, PDDLProblem, from_fn, from_gen_fn, from_test, solve

SIZES = (2, 4, 6, 8, 12)
FILES = common.ROOT / "examples" / "line"


def make(blocks: int, seed: int) -> PDDLProblem:
    """The problem with so many blocks of width 1."""
    rng = Random(seed)
    regions = {"ground": (-2.0 * blocks, 0.0), "red": (5.0, 5.0 + 1.5 * blocks)}
    start = {f"b{i}": 0.5 - 2.0 * blocks + 1.8 * i for i in range(blocks)}
    home = (-5.0,)

    def inside(block: str, pose: float, region: str) -> bool:
        return regions[region][0] + 0.5 <= pose <= regions[region][1] - 0.5

    def sample_pose(block: str, region: str) -> Iterator[tuple[float]]:
        while True:
            yield (rng.uniform(regions[region][0] + 0.5, regions[region][1] - 0.5),)

    stream_map = {
        "sample-pose": from_gen_fn(sample_pose),
        "inverse-kinematics": from_fn(lambda block, pose: ((pose,),)),
        "plan-motion": from_fn(lambda start, end: ((start, end),)),
        "test-region": from_test(inside),
        "distance": lambda start, end: abs(end[0] - start[0]),
        "collision": lambda block, pose, other, at: abs(pose - at) < 1.0,
    }
    init = [("CanMove",), ("HandEmpty",), ("Conf", home), ("AtConf", home)]
    init += [("Region", region) for region in regions]
    init += [("Block", block) for block in start]
    init += [(name, block, pose) for block, pose in start.items() for name in ("Pose", "AtPose")]
    init += [("Placeable", block, "red") for block in start]
    goal = ("and", *(("In", block, "red") for block in start))
    return PDDLProblem(
        FILES / "domain.pddl", {"@ground": "ground"}, FILES / "stream.pddl", stream_map, init, goal
    )  # fmt: skip


def holds(plan: list[Action], problem: PDDLProblem) -> bool:
    """Whether the blocks are set down without overlap and end in the red region."""
    at = {fact[1]: fact[2] for fact in problem.init if fact[0] == "AtPose"}
    for action in plan:
        if action.name == "pick":
            if at.pop(action.args[0]) != action.args[1]:
                return False
        elif action.name == "place":
            block, pose = action.args[:2]
            if any(abs(pose - other) < 1.0 for other in at.values()):
                return False
            at[block] = pose
    return len(at) == len(problem.goal) - 1 and all(pose >= 5.5 for pose in at.values())


def main() -> None:
    """Solve each size with several seeds."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="problems of each size")
    parser.add_argument("--time", type=float, default=20.0, help="seconds for each")
    arguments = parser.parse_args()
    rows: list[dict[str, object]] = []
    for size in SIZES:
        seconds: list[float] = []
        for seed in range(arguments.seeds):
            problem = make(size, seed)
            solution = solve(problem, max_time=arguments.time, seed=seed)
            solved = solution.plan is not None and holds(solution.plan, problem)
            common.record("line.jsonl", seed=seed, config={"blocks": size}, solved=solved, planning_s=solution.seconds)
            if solved:
                seconds.append(solution.seconds)
        rows.append({"blocks": size, "solved": f"{len(seconds)}/{arguments.seeds}", **common.times(seconds)})
    common.table(rows, "Pick and place on a line")


if __name__ == "__main__":
    main()
