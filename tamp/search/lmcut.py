"""The landmark-cut heuristic (Helmert and Domshlak, Landmarks, Critical Paths and Abstractions, 2009): admissible.

Each cut is a set of operators of which every plan of the delete relaxation needs one. It counts with the cost of the
cheapest, which is taken off the cost of all operators in it. An operator with conditional effects is several relaxed
operators: all of them get cheaper when one is in a cut, since one application may do all they do.
"""

from __future__ import annotations

from tamp.search.compiled import kernels
from tamp.search.compiled.rows import extended, integers
from tamp.search.relaxation import KEPT, Relaxation, Situation
from tamp.search.successors import State


class LandmarkCut:
    """The heuristic for the states that share one relaxed task.

    Two facts are added: one that always holds, for operators without preconditions, and one that stands for the goal.

    Args:
        relaxation: Whose operators they are.
        situation: The relaxed task.
    """

    def __init__(self, relaxation: Relaxation, situation: Situation) -> None:
        self._relaxation = relaxation
        self._true = true = len(situation.needed)
        self._goal = goal = true + 1
        free, goals, last = situation.before.empty(), relaxation.goals or [true], len(situation.before)
        self._before = situation.before.with_more(
            [*free, *[last] * len(goals)], [*[true] * len(free), *goals], last + 1
        )
        self._effects = situation.effects.with_more([last], [goal], last + 1)
        self._needed = self._before.transposed(goal + 1)
        self._adders = self._effects.transposed(goal + 1)
        self._costs = extended(situation.costs, 1)
        self._paid = situation.paid.tolist()

    def value(self, closed: State) -> float:
        """The estimate for a state with its derived facts; infinite in a dead end."""
        here = integers((*self._relaxation.holding(closed), self._true, *self._paid))
        rows = (self._before, self._effects, self._needed, self._adders)
        groups = self._relaxation.of_operator
        return kernels.landmark_cut(
            *(array for lists in rows for array in (lists.starts, lists.values)),
            self._costs, here, self._relaxation.owners, groups.starts, groups.values, self._goal,
        )  # fmt: skip


class LandmarkCuts:
    """`LandmarkCut` for every relaxed task that states ask for."""

    def __init__(self, relaxation: Relaxation) -> None:
        self._relaxation = relaxation
        self._known: dict[State, LandmarkCut] = {}

    def value(self, closed: State) -> float:
        """The estimate for a state with its derived facts."""
        key = self._relaxation.key(closed)
        known = self._known.get(key)
        if known is None:
            if len(self._known) >= KEPT:
                self._known.clear()
            known = self._known[key] = LandmarkCut(self._relaxation, self._relaxation.situation(closed))
        return known.value(closed)
