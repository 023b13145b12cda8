"""Asking a generator that anyone may have written: what comes back are poses, in time, or the
reason why not.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import islice

from numpy.random import Generator as Random

from tamp.geometric.samplers.sampler import Generator
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Room, Scene
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.interrupts import Alarm

FAR = 1000.0
"""Metres from the room beyond which a position is taken for a mistake."""


class Misbehaved(Exception):
    """A generator did what no generator should; the message says what, with "it" for its name."""


def ask(
    generator: Generator,
    scene: Scene,
    arguments: Sequence[str],
    count: int,
    rng: Random,
    deadline: Deadline,
    seconds: float = math.inf,
) -> list[Pose]:
    """Ask for at most `count` poses, best first, of finite numbers and with unit quaternions.

    Args:
        generator: Of any behaviour.
        scene: Its own to keep.
        arguments: Of the relation.
        count: How many are wanted.
        rng: Its own.
        deadline: Of the run; OutOfTime is raised when it passes meanwhile.
        seconds: How long the generator may take.

    Raises:
        Misbehaved: It raised, took too long, or proposed not a single pose among what it proposed.
    """
    limit = Deadline(min(seconds, deadline.left()))
    try:
        if math.isinf(seconds):  # the alarm of the run will do
            return _proposed(generator, scene, arguments, count, rng)
        alarm = Alarm(limit, grace=0.0, again=0.02, strangers=STRANGERS)
        return alarm.run(lambda: _proposed(generator, scene, arguments, count, rng))
    except OutOfTime:
        if deadline.passed:
            raise
        raise Misbehaved(f"it took more than {seconds:.2f} s to propose poses") from None
    except Misbehaved:
        raise
    except (Exception, SystemExit, GeneratorExit) as error:
        text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        raise Misbehaved(f"it raised {text}") from error


def _proposed(
    generator: Generator, scene: Scene, arguments: Sequence[str], count: int, rng: Random
) -> list[Pose]:
    return _poses(generator.propose(scene, arguments, count, rng), count, scene.room)


def _poses(proposed: object, count: int, room: Room) -> list[Pose]:
    if not isinstance(proposed, Iterable):
        raise Misbehaved(f"it proposes a {type(proposed).__name__}, not a list of poses")
    poses: list[Pose] = []
    wrong = ""
    for item in islice(proposed, count):
        try:
            poses.append(_pose(item, room))
        except Misbehaved as error:
            wrong = str(error)
    if wrong and not poses:
        raise Misbehaved(wrong)
    return poses


def _pose(item: object, room: Room) -> Pose:
    if not isinstance(item, Pose):
        raise Misbehaved(f"it proposes a {type(item).__name__}, not a pose")
    try:
        x, y, z = (float(number) for number in item.position)
        a, b, c, d = (float(number) for number in item.quaternion)
    except (TypeError, ValueError):
        raise Misbehaved("it proposes a pose that does not consist of seven numbers") from None
    norm = math.hypot(a, b, c, d)
    if not (
        math.isfinite(norm) and norm > 1e-6 and all(math.isfinite(number) for number in (x, y, z))
    ):
        raise Misbehaved("it proposes numbers that are not finite, or no rotation")
    beyond = max(room.x[0] - x, x - room.x[1], room.y[0] - y, y - room.y[1], abs(z))
    if beyond > FAR:
        raise Misbehaved(f"it proposes a position more than {FAR:g} m away")
    if abs(norm - 1.0) < 1e-9:  # as it is, to the last bit
        norm = 1.0
    return Pose((x, y, z), (a / norm, b / norm, c / norm, d / norm))


STRANGERS = tuple(function.__code__ for function in (_proposed, _poses, _pose))
"""Of an alarm: what here runs a generator's own code."""
