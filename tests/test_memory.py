"""What a run holds is let go when it ends, without waiting for the collector of cycles."""

from __future__ import annotations

import gc

import tamp
from tamp.symbolic.algorithms.binding.binder import Binder
from tamp.symbolic.algorithms.bound_stream import Streams


def test_a_run_leaves_nothing_to_the_collector_of_cycles() -> None:
    problem = tamp.load_problem("one_object")
    gc.collect()
    gc.disable()
    try:
        before = _held()
        assert tamp.solve(problem, max_time=30.0, seed=0).plan
        after = _held()
    finally:
        gc.enable()
    assert after <= before


def _held() -> int:
    """How many of a run's parts there are. By type(): isinstance would ask objects of torch, which warn when asked."""
    return sum(type(thing) in (Streams, Binder) for thing in gc.get_objects())
