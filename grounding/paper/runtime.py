"""The paper's models at work, in numpy."""

from __future__ import annotations

import numpy as np
from numpy.random import Generator as Random

from grounding.paper.features import (
    BB,
    CODE,
    PC,
    BoxFeatures,
    CloudFeatures,
    FeatureObservation,
    Features,
    poses_of,
)
from grounding.paper.kernels import normalize
from grounding.paper.numpy_networks import (
    NOISE,
    Arrays,
    Floats,
    Network,
    check_generator,
    check_scene,
    read_layers,
)
from grounding.paper.turned_proposals import turned_proposals
from grounding.relation_scene import RelationScene
from grounding.weights import REMEDY, Weights
from tamp.errors import InputError
from tamp.geometric.scene.pose import Array

RESIDUAL = "turn.residual"
"""The array whose presence says that a generator turns argument 1 from where it was."""

MIDDLE = "code.middle"
"""The array whose presence says that codes are of clouds about the middle of their extents."""

TRIES = "choice.tries"
"""The array, one number, that says among how many proposals the own classifier chooses."""

TURNED = "choice.turned"
"""The array whose presence says that each proposal is made with the scene turned about the vertical
otherwise.
"""

CHOICE = 16
"""Among so many where nothing else is said."""

MOST_TRIES = 1000
"""How many those are at most."""


class PaperModel:
    """A classifier and a generator of the paper: `mlp-bb`, `gnn-bb`, `mlp-pc` or `gnn-pc`, as its
    arrays say.

    Args:
        weights: What `training.train` returned.

    Raises:
        InputError: The arrays are not those of such a model.
    """

    def __init__(self, weights: Weights) -> None:
        arrays = weights.arrays
        self.classifier, self.generator = (
            Network(arrays, "classifier"),
            Network(arrays, "generator"),
        )
        self._features = features_in(arrays, self.classifier)
        check_generator(self.generator, self._features.size)
        self._sees = bool(self.classifier.scene or self.generator.scene)
        self._tries, self._turned = _tries(arrays), TURNED in arrays
        if self._turned and not isinstance(self._features, BoxFeatures):
            raise InputError(f"array '{TURNED}' is for models on boxes", remedy=REMEDY)

    def propose(self, situation: RelationScene, count: int, rng: Random) -> Array:
        """Propose `count` poses, in no order: the generator moves argument 1 from where it is, each
        time by other noise. Where the weights say so, each is the one of several that the
        classifier takes for the likeliest to hold.
        """
        seen = self._features.observe(situation, self._sees)
        noise = rng.standard_normal((count * self._tries, NOISE), dtype=np.float32)
        poses = self._poses(seen, noise, rng)
        if self._tries == 1 or not count:
            return poses
        judged_so = classified(self.classifier, self._features, seen, situation, poses)
        best = judged_so.reshape(count, self._tries).argmax(axis=1)
        return poses[np.arange(count) * self._tries + best]

    def _poses(self, seen: FeatureObservation, noise: Floats, rng: Random) -> Array:
        if self._turned and isinstance(self._features, BoxFeatures):
            return turned_proposals(self.generator, seen, self._features.residual, noise, rng)
        positions, turns = generated(self.generator, seen, noise)
        return poses_of(seen, positions.astype(np.float64), unit(turns.astype(np.float64)))

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        """Return the probability that the relation holds with argument 1 at each of the poses,
        shape (n,).
        """
        seen = self._features.observe(situation, self._sees)
        return classified(self.classifier, self._features, seen, situation, poses)


class NumpyEncoder:
    """The encoder of 1D convolutions with kernel 1: each point through the layers, the largest of
    each number.

    Args:
        arrays: `0.weight` (inputs, outputs), `0.bias`, ..., `scale`, by which metres are multiplied
            first (0: each cloud is brought to the cube), and `points`, how many of the cloud's
            points are looked at.

    Raises:
        InputError: The arrays are not those of an encoder.
    """

    def __init__(self, arrays: Arrays) -> None:
        self.layers = read_layers(arrays, "")
        if (
            not self.layers
            or "scale" not in arrays
            or "points" not in arrays
            or self.layers[-1][0].shape[1] != CODE
        ):
            raise InputError(
                "the weights have no encoder of clouds",
                remedy="Train one: tamp-learn encoder --help",
            )
        self.scale, self.points = float(arrays["scale"]), int(arrays["points"])

    def __call__(self, points: Array) -> Floats:
        """Encode a posed, centred cloud, shape (n, 3), metres, as its code, shape (CODE,)."""
        x = scaled(points, self.scale)[: self.points].astype(np.float32)
        for number, (weight, bias) in enumerate(self.layers):
            x = x @ weight
            if number < len(self.layers) - 1:
                x += bias
                np.maximum(x, 0, out=x)
        return x.max(axis=0) + self.layers[-1][1]


def scaled(points: Array, factor: float) -> Array:
    """Compute the scaling (a), by one factor for all clouds, or (b), when it is 0: the largest
    extent fills the cube of edge 1.
    """
    return points * factor if factor else points / max(float(np.ptp(points, axis=0).max()), 1e-9)


def features_in(arrays: Arrays, classifier: Network) -> Features:
    """Return the features that a classifier is for.

    Raises:
        InputError: Neither kind; or they are codes, and there is no encoder; or the network is no
            classifier of them.
    """
    inputs = classifier.main[0][0].shape[0] - (
        classifier.scene[-1][1].shape[0] if classifier.scene else 0
    )
    outputs = classifier.main[-1][1].shape[0]
    if outputs != 1:
        raise InputError(f"the classifier returns {outputs} numbers; it should be 1", remedy=REMEDY)

    check_scene(classifier, inputs // 2)
    residual = RESIDUAL in arrays
    if inputs == 2 * BB:
        return BoxFeatures(residual)
    if inputs == 2 * PC:
        encoder = {
            name.removeprefix("encoder."): array
            for name, array in arrays.items()
            if "encoder." in name
        }
        return CloudFeatures(NumpyEncoder(encoder), residual, MIDDLE in arrays)

    raise InputError(
        f"a classifier of {inputs} features; known: {2 * BB} (boxes), {2 * PC} (clouds)"
    )


def generated(network: Network, seen: FeatureObservation, noise: Floats) -> tuple[Floats, Floats]:
    """Generate positions (n, 3) relative to argument 0, and quaternions (n, 4) of any norm, for
    noise (n, 4).
    """
    inputs = np.empty((len(noise), network.main[0][0].shape[0]), np.float32)
    arguments = seen.arguments.reshape(1, -1).astype(np.float32)
    width = arguments.shape[1]
    inputs[:, :width] = arguments
    if network.scene:
        inputs[:, width:-NOISE] = network.context(arguments, seen.others.astype(np.float32))
    inputs[:, -NOISE:] = noise
    pose = network(inputs)
    return pose[:, :3], pose[:, 3:]


def classified(
    network: Network,
    features: Features,
    seen: FeatureObservation,
    situation: RelationScene,
    poses: Array,
) -> Array:
    """Classify poses: probabilities, shape (n,), with argument 1 at T_world_body, shape (n, 4,
    4).
    """
    return judged(network, seen, features.at(seen, situation, poses))


def judged(network: Network, seen: FeatureObservation, argument: Array) -> Array:
    """Classify features: probabilities, shape (n,), with argument 1's features as given, shape (n,
    f).
    """
    size = argument.shape[1]
    arguments = np.empty((len(argument), 2 * size), np.float32)
    arguments[:, :size], arguments[:, size:] = seen.arguments[0], argument
    inputs = np.concatenate(
        [arguments, network.context(arguments, seen.others.astype(np.float32))], axis=1
    )
    return 1 / (1 + np.exp(-np.clip(network(inputs)[:, 0].astype(np.float64), -60, 60)))


def unit(turns: Array) -> Array:
    """Normalize quaternions, shape (n, 4); no rotation for one that is zero."""
    units = np.empty((len(turns), 4))
    normalize(turns, units)
    return units


def choosing(weights: Weights, tries: int = CHOICE, turned: bool = False) -> Weights:
    """Return the weights of the model that proposes, of `tries` poses each time, the one that its
    own classifier takes for the likeliest to hold; with `turned` each of them with the scene turned
    otherwise.
    """
    extra = {TRIES: np.full(1, tries, np.float32)}
    if turned:
        extra[TURNED] = np.ones(1, np.float32)
    return Weights({**weights.arrays, **extra}, weights.card)


def _tries(arrays: Arrays) -> int:
    if TRIES not in arrays:
        return 1
    number = np.asarray(arrays[TRIES], np.float64)
    if number.shape != (1,) or not 1 <= number[0] <= MOST_TRIES:
        what = f"array '{TRIES}' must be one number from 1 to {MOST_TRIES}"
        raise InputError(what, remedy=REMEDY)
    return int(number[0])
