"""The loop of lazy search over packed states, for numba: what `lazy` and `open_lists` do.

In Python that numba compiles, see `compiled`. Ties are broken alike, so that it does not matter
for the plan which of the two runs.
"""

# pyright: basic

from __future__ import annotations

import math

from tamp.symbolic.search.packed.basics import (
    ACHIEVERS,
    AT,
    BOOST,
    DETOUR,
    ENDURANCE,
    EVALUATED,
    EXPANDED,
    GOAL_ENTRY,
    GOAL_NODE,
    GROUPS,
    LIMIT,
    MEMBERS,
    NODES,
    PROGRESS,
    PUSHED,
    RANDOM,
    ROOT,
    SIZES,
    UNTIL,
)  # fmt: skip
from tamp.symbolic.search.packed.estimates import (
    explore,
    landmarks,
    paid,
    relax,
    relaxed_plan,
    trigger,
)
from tamp.symbolic.search.packed.queues import collect, pop, push, turn
from tamp.symbolic.search.packed.states import (
    achievers,
    applicable,
    apply,
    close_state,
    covers,
    place_of,
    preferred,
    shuffle,
)

EXHAUSTED, GOAL, GROW, PAUSE, FOUND, LIMITED = 0, 1, 2, 3, 4, 5
"""Why the loop stops: no entry is left, a goal state came, arrays are full, it is time to look
around, the goal state's turn has come, no more states may be expanded."""


def evaluate(ints, reals, t, r, x, space, node, parent):
    """Evaluate a state by all heuristics, its relaxed plan into x.plan; return the plan's length.

    A state that comes again keeps its values.
    """
    evaluated = ints[space.evaluated + node]
    length = 0
    for k in range(t.heuristics):
        at = node * t.heuristics + k
        if ints[t.kinds + k] == 0:
            relax(ints, reals, t, r, x, x.closed)
            explore(ints, reals, t, r, x, x.closed)
            reals[space.values + at], length = relaxed_plan(ints, reals, t, r, x)
        elif not evaluated:
            reals[space.values + at] = landmarks(ints, reals, r, x, space, x.closed, node, parent)
    if not evaluated:
        ints[space.evaluated + node] = 1
        ints[EVALUATED] += 1
    for k in range(length):
        ints[x.in_plan + ints[x.plan + k]] = 1
    return length


def expand(ints, reals, t, r, x, space, node, length, weight, below):
    """Expand a state: push its successors, those by preferred operators first."""
    greedy = weight == math.inf
    kinds = t.heuristics
    ints[EXPANDED] += 1
    for k in range(kinds):
        if reals[space.values + node * kinds + k] < reals[k]:
            reals[k] = reals[space.values + node * kinds + k]
            ints[PROGRESS] = ints[EXPANDED]
            for other in range(kinds):
                ints[SIZES + 3 * kinds + other] -= ints[BOOST]
    count = applicable(ints, t, x, x.closed)
    for k in range(count):
        ints[x.is_applicable + ints[x.applicable + k]] = 1
    if ints[RANDOM]:
        ints[RANDOM] = shuffle(ints, ints[RANDOM], x.applicable, count)
        ints[RANDOM] = shuffle(ints, ints[RANDOM], x.plan, length)
    first = preferred(ints, t, x, space, node, x.closed, length)
    if ints[ACHIEVERS]:
        first = achievers(ints, t, r, x, space, node, first, count)

    cost, spent = reals[space.cost + node], reals[space.spent + node]
    # among equals weighted A* takes the older, greedy search what is nearest to the last progress
    base = ints[PUSHED] + 1
    if greedy:
        base = (
            ((ints[space.detour + node] + 2) << DETOUR) - (ints[space.root + node] << ROOT) - node
        )
    found, classes, chosen = 0, 0, 0
    for rank in range(first + count):
        i = ints[x.helpful + rank] if rank < first else ints[x.applicable + rank - first]
        if rank >= first and ints[x.is_helpful + i]:
            continue
        if spent + reals[t.own + i] >= below:
            continue
        apply(ints, t, i, space.states + node * t.words, x.closed, x.after)
        closed = ints[
            space.table + (place_of(ints, t.words, x.after, space.states, space.table, space.mask))
        ]
        step = reals[t.costs + i]
        if closed >= 0 and (greedy or cost + step >= reals[space.cost + closed]):
            continue
        reached = cost + (step + reals[x.extras + i] if ints[t.guarded + i] else step)
        if reached == math.inf or (closed >= 0 and reached >= reals[space.cost + closed]):
            continue

        dearer = reached - cost - step
        counts = dearer != 0.0 and ints[x.in_plan + i]
        covered = paid(ints, reals, r, x, i) if counts else 0.0
        classes = collect(
            ints, reals, x, found, classes, rank if greedy else found, i, reached,
            0.0 if greedy else step, dearer, covered,
        )  # fmt: skip
        found += 1
        chosen += rank < first
    ints[PUSHED] += found
    push(ints, reals, t, x, space, node, found, chosen, classes, base, weight)

    for k in range(count):
        ints[x.is_applicable + ints[x.applicable + k]] = 0
    for k in range(first):
        ints[x.is_helpful + ints[x.helpful + k]] = 0


def place(ints, reals, t, space, node, parent, rank):
    """Note which state made the last progress on the way to one, and how far that is away."""
    kinds = t.heuristics
    ints[space.root + node], ints[space.detour + node] = node, 0
    if parent < 0:
        return
    root = ints[space.root + parent]
    for k in range(kinds):
        if reals[space.values + node * kinds + k] < reals[space.values + root * kinds + k]:
            return
    ints[space.root + node] = root
    ints[space.detour + node] = ints[space.detour + parent] + 1 + rank


def arrive(ints, reals, t, x, space, i, parent, reached, greedy):
    """Go by an operator from a state to the next, into x.after, and close it, or open it again.

    Returns:
        Its node; -1 where it was closed at no higher cost.
    """
    if parent < 0:
        for w in range(t.words):
            ints[x.after + w] = ints[t.initial + w]
    else:
        if ints[t.con_starts + i] < ints[t.con_starts + i + 1]:
            for w in range(t.words):
                ints[x.other + w] = ints[space.states + parent * t.words + w]
            close_state(ints, t, x.other)
        apply(ints, t, i, space.states + parent * t.words, x.other, x.after)
    place = place_of(ints, t.words, x.after, space.states, space.table, space.mask)
    node = ints[space.table + place]
    if node >= 0 and (greedy or reached >= reals[space.cost + node]):
        return -1

    if node < 0:
        node = ints[NODES]
        ints[NODES] += 1
        ints[space.table + place] = node
        for w in range(t.words):
            ints[space.states + node * t.words + w] = ints[x.after + w]
    reals[space.cost + node], ints[space.parent + node] = reached, parent
    ints[space.operator + node] = i
    reals[space.spent + node] = (
        reals[space.spent + parent] + reals[t.own + i] if parent >= 0 else 0.0
    )
    return node


def run(ints, reals, t, r, x, space, weight, below):
    """Search until something is to be told; x.closed and ints[AT] are about the state at hand."""
    kinds, greedy = t.heuristics, weight == math.inf
    while True:
        if ints[NODES] + 1 >= space.nodes:
            return GROW
        if ints[GROUPS] + kinds * (t.operators + 2) >= space.groups:
            return GROW
        if ints[MEMBERS] + (kinds + 1) * t.operators + 2 >= space.pool:
            return GROW
        if ints[EXPANDED] >= ints[UNTIL]:
            return PAUSE
        chosen = turn(ints, reals, t, space, greedy)
        if chosen < 0:
            return EXHAUSTED

        parent, member = pop(ints, reals, space, chosen, greedy)
        i = (ints[space.members + member] & 0xFFFFFFFF) + GOAL_ENTRY
        reached = reals[space.member_cost + member]
        if i == GOAL_ENTRY:
            if parent == ints[GOAL_NODE]:
                return FOUND
            continue
        node = arrive(ints, reals, t, x, space, i, parent, reached, greedy)
        if node < 0:
            continue
        for w in range(t.words):
            ints[x.closed + w] = ints[x.after + w]
        trigger(ints, reals, t, x, x.closed)
        close_state(ints, t, x.closed)
        if covers(ints, t, x.closed):
            ints[AT] = node
            return GOAL

        length = evaluate(ints, reals, t, r, x, space, node, parent)
        dead = False
        for k in range(kinds):
            dead = dead or reals[space.values + node * kinds + k] == math.inf
        if not dead:
            expanded = ints[EXPANDED]
            if expanded >= ints[LIMIT] or expanded - ints[PROGRESS] >= ints[ENDURANCE]:
                return LIMITED
            place(ints, reals, t, space, node, parent, ints[space.members + member] >> 32)
            expand(ints, reals, t, r, x, space, node, length, weight, below)
        for k in range(length):
            ints[x.in_plan + ints[x.plan + k]] = 0
