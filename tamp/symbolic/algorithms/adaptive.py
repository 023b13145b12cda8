"""The adaptive algorithm: search optimistic facts, bind stream calls, learn from what fails.

After PDDLStream's adaptive algorithm (Garrett, Lozano-Perez, Kaelbling, ICAPS 2020), in one
process, its effort divided by counted work instead of the clock, so that the same seed gives the
same plan. A round is five lines of `plan_adaptively`: search the optimistic task, build the plan's
skeleton, bind it, and, where that fails, learn. What comes besides is in `escalation`: where rounds
lead nowhere, more is instantiated, or the incremental algorithm is asked.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tamp.symbolic.algorithms.binding.skeleton import Skeleton
from tamp.symbolic.algorithms.escalation import (
    Escalation,
    escalate,
    instantiate_more,
    look_at_real_values,
)
from tamp.symbolic.algorithms.knowledge import (
    Knowledge,
    add_wild_facts,
    record_exhausted_calls,
    restore_objects,
)
from tamp.symbolic.algorithms.optimistic.irrelevant_objects import (
    irrelevant_objects,
    objects_with_failures,
)
from tamp.symbolic.algorithms.optimistic.optimistic_task import optimistic_task
from tamp.symbolic.algorithms.outcomes import (
    infeasible_result,
    interrupted_result,
    solved_result,
)
from tamp.symbolic.algorithms.planning_run import (
    Run,
    bind_skeleton,
    renew,
    search_plan,
    skeleton_of,
    start_run,
)
from tamp.symbolic.algorithms.planning_task import prepare
from tamp.symbolic.algorithms.result import Progress, Result, StreamTask
from tamp.system.deadline import Deadline, OutOfTime
from tamp.system.garbage import infrequent_collection

FIRST_TRIES = 4
"""Draws a visit of a stream call in a skeleton's first round, one more in each later one: a bad
grasp shall not be tried with all poses before the next one has its turn."""

ROUND_DRAWS = 200
"""Draws in a skeleton's first round at least."""

NODE_DRAWS = 5
"""Draws for each of its nodes: a long one shall be gone through more than once, since its search
was long as well."""

LONG_SEARCH = 150
"""Expanded states of a long search: the same plan would be found again, at the same expense, only
to be given another try in each round."""

DRAWS_FOR_A_STATE = 4
"""Draws that a skeleton gets at least for each state of a long search, and one at least for each of
its calls: the search, and putting the skeleton together, so take no more than about a quarter of
the time. `MOST_SHARES` times as many are the most in one of its rounds."""

MOST_SHARES = 10

MANY_ROUNDS = 16
"""Rounds of such a skeleton up to which its tries grow by half, after that by one."""

ROUNDS_BEFORE_ALL_OBJECTS = 3
"""Rounds of a skeleton after which no object is excluded any more, even if nothing failed at it."""


def solve_adaptive(
    problem: StreamTask,
    make_rng: Callable[[str], Any],
    deadline: Deadline,
    progress: Progress,
) -> Result:
    """Plan by the adaptive algorithm.

    Some plans do not show in the optimistic task, such as putting a body down only to grasp it
    anew: all poses and grasps look alike there. So when something fails and fails, the incremental
    algorithm is asked for a second opinion.

    Args:
        problem: The task and its streams.
        make_rng: A random generator from a string (see Streams).
        deadline: When to give up.
        progress: Told between rounds.
    """
    return plan_adaptively(start_adaptive(problem, make_rng, deadline, progress))


def start_adaptive(
    problem: StreamTask,
    make_rng: Callable[[str], Any],
    deadline: Deadline,
    progress: Progress,
) -> Run:
    """Begin a run; nothing is instantiated of objects that the goal may have no need of."""
    knowledge = Knowledge(excluded_objects=irrelevant_objects(problem.task))
    return start_run(prepare(problem), knowledge, optimistic_task, make_rng, deadline, progress)


@infrequent_collection()
def plan_adaptively(run: Run) -> Result:
    """Alternate search and binding until a plan is bound, nothing is left, or time is up."""
    escalation = Escalation()
    try:
        while True:
            drawn_before = run.binder.draws
            found = search_plan(run)
            if found is None:
                result = _without_plan(run)
            else:
                skeleton = skeleton_of(run, found)
                if run.latest is not None and found.expanded >= LONG_SEARCH:
                    skeleton.recall(run.latest)
                run.latest = skeleton
                values = bind_within_effort(run, skeleton, found.expanded)
                if values is not None:
                    return solved_result(run, skeleton, values)
                result = update_knowledge(run, skeleton)

            result = result or escalate(run, escalation, run.binder.draws > drawn_before)
            if result is not None:
                return result
            run.progress(run.effort)
    except (OutOfTime, KeyboardInterrupt) as error:
        return interrupted_result(run, error)


def bind_within_effort(run: Run, skeleton: Skeleton, expanded: int) -> dict[int, str] | None:
    """Bind a skeleton; after a long search with more and more tries, as long as that costs less.

    Args:
        run: The run.
        skeleton: What to bind.
        expanded: The states that its search took.
    """
    share = 0
    if expanded >= LONG_SEARCH:
        share = max(DRAWS_FOR_A_STATE * expanded, len(skeleton.nodes))
    worth = run.binder.draws + share

    def is_worth_more() -> bool:
        """Have the next round make more tries, unless the skeleton has had its share."""
        if run.binder.draws >= worth:
            return False
        rounds = skeleton.rounds
        skeleton.rounds += 1 + (rounds // 2 if rounds < MANY_ROUNDS else 0)
        return True

    def more() -> int | None:
        return draws_of_round(skeleton)[0] if is_worth_more() else None

    while True:
        before = run.binder.draws
        tries, budget = draws_of_round(skeleton)
        budget = min(budget, MOST_SHARES * share) if share else budget
        values = bind_skeleton(run, skeleton, tries, budget, more=more)
        if values is not None or run.binder.draws == before or not is_worth_more():
            return values


def draws_of_round(skeleton: Skeleton) -> tuple[int, int]:
    """Return the new draws a visit of a node, and those in all, of a skeleton's next round."""
    draws = max(ROUND_DRAWS, NODE_DRAWS * len(skeleton.nodes))
    return FIRST_TRIES + skeleton.rounds, draws * (1 + skeleton.rounds)


def update_knowledge(run: Run, skeleton: Skeleton) -> None:
    """Take over what a round in vain has shown, and instantiate anew where that changes the task.

    Prices need no such step: the binder keeps them, and the next search asks for them.
    """
    skeleton.rounds += 1
    run.effort.draws = run.binder.draws
    knowledge = run.knowledge
    learned = add_wild_facts(knowledge, run.streams)
    objects = run.task.problem.task.objects
    learned |= record_exhausted_calls(knowledge, skeleton, run.streams, objects)

    wanted = None
    if skeleton.rounds < ROUNDS_BEFORE_ALL_OBJECTS:
        wanted = objects_with_failures(knowledge.excluded_objects, knowledge.experience)
    if restore_objects(knowledge, wanted) or learned:
        renew(run)


def _without_plan(run: Run) -> Result | None:
    """Instantiate more where there is no plan; if there is no more, the task is infeasible."""
    if run.deadline.passed:
        raise OutOfTime
    run.doubtful = True
    if instantiate_more(run):
        return None
    return look_at_real_values(run) or infeasible_result(run)
