"""Guarded call of a sampler that anyone may have written: placements or poses come back, in time,
or the reason why not.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice

from numpy.random import Generator as Random

from tamp.geometric.samplers.sampler import Generator
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Body, Room, Scene
from tamp.geometric.stability.placement import Placement
from tamp.geometric.stability.stable_poses import stable_faces_of
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.interrupts import Interrupter

MAX_DISTANCE_M = 1000.0
"""Metres from the room beyond which a position is taken for a mistake."""


class SamplerFault(Exception):
    """A generator did what no generator should; the message says what, with "it" for its name."""


def propose_safely(
    generator: Generator,
    scene: Scene,
    arguments: Sequence[str],
    count: int,
    rng: Random,
    deadline: Deadline,
    seconds: float = math.inf,
) -> list[Placement | Pose]:
    """Ask for at most `count` proposals, best first: poses of finite numbers and with unit
    quaternions, placements on a face that the body has in a region that there is.

    Args:
        generator: Of any behaviour.
        scene: Its own to keep.
        arguments: Of the relation.
        count: How many are wanted.
        rng: Its own.
        deadline: Of the run; OutOfTime is raised when it passes meanwhile.
        seconds: How long the generator may take.

    Raises:
        Misbehaved: It raised, took too long, or proposed nothing of use among what it proposed.
    """
    limit = Deadline(min(seconds, deadline.left()))
    try:
        if math.isinf(seconds):  # the alarm of the run will do
            return _proposed(generator, scene, arguments, count, rng)
        alarm = Interrupter(limit, grace=0.0, again=0.02, strangers=FOREIGN_CODE)
        return alarm.run(lambda: _proposed(generator, scene, arguments, count, rng))
    except OutOfTime:
        if deadline.passed:
            raise
        raise SamplerFault(f"it took more than {seconds:.2f} s to propose poses") from None
    except SamplerFault:
        raise
    except (Exception, SystemExit, GeneratorExit) as error:
        text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise SamplerFault(f"it raised {text}") from error


def _proposed(
    generator: Generator, scene: Scene, arguments: Sequence[str], count: int, rng: Random
) -> list[Placement | Pose]:
    regions = frozenset((*scene.surfaces, *scene.cavities))
    limits = _Limits(scene.bodies.get(arguments[0]), regions, scene.room)
    return _proposals(generator.propose(scene, arguments, count, rng), count, limits)


@dataclass(frozen=True, eq=False)
class _Limits:
    """The body, regions and room that proposals are about, noted before the generator has the scene
    in its hands.
    """

    body: Body | None
    regions: frozenset[str]
    room: Room


def _proposals(proposed: object, count: int, limits: _Limits) -> list[Placement | Pose]:
    if not isinstance(proposed, Iterable):
        raise SamplerFault(f"it proposes a {type(proposed).__name__}, not a list of poses")
    proposals: list[Placement | Pose] = []
    wrong = ""
    for item in islice(proposed, count):
        try:
            checked = _placement if isinstance(item, Placement) else _pose
            proposals.append(checked(item, limits))
        except SamplerFault as error:
            wrong = str(error)
    if wrong and not proposals:
        raise SamplerFault(wrong)
    return proposals


def _placement(item: Placement, limits: _Limits) -> Placement:
    try:
        region, face = str(item.region), operator.index(item.face)
        x, y, yaw = (float(number) for number in (item.x, item.y, item.yaw))
    except (TypeError, ValueError):
        raise SamplerFault("it proposes a placement without three numbers and a face") from None
    if region not in limits.regions:
        raise SamplerFault(f"it proposes a placement in '{region:.40}', which there is not")

    stable = None if limits.body is None else stable_faces_of(limits.body)
    ways = 0 if stable is None else len(stable.ways)
    if stable is not None and face >= ways:
        ways += len(stable.curved)
    if not 0 <= face < ways:
        raise SamplerFault(f"it proposes face {face} of a body that rests on {ways}")
    if not all(math.isfinite(number) for number in (x, y, yaw)):
        raise SamplerFault("it proposes numbers that are not finite, or no rotation")
    if max(abs(x), abs(y)) > MAX_DISTANCE_M:
        raise SamplerFault(f"it proposes a position more than {MAX_DISTANCE_M:g} m away")
    return Placement(region, face, x, y, yaw)


def _pose(item: object, limits: _Limits) -> Pose:
    if not isinstance(item, Pose):
        raise SamplerFault(f"it proposes a {type(item).__name__}, not a pose")
    room = limits.room
    try:
        x, y, z = (float(number) for number in item.position)
        a, b, c, d = (float(number) for number in item.quaternion)
    except (TypeError, ValueError):
        raise SamplerFault("it proposes a pose that does not consist of seven numbers") from None
    norm = math.hypot(a, b, c, d)
    if not (
        math.isfinite(norm) and norm > 1e-6 and all(math.isfinite(number) for number in (x, y, z))
    ):
        raise SamplerFault("it proposes numbers that are not finite, or no rotation")
    beyond = max(room.x[0] - x, x - room.x[1], room.y[0] - y, y - room.y[1], abs(z))
    if beyond > MAX_DISTANCE_M:
        raise SamplerFault(f"it proposes a position more than {MAX_DISTANCE_M:g} m away")
    if abs(norm - 1.0) < 1e-9:  # as it is, to the last bit
        norm = 1.0
    return Pose((x, y, z), (a / norm, b / norm, c / norm, d / norm))


FOREIGN_CODE = tuple(function.__code__ for function in (_proposed, _proposals, _placement, _pose))
"""Of an alarm: what here runs a generator's own code."""
