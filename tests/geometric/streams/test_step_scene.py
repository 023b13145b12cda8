"""What a generator is shown: the scene as it will be at its step of the plan; and what is done with its batch."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.random import Generator as Random

from tamp import load_problem, solve
from tamp.geometric.samplers.placements import SurfacePlacements
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import Placement, placed_pose
from tamp.geometric.streams.sampling import sample_inside, sample_on
from tamp.stream import Call
from tamp.system.deadline import Deadline
from tests.geometric.streams.scenes import problem_with


class Watching:
    """Proposes as the hand-made one, and keeps what it was shown."""

    def __init__(self) -> None:
        self.shown: list[tuple[str, Scene, int]] = []
        self.proposed: list[list[Placement]] = []

    def propose(
        self, scene: Scene, arguments: Sequence[str], count: int, rng: Random
    ) -> list[Placement]:
        self.shown.append((arguments[0], scene, count))
        self.proposed.append(SurfacePlacements().propose(scene, arguments, count, rng))
        return self.proposed[-1]


@pytest.mark.parametrize("name", ["two_objects", "four_objects"])
@pytest.mark.parametrize("seed", [0, 1])
def test_bodies_stand_where_the_plan_has_put_them(name: str, seed: int) -> None:
    watching = Watching()
    problem = load_problem(name, groundings={"on": watching}, samplers={"on": "given:alone"})
    start = {body: problem.scene.bodies[body].pose for body in problem.scene.movable}
    solution = solve(problem, max_time=60.0, seed=seed)
    assert solution.solved
    placed = {action.objects[0]: action for action in solution.plan if action.name == "place"}
    goals = [body for body in placed if body in {shown for shown, _, _ in watching.shown}]
    assert len(goals) == (2 if name == "two_objects" else 4)
    final = {
        body: next(
            value
            for word in action.arguments
            if isinstance(value := solution.values.get(word), Pose)
        )
        for body, action in placed.items()
    }
    for number, body in enumerate(goals):
        expected = start | {earlier: final[earlier] for earlier in goals[:number]}
        scenes = [scene for shown, scene, _ in watching.shown if shown == body]
        assert any(
            {other: scene.bodies[other].pose for other in start} == expected for scene in scenes
        )
    assert {count for _, _, count in watching.shown} == {16}


@pytest.mark.parametrize(("sample", "place"), [(sample_on, "table"), (sample_inside, "cupboard_1")])
def test_a_batch_is_drawn_at_once_and_used_in_its_order(
    sample: object, place: str, tmp_path: Path
) -> None:
    problem_with("box", tmp_path)
    watching = Watching()
    given = {relation: "given:alone" for relation in ("on", "inside")}
    groundings = {"on": watching, "inside": watching}
    problem = load_problem(tmp_path / "box.yaml", groundings=groundings, samplers=given)
    drawn = sample(problem.context, "box", place, Call(np.random.default_rng(0), Deadline()))  # type: ignore[operator]
    poses = [pose for pose in (next(drawn) for _ in range(20)) if isinstance(pose, Pose)]
    assert len(watching.proposed) == 2 or len(poses) < 17
    scene, faces = problem.scene, problem.context.stable_faces("box")
    T_world_region = scene.world_pose(scene.region(place))
    proposed = [
        placed_pose(faces, one, T_world_region).position[:2]
        for batch in watching.proposed
        for one in batch
    ]
    order = [
        min(range(len(proposed)), key=lambda i: np.hypot(*np.subtract(proposed[i], p.position[:2])))
        for p in poses
    ]
    assert order == sorted(order) and len(set(order)) == len(order) >= 10


def test_poses_clear_of_the_others_come_first() -> None:
    """Of a batch; the one that hits something comes last, since its test tells the search what is in the way."""
    problem = load_problem("cluttered")
    context = problem.context
    poses = {
        name: problem.scene.bodies[name].pose
        for name in problem.scene.movable
        if name != "soup_can"
    }
    fluents = [("at-pose", name, pose) for name, pose in poses.items()]
    drawn = sample_on(
        context, "soup_can", "cupboard_top", Call(np.random.default_rng(0), Deadline(), fluents)
    )
    hits = []
    for _ in range(60):
        pose = next(drawn)
        assert isinstance(pose, Pose)
        hits.append(
            any(
                context.collisions.pair("soup_can", pose, name, at, 0.003)
                for name, at in poses.items()
            )
        )
    assert 0.0 < np.mean(hits) < 0.35 and not hits[0]  # blindly, most of them hit something
    blind = SurfacePlacements().propose(
        problem.scene, ("soup_can", "cupboard_top"), 200, np.random.default_rng(0)
    )
    faces, T_world_region = (
        context.stable_faces("soup_can"),
        problem.scene.world_pose(problem.scene.region("cupboard_top")),
    )
    placed = [placed_pose(faces, one, T_world_region) for one in blind]
    assert (
        np.mean(
            [context.collisions.between("soup_can", pose, poses) is not None for pose in placed]
        )
        > 0.5
    )
