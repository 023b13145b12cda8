"""The paper's comparison of samplers, its figure 8, with ours beside.

It stays a command and no script of `benchmarks/`: whoever installs tamp can repeat the figure.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from tamp.benchmark.case import relations
from tamp.errors import InputError
from tamp.geometric.samplers.choice import Registry

FIG8 = (
    "uniform",
    "uniform+mlp:alone",
    "uniform+gnn:alone",
    "tree-bb:alone",
    "tree-pc:alone",
    "mlp-bb:alone",
    "gnn-bb:alone",
    "mlp-pc:alone",
    "gnn-pc:alone",
    "surface",
    "transfer",
    "flow",
)
"""Uniform and the paper's learned ones, each alone as in the paper; the hand-made one; ours, mixed
with it as usual.
"""


def chosen(
    samplers: Sequence[str], registry: Registry
) -> tuple[dict[str, Mapping[str, str]], dict[str, str]]:
    """Choose the samplers that can be run, by relation, and say why the others cannot.

    Args:
        samplers: As in `Case`.
        registry: All samplers by relation and name.
    """
    able: dict[str, Mapping[str, str]] = {}
    skipped: dict[str, str] = {}
    for sampler in samplers:
        name = sampler.partition(":")[0]
        if not any(name in makers for makers in registry.values()):
            skipped[name] = "this version has no such sampler"
            continue
        try:
            able[sampler] = relations(sampler, registry)
        except InputError as error:
            skipped[name] = f"its weights are not shipped ({error})"
    return able, skipped
