"""The landmark-cut heuristic (Helmert and Domshlak, Landmarks, Critical Paths and Abstractions,
2009): admissible.

Each cut is a set of operators of which every plan of the delete relaxation needs one. It counts
with the cost of the cheapest, which is taken off the cost of all operators in it. An operator with
conditional effects is several relaxed operators: all of them get cheaper when one is in a cut,
since one application may do all they do.

Which of an operator's dearest preconditions stands for it is free, and decides how high the
estimate gets (Bonet and Helmert, Strengthening Landmark Heuristics via Hitting Sets, 2010): here
it is one that few operators add, and a cut has only operators all of whose preconditions are
reached without it.
"""

from __future__ import annotations

from tamp.symbolic.search.heuristics.relaxation import MAX_RELAXED_STATES, Relaxation
from tamp.symbolic.search.heuristics.relaxed_state import RelaxedState
from tamp.symbolic.search.successors import State

EXPECTED_CUTS = 10
"""So many cuts an estimate takes for granted, in telling what it will cost."""


class LandmarkCut:
    """The heuristic for the states that share one relaxed task.

    Two facts are added: one that always holds, for operators without preconditions, and one that
    stands for the goal.

    Args:
        relaxation: Whose operators they are.
        relaxed_state: The relaxed task.
    """

    def __init__(self, relaxation: Relaxation, relaxed_state: RelaxedState) -> None:
        self._relaxation = relaxation
        self.relaxed_state = it = relaxed_state
        self._true = true = it.facts
        self._goal = goal = true + 1
        kernels, last, goals = it.kernels, it.operators, relaxation.goals or [true]
        integers = kernels.integers
        at, what = (
            [*relaxation.free, *[last] * len(goals)],
            [*[true] * len(relaxation.free), *goals],
        )
        before = kernels.appended(it.before, integers(at), integers(what), last + 1)
        effects = kernels.appended(it.effects, integers((last,)), integers((goal,)), last + 1)
        self._rows = (
            before,
            effects,
            kernels.transposed(before, goal + 1),
            kernels.transposed(effects, goal + 1),
        )
        self._costs = kernels.incremented(it.costs, integers(()), kernels.reals(()), 1)

    def value(self, closed: State) -> float:
        """Estimate the cost from a state with its derived facts by landmark cuts; infinite in a
        dead end.
        """
        kernels = self.relaxed_state.kernels
        here = kernels.integers(
            (*self._relaxation.holding(closed), self._true, *self.relaxed_state.paid)
        )
        return kernels.landmark_cut(
            *self._rows,
            self._costs,
            here,
            self._relaxation.owners,
            self._relaxation.groups,
            self._goal,
        )


class LandmarkCuts:
    """`LandmarkCut` for every relaxed task that states ask for."""

    def __init__(self, relaxation: Relaxation) -> None:
        self._relaxation = relaxation
        self._cuts: dict[State, LandmarkCut] = {}

    def value(self, closed: State) -> float:
        """Estimate the cost from a state with its derived facts."""
        relaxed_state, key = (
            self._relaxation.relaxed_state(closed, EXPECTED_CUTS),
            self._relaxation.key(closed),
        )
        cached = self._cuts.get(key)
        if cached is None or cached.relaxed_state.kernels is not relaxed_state.kernels:
            if len(self._cuts) >= MAX_RELAXED_STATES:
                self._cuts.clear()
            cached = self._cuts[key] = LandmarkCut(self._relaxation, relaxed_state)
        return cached.value(closed)
