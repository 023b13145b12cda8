"""A user's own relation as streams: sample-<relation> from its generator, test-<relation> from its classifier."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tamp.call import Call
from tamp.rejection import Rejection
from tamp.streams.context import Context
from tamp.streams.relations import Classifier, Generator
from tamp.streams.resting import rest
from tamp.world.pose import Pose

BATCH = 16
"""Poses asked of a generator at once."""

LIKELY = 0.5
"""A relation holds when its classifier gives at least this probability."""


def sample_relation(
    context: Context, body: str, *others: Any, generator: Generator, call: Call
) -> Iterator[Pose | Rejection]:
    """Poses that the generator proposes for the relation's first argument, put to rest on whatever is below them.

    The generator sees the scene as it will be at that step; that the body rests there, clear of the fixed bodies, is
    certified here, everything else by other streams' tests.
    """
    scene = context.scene_at({name: pose for _, name, pose in call.fluents}, absent=body)
    arguments = (body, *(other for other in others if isinstance(other, str)))
    fixed = set(context.scene.fixed)
    regions = [place for place in (*scene.surfaces.values(), *scene.cavities.values()) if place.body in fixed]
    while True:
        proposals = generator.propose(scene, arguments, BATCH, call.rng)
        if not proposals:
            return
        for proposal in proposals:
            rested = [rest(context.resting(body), proposal, region, scene.world_pose(region)) for region in regions]
            poses = [pose for pose in rested if isinstance(pose, Pose)]
            if not poses:
                yield Rejection("rests nowhere")
                continue
            hit = context.collisions.between(body, poses[0], {})
            yield poses[0] if hit is None else Rejection(f"hits {hit}")


def test_relation(context: Context, *arguments: Any, classifier: Classifier, call: Call) -> bool | Rejection:
    """Whether the classifier says that the relation holds; a pose among the arguments is that of the body before it."""
    poses: dict[str, Pose] = {name: pose for _, name, pose in call.fluents}
    names: list[str] = []
    for argument in arguments:
        if isinstance(argument, Pose):
            poses[names[-1]] = argument
        elif isinstance(argument, str):
            names.append(argument)
    probability = classifier.classify(context.scene_at(poses), tuple(names))
    return True if probability >= LIKELY else Rejection(f"unlikely ({probability:.2f})")
