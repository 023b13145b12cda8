"""Learning a relation from a few demonstrations, and what is held out to say how well."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator as Random
from numpy.typing import NDArray

from grounding.body_geometry import geometry_of
from grounding.relations.committee import Committee, fit
from grounding.relations.demonstration_file import Demonstration
from grounding.relations.evidence import RANKING, gather
from grounding.relations.generator import PoseGenerator, learned
from grounding.relations.situation import Situations, joined, situation_of
from grounding.relations.variety import contradiction
from tamp.errors import InputError
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY

FOLDS = 10
"""Parts into which scenes are dealt for cross-validation, at most."""

KNOWS = 0.75
"""Mean recall of both labels, held out, from which on a classifier is believed."""

HOPELESS = 0.65
"""The same, below which nothing was learned."""

FEWEST = 3
"""Demonstrations of what holds from which something is learned, at least."""

EACH = 4
"""Labels of each kind from which on cross-validation says something."""

STEADY = 0.966
"""Cosine of the tilt from a stable face up to which a body counts as standing on it."""


@dataclass(frozen=True)
class HeldOut:
    """The answers of a classifier about labels that it was not shown, scene by scene.

    Attributes:
        positive: Share of what holds of which it says so.
        negative: Share of what does not.
        wrong: Rows of the demonstrations that it gets wrong.
        folds: Parts into which the scenes were dealt.
    """

    positive: float
    negative: float
    wrong: tuple[int, ...]
    folds: int

    @property
    def mean(self) -> float:
        """Return the mean recall of both labels."""
        return (self.positive + self.negative) / 2


@dataclass(frozen=True, eq=False)
class Learned:
    """A relation that was learned.

    Attributes:
        relation: Its name.
        kinds: Of its arguments: movable, fixed, surface, container.
        committee: Votes on whether it holds.
        generator: Proposes where argument 0 goes.
        held_out: None where there are too few labels for it.
        cannot_tell: Why it has no classifier; empty where it has one.
        count: Demonstrations of what holds, and of what does not.
    """

    relation: str
    kinds: tuple[str, ...]
    committee: Committee
    generator: PoseGenerator
    held_out: HeldOut | None
    cannot_tell: str
    count: tuple[int, int]


def learn(relation: str, shown: Sequence[Demonstration], rng: Random) -> Learned:
    """Learn a relation.

    Args:
        relation: Its name.
        shown: Demonstrations, all of as many arguments.
        rng: The only source of randomness.

    Raises:
        InputError: Too few demonstrations, none that holds, one situation with both labels, or
            labels that have nothing to do with where bodies are.
    """
    holds = np.array([one.holds for one in shown], dtype=bool)
    if holds.sum() < FEWEST:
        what = f"'{relation}' holds in {holds.sum() or 'none'} of {len(shown)} demonstrations"
        raise InputError(what, remedy=f"Show at least {FEWEST}, better 10 of each kind")
    situations = joined([situation_of(one.scene, one.arguments) for one in shown])
    pair = contradiction(situations, holds)
    if pair is not None:
        places = f"{shown[pair[0]].source} and {shown[pair[1]].source}"
        what = f"'{relation}' is said to hold and not to hold in the same situation: {places}"
        raise InputError(what, remedy="Take one of the two away")

    scenes = [
        one.source.rpartition(":")[0].rpartition(":")[0] or str(row)
        for row, one in enumerate(shown)
    ]
    held_out = cross_validated(situations, holds, scenes, rng)
    if held_out is not None and held_out.mean < HOPELESS:
        raise InputError(*_hopeless(relation, held_out, shown))

    committee, generator = trained(situations, holds, rng, _steadily(shown))
    return Learned(
        relation,
        kinds_of(shown),
        committee,
        generator,
        held_out,
        _doubt(holds, held_out),
        (int(holds.sum()), int((~holds).sum())),
    )


def trained(
    situations: Situations, holds: NDArray[np.bool_], rng: Random, steady: bool = True
) -> tuple[Committee, PoseGenerator]:
    """Train classifier and generator."""
    good, bad = np.flatnonzero(holds), np.flatnonzero(~holds)
    positives, negatives = situations.rows(good), situations.rows(bad)
    evidence = gather(positives, negatives, rng)
    committee = fit(evidence)
    ranking = fit(evidence, RANKING) if len(bad) else committee
    return committee, learned(ranking, positives, rng, steady)


def cross_validated(
    situations: Situations, holds: NDArray[np.bool_], scenes: Sequence[str], rng: Random
) -> HeldOut | None:
    """Ask of each scene a classifier that was not shown it; None where labels are too few."""
    names = list(dict.fromkeys(scenes))
    folds = min(FOLDS, len(names))
    if min(holds.sum(), (~holds).sum()) < EACH or folds < 3:
        return None

    # Scenes of one kind of label are dealt round, so that every part has both.
    rank = {
        name: float(np.mean([h for h, s in zip(holds, scenes, strict=True) if s == name]))
        for name in names
    }
    shuffled = [names[row] for row in rng.permutation(len(names))]
    part = {name: row % folds for row, name in enumerate(sorted(shuffled, key=rank.__getitem__))}
    fold = np.array([part[name] for name in scenes])
    said = np.zeros(len(holds), dtype=bool)
    for one in range(folds):
        test, train = np.flatnonzero(fold == one), fold != one
        good, bad = np.flatnonzero(holds & train), np.flatnonzero(~holds & train)
        if len(good) < 2:
            return None
        evidence = gather(situations.rows(good), situations.rows(bad), rng)
        said[test] = fit(evidence).predict(situations.rows(test)) >= LIKELY_PROBABILITY

    wrong = tuple(np.flatnonzero(said != holds).tolist())
    return HeldOut(float(said[holds].mean()), float((~said[~holds]).mean()), wrong, folds)


def kinds_of(shown: Sequence[Demonstration]) -> tuple[str, ...]:
    """Return what each argument is: movable, fixed, surface or container.

    Raises:
        InputError: It is one thing here and another there.
    """
    kinds: list[str] = []
    for place in range(len(shown[0].arguments)):
        found = {_kind(one, place): one for one in shown}
        if len(found) > 1:
            (first, here), (second, there) = list(found.items())[:2]
            what = (
                f"argument {place + 1} is a {first} in {here.source}, a {second} in {there.source}"
            )
            raise InputError(what, remedy="Make it the same in all: 'fixed: true', or not")
        kinds += found
    return tuple(kinds)


def _kind(one: Demonstration, place: int) -> str:
    name, scene = one.arguments[place], one.scene
    if place > 0 and not (name in scene.bodies and scene.bodies[name].movable):
        if name in scene.surfaces:
            return "surface"
        if name in scene.cavities:
            return "container"
    return "movable" if scene.bodies[name].movable or place == 0 else "fixed"


def _steadily(shown: Sequence[Demonstration]) -> bool:
    """Check whether argument 0 stood on a stable face in most of what holds, or at least upright on
    one of its own axes: a capsule has no stable face that it would stand on.
    """
    stood: list[bool] = []
    for one in shown:
        if one.holds:
            body = one.scene.bodies[one.arguments[0]]
            down = -body.pose.rotation[2]
            faces = geometry_of(body.parts).faces
            level = float(np.abs(down).max()) > STEADY
            stood.append(level or any(float(-face.rotation[2] @ down) > STEADY for face in faces))
    return float(np.mean(stood)) >= 0.8


def _doubt(holds: NDArray[np.bool_], held_out: HeldOut | None) -> str:
    """Return why a classifier is not believed; empty where it is."""
    negative = int((~holds).sum())
    if not negative:
        return "it was shown only where it holds: show where it does not"
    if held_out is None:
        return f"it was shown {int(holds.sum())} + {negative} labels: show {EACH} of each kind"
    if held_out.mean < KNOWS:
        yes, no = round(100 * held_out.positive), round(100 * held_out.negative)
        return f"held out, it is right about {yes} % of what holds and {no} % of what does not"
    return ""


def _hopeless(relation: str, held_out: HeldOut, shown: Sequence[Demonstration]) -> tuple[str]:
    yes, no = round(100 * held_out.positive), round(100 * held_out.negative)
    wrong = ", ".join(shown[row].source for row in held_out.wrong[:3])
    return (
        f"'{relation}' cannot be learned from these labels: asked of scenes that it was not shown, "
        f"it is right about {yes} % of what holds and {no} % of what does not "
        f"(wrong: {wrong}, ...). "
        "Are the labels right? Does it depend on something else than where these bodies are?",
    )
