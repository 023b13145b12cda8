"""What a run holds is let go when it ends, without waiting for the collector of cycles."""

from __future__ import annotations

import gc

import tamp
from tamp.algorithms.binding import Binder
from tamp.algorithms.stream import Streams


def test_a_run_leaves_nothing_to_the_collector_of_cycles() -> None:
    problem = tamp.load_problem("one_object")
    gc.collect()
    gc.disable()
    try:
        before = sum(isinstance(thing, Streams | Binder) for thing in gc.get_objects())
        assert tamp.solve(problem, max_time=30.0, seed=0).plan
        after = sum(isinstance(thing, Streams | Binder) for thing in gc.get_objects())
    finally:
        gc.enable()
    assert after == before
