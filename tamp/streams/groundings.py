"""A user's own relation as streams: sample-<relation> from its generator, test-<relation> from its classifier."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

from tamp.call import Call
from tamp.rejection import Rejection
from tamp.streams.context import Context
from tamp.streams.drawing import draw
from tamp.streams.mixture import Mixture
from tamp.streams.relations import Classifier, Generator
from tamp.streams.resting import rest
from tamp.world.pose import Pose

LIKELY = 0.5
"""A relation holds when its classifier gives at least this probability."""


def sample_relation(
    context: Context, body: str, *others: Any, relation: str, generator: Generator, call: Call
) -> Iterator[Pose | Rejection]:
    """Poses that the generator proposes for the relation's first argument, put to rest on whatever is below them.

    The generator sees the scene as it will be at that step; a pose among the inputs is that of the body before it. That
    the body rests there, clear of the fixed bodies, is certified here, everything else by other streams' tests.
    """
    arguments = (body, *(other for other in others if isinstance(other, str)))
    at = {name: pose for name, pose in pairwise((body, *others)) if isinstance(name, str) and isinstance(pose, Pose)}
    scene = context.scene
    regions = [place for place in (*scene.surfaces.values(), *scene.cavities.values()) if place.body in scene.fixed]

    def judge(proposal: Pose) -> Pose | Rejection:
        rested = [rest(context.resting(body), proposal, region, scene.world_pose(region)) for region in regions]
        pose = next((pose for pose in rested if isinstance(pose, Pose)), None)
        if pose is None:
            return Rejection("rests nowhere")
        hit = context.collisions.between(body, pose, {})
        return pose if hit is None else Rejection(f"hits {hit}")

    yield from draw(context, relation, Mixture((relation,), (generator,)), arguments, judge, call, at)


def test_relation(context: Context, *arguments: Any, classifier: Classifier, call: Call) -> bool | Rejection:
    """Whether the classifier says that the relation holds; a pose among the arguments is that of the body before it."""
    bodies = context.scene.bodies
    poses: dict[str, Pose] = {name: pose for _, name, pose in call.fluents}
    if not call.fluents:
        poses = {name: bodies[name].pose for name in context.scene.movable}
    names: list[str] = []
    for argument in arguments:
        if isinstance(argument, Pose):
            poses[names[-1]] = argument
        elif isinstance(argument, str):
            names.append(argument)
    poses |= {name: bodies[name].pose for name in names if name in bodies and name not in poses}
    probability = classifier.classify(context.scene_at(poses), tuple(names))
    return True if probability >= LIKELY else Rejection(f"unlikely ({probability:.2f})")
