"""Whether a bound plan holds with what streams found besides."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from tamp.algorithms.binding import substitute
from tamp.algorithms.skeleton import Skeleton
from tamp.algorithms.statistics import Experience
from tamp.pddl.structs import Fact, Task
from tamp.search.instantiate import instantiate
from tamp.search.trace import replayed


def stands(
    task: Task,
    types: Mapping[str, tuple[str, ...]],
    skeleton: Skeleton,
    values: dict[int, str],
    wild: Iterable[Fact],
    experience: Experience,
) -> bool:
    """Replay a bound plan over what was certified and found: a condition may want something of it to be absent.

    If it does not hold, the skeleton forgets the values, and what gave them is noted to have failed once more.
    """
    certified = {substitute(fact, values) for fact in skeleton.certified}
    grounded = instantiate(task, sorted(certified.union(wild)), types)
    bound = [(name, substitute((name, terms), values)[1:]) for name, terms in skeleton.actions]
    if replayed(grounded, bound):
        return True
    skeleton.memory.clear()
    for node in skeleton.nodes:
        if node.outputs:
            experience.note(node.fact, "what was found besides forbids the plan")
    return False
