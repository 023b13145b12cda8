"""The paper's comparison: which of its samplers can be run here, and why the others cannot."""

from __future__ import annotations

from tamp.benchmark.fig8 import FIG8, chosen
from tests.benchmark.samplers import KNOWN


def test_what_is_not_shipped_is_skipped_by_name() -> None:
    able, skipped = chosen(FIG8, KNOWN)
    assert able == {"surface": {"on": "surface", "inside": "surface"}, "flow": {"on": "flow"}}
    assert len(able) + len(skipped) == 12
    assert "no such sampler" in skipped["gnn-pc"]
    assert "not shipped" in skipped["mlp-bb"]
