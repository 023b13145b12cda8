"""Forward search over states, by name."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tamp.errors import InputError
from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.eager import astar, best_first
from tamp.symbolic.search.expansion import Plan as Plan
from tamp.symbolic.search.expansion import Reason as Reason
from tamp.symbolic.search.expansion import SearchLimitReached, SearchSpace, TooSlow
from tamp.symbolic.search.heuristics.registry import ADMISSIBLE, HEURISTICS, Heuristic
from tamp.symbolic.search.lazy import lazy
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.packed import selection
from tamp.symbolic.search.packed.restarts import STALLED_STATES, greedy_with_restarts
from tamp.symbolic.search.packed.search import fits, packed_lazy
from tamp.symbolic.search.successors import Price, Successors
from tamp.system.deadline import Deadline


@dataclass(frozen=True, slots=True)
class SearchResult:
    """The result of a search.

    Attributes:
        plan: None when there is none, then `reason` says why.
        expanded: States whose successors were generated.
        evaluated: States that the heuristics were asked about.
        bound: What no plan costs less than, as far as A* with an admissible heuristic knows; 0
            after other searches.
        estimate: What the first heuristic says of the initial state, with prices; 0 after searches
            that are not lazy.
    """

    plan: Plan | None
    reason: Reason | None
    expanded: int
    evaluated: int
    bound: float = 0.0
    estimate: float = 0.0


SEARCHES: dict[str, Callable[[SearchSpace, float], Plan | None]] = {
    "astar": lambda search, weight: astar(search),
    "wastar": lazy,
    "greedy": lambda search, weight: lazy(search, math.inf),
    "eager": lambda search, weight: best_first(search),
}


def split_heuristics(heuristic: str) -> tuple[str, ...]:
    """Split the names in "ff+landmarks".

    Raises:
        InputError: A name of none.
    """
    names = tuple(dict.fromkeys(heuristic.split("+")))
    for name in names:
        if name not in HEURISTICS:
            raise InputError(f"unknown heuristic '{name}'", found=name, choices=HEURISTICS)
    return names


def search(
    instantiated: InstantiatedTask,
    *,
    search: str = "wastar",
    heuristic: str = "ff",
    weight: float = 5.0,
    price: Price | None = None,
    limit: int | None = None,
    endurance: int | None = None,
    deadline: Deadline | None = None,
    below: float = math.inf,
    audit: Callable[[], bool] | None = None,
    seed: int = 0,
) -> SearchResult:
    """Search for a plan.

    Args:
        instantiated: The task.
        search: A name of `SEARCHES`. "astar" with an admissible heuristic ("lmcut", "hmax",
            "blind") is optimal; where `price` waives guards, with "blind" alone, since the others
            count a guard's price for each operator that it stands before. "wastar" and "greedy" are
            lazy and use preferred operators, "eager" is plain greedy best-first search.
        heuristic: A name of `HEURISTICS`, or several: "ff+landmarks". The lazy searches give queues
            to each, "astar" takes the maximum, "eager" the sum.
        weight: Of the estimate in "wastar".
        price: What the use of a static fact costs (by an operator resting on it, to waive a guard,
            and in the lazy searches where the goal is derived from it); may be infinite. A mapping
            of those that cost something is faster than a function. Nothing by default.
        limit: Most states to expand.
        endurance: In "wastar", most states to expand without a new low of an estimate.
        deadline: When to give up. It never changes the plan that is found, only whether one is.
        below: What the plan must cost less than: in "wastar" its operators alone, in "astar" with
            prices. Not for the greedy searches, which keep to the first way to each state.
        audit: Asked once, when the search turns out not to be a short one: whether it is proven
            that there is no plan.
        seed: Of the random orders in which greedy search without a limit begins anew where it
            stalls.
    """
    if search not in SEARCHES:
        raise InputError(f"unknown search '{search}'", found=search, choices=SEARCHES)
    if below < math.inf and search not in ("wastar", "astar"):
        raise InputError(f"a limit of the cost is for wastar and astar, not for '{search}'")
    names = split_heuristics(heuristic)
    if not instantiated.goal.positive <= instantiated.reachable | instantiated.initial:
        return SearchResult(None, Reason.UNSOLVABLE, 0, 0, math.inf)
    successors = Successors(instantiated, price if price is not None else {})

    packable = search in ("wastar", "greedy") and fits(names, successors)

    def space(heuristics: Sequence[Heuristic] = ()) -> SearchSpace:
        made = SearchSpace(successors, heuristics, limit, deadline, below, audit)
        made.endurance = endurance if search == "wastar" else None
        return made

    def packed(run: SearchSpace) -> Plan | None:
        late = deadline is not None and deadline.passed  # compiled loops look only now and then
        if late and not successors.holds_goal(successors.closure(successors.initial)):
            raise SearchLimitReached(Reason.TIME)
        if search == "greedy" and limit is None:
            return greedy_with_restarts(run, names, seed)
        return packed_lazy(run, names, math.inf if search == "greedy" else weight)

    if packable and selection.pays(0):
        run = space()
        plan, reason = _attempt(run, packed)
    else:
        run = first = space([HEURISTICS[name](successors) for name in names])
        if packable:
            run.too_slow = lambda: (
                (search == "greedy" and limit is None and run.expanded >= STALLED_STATES)
                or selection.pays(run.patience * successors.entries)
            )
        try:
            plan, reason = _attempt(run, lambda run: SEARCHES[search](run, weight))
        except TooSlow:
            run = space()
            plan, reason = _attempt(run, packed)
        finally:
            first.too_slow = None  # it holds the run, which holds it

    return SearchResult(
        plan,
        reason,
        run.expanded,
        run.evaluated,
        run.bound if ADMISSIBLE.issuperset(names) else 0.0,
        run.first,
    )


def _attempt(
    run: SearchSpace, find: Callable[[SearchSpace], Plan | None]
) -> tuple[Plan | None, Reason | None]:
    """Look for a plan; return it, or why there is none."""
    try:
        plan = find(run)
    except SearchLimitReached as stop:
        return None, stop.reason
    return plan, None if plan else Reason.UNSOLVABLE


def unreachable(instantiated: InstantiatedTask) -> tuple[Fact, ...]:
    """Return the goal facts that hold in no state of the delete relaxation, sorted.

    A fact that must not hold and that nothing can make false is given as ("not", ...). Facts that
    stand for a subformula are explained in `instantiated.meanings`.
    """
    goal = instantiated.goal
    never = sorted(goal.positive - instantiated.reachable - instantiated.initial)
    deleted = {fact for o in instantiated.operators for fact in o.deleted}
    deleted |= {
        fact for o in instantiated.operators for effect in o.conditional for fact in effect.deleted
    }
    kept = sorted(("not", *fact) for fact in (goal.negative & instantiated.initial) - deleted)
    return (*never, *kept)
