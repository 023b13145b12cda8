"""Networks with their first weights, in torch and as arrays."""

import numpy as np
import torch

from grounding.paper import networks
from grounding.paper.encoders import EncoderOptions
from grounding.paper.networks import Ensemble
from grounding.weights import Weights


def random_classifier(size, scene, bias=0.0):
    part = Ensemble(networks.classifier_shapes(size, scene), [torch.Generator().manual_seed(0)])
    arrays = {f"classifier.{name}": array for name, array in part.model(0).items()}
    last = max(name for name in arrays if ".main." in name and name.endswith("bias"))
    return Weights({**arrays, last: arrays[last] + np.float32(bias)}, {})


def untrained(size, scene, attention=False):
    """An ensemble of two of each network, and the second's arrays."""
    randoms = [torch.Generator().manual_seed(seed) for seed in range(2)]
    parts = {
        "classifier": Ensemble(networks.classifier_shapes(size, scene, attention), randoms),
        "generator": Ensemble(networks.generator_shapes(size, scene, attention), randoms),
    }
    for part in parts.values():
        for name, tensor in part.fixed.items():
            if name.endswith("bias"):
                tensor.uniform_(-0.1, 0.1, generator=randoms[0])
    arrays = {
        f"{name}.{key}": array
        for name, part in parts.items()
        for key, array in part.model(1).items()
    }
    return parts, arrays


FEW = EncoderOptions(iterations=2, batch=4, validation=4, points=128, validate_every=1)
