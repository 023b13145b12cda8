"""A user's own relation as streams: sample-<relation> from its generator, test-<relation> from its
classifier.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

from tamp.geometric.context import Context
from tamp.geometric.samplers.mixture import Mixture
from tamp.geometric.samplers.sampler import Generator
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY, Classifier, probability
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Cavity, Surface
from tamp.geometric.stability.placement import Placement, certified_pose, snap_to_region
from tamp.geometric.streams.movable_supports import stood_on
from tamp.geometric.streams.proposal_stream import certified_poses
from tamp.stream import Call, Rejection, RejectionKind


def sample_relation(
    context: Context,
    body: str,
    *others: Any,
    relation: str,
    generator: Generator,
    judge: tuple[Classifier, tuple[int, ...]] | None = None,
    below: int | None = None,
    call: Call,
) -> Iterator[Pose | Rejection]:
    """Sample poses that the generator proposes for the relation's first argument, put to rest on
    whatever is below them.

    The generator sees the scene as it will be at that step; a pose among the inputs is that of the
    body before it. That the body rests there, on a place among the inputs where there is one, clear
    of the fixed bodies, is certified here, everything else by other streams' tests; but where the
    relation has no test and a classifier, `judge`, that is asked here, with the inputs at these
    indices. With `below` it rests on the movable body at that index of the inputs, at the pose
    there.
    """
    arguments = (body, *(other for other in others if isinstance(other, str)))
    carrier = None if below is None else (body, *others)[below]
    at = {
        name: pose
        for name, pose in pairwise((body, *others))
        if isinstance(name, str) and isinstance(pose, Pose)
    }

    regions = _regions(context, carrier, {*arguments[1:]})

    def certified(proposal: Placement | Pose) -> Pose | Rejection:
        rested = _rested(context, body, proposal, regions, at if carrier else {})
        if isinstance(rested, Rejection):
            return rested

        pose, region = rested
        if carrier is not None:
            stood = stood_on(context, body, pose, region, region.body, at[region.body])
            if isinstance(stood, Rejection):
                return stood

        hit = context.collisions.between(body, pose, {})
        if hit is not None:
            return Rejection.hits(hit)
        if judge is None:
            return pose

        classifier, indices = judge
        names = [(body, *others)[index] for index in indices]
        answer = _answer(_asked(context, classifier, names, {**at, body: pose}, call))
        return answer if isinstance(answer, Rejection) else pose

    yield from certified_poses(
        context, relation, Mixture((relation,), (generator,)), arguments, certified, call, at
    )


def _regions(
    context: Context, carrier: str | None, named: Collection[str]
) -> dict[str, Surface | Cavity]:
    """Return the places of fixed bodies, or of one that moves, by name: the named ones, where there
    are any, else all.
    """
    scene = context.scene
    owners = scene.fixed if carrier is None else (carrier,)
    places = {
        place.name: place if carrier is None else _roofless(place)
        for place in (*scene.surfaces.values(), *scene.cavities.values())
        if place.body in owners
    }
    return {name: place for name, place in places.items() if name in named} or places


def _roofless(place: Surface | Cavity) -> Surface | Cavity:
    """Return a place in which bodies may be of any height: one's own relation need not mean that
    the box closes over them, and what is over its floor is tested like any body in the way.
    """
    if isinstance(place, Surface):
        return place
    width, depth, _ = place.size
    return replace(place, size=(width, depth, math.inf))


def _rested(
    context: Context,
    body: str,
    proposal: Placement | Pose,
    regions: Mapping[str, Surface | Cavity],
    at: Mapping[str, Pose],
) -> tuple[Pose, Surface | Cavity] | Rejection:
    """Certify that a proposal rests in its region, or a pose in the first that it is nearest to;
    regions of bodies in `at` are where those are.
    """
    faces, scene = context.stable_faces(body), context.scene
    if isinstance(proposal, Placement):
        meant = regions.get(proposal.region)
        regions = {} if meant is None else {meant.name: meant}

    refused = Rejection("rests nowhere", kind=RejectionKind.UNSTABLE)
    for region in regions.values():
        T_world_region = at.get(region.body, scene.bodies[region.body].pose) @ region.pose
        placement = proposal
        if isinstance(placement, Pose):
            snapped = snap_to_region(faces, placement, region, T_world_region)
            if isinstance(snapped, Rejection):
                continue
            placement = snapped

        pose = certified_pose(faces, placement, region, T_world_region)
        if isinstance(pose, Pose):
            return pose, region
        refused = pose if isinstance(proposal, Placement) else refused
    return refused


def test_relation(
    context: Context, *arguments: Any, classifier: Classifier, call: Call
) -> Rejection | bool:
    """Test whether the classifier says that the relation holds; a pose among the arguments is that
    of the body before it.
    """
    return _answer(_probability(context, arguments, classifier, call))


def fails_relation(
    context: Context, *arguments: Any, classifier: Classifier, call: Call
) -> bool | Rejection:
    """Test whether the classifier says that the relation does not hold."""
    number = _probability(context, arguments, classifier, call)
    if math.isnan(number):
        return Rejection("cannot tell", kind=RejectionKind.UNLIKELY)
    if number < LIKELY_PROBABILITY:
        return True
    return Rejection(f"likely ({number:.2f})", kind=RejectionKind.UNLIKELY)


def _answer(number: float) -> bool | Rejection:
    if math.isnan(number):
        return Rejection("cannot tell", kind=RejectionKind.UNLIKELY)
    if number >= LIKELY_PROBABILITY:
        return True
    return Rejection(f"unlikely ({number:.2f})", kind=RejectionKind.UNLIKELY)


def _probability(
    context: Context, arguments: tuple[Any, ...], classifier: Classifier, call: Call
) -> float:
    poses: dict[str, Pose] = {}
    names: list[str] = []
    for argument in arguments:
        if isinstance(argument, Pose):
            poses[names[-1]] = argument
        elif isinstance(argument, str):
            names.append(argument)
    return _asked(context, classifier, names, poses, call)


def _asked(
    context: Context, classifier: Classifier, names: list[str], poses: dict[str, Pose], call: Call
) -> float:
    """Compute the probability with bodies at poses, and the others where the step has them, or else
    at their start.
    """
    bodies = context.scene.bodies
    around: dict[str, Pose] = {name: pose for _, name, pose in call.fluents}
    if not call.fluents:
        around = {name: bodies[name].pose for name in context.scene.movable}
    around |= poses
    around |= {name: bodies[name].pose for name in names if name in bodies and name not in around}
    return probability(classifier, context.scene_at(around), names)
