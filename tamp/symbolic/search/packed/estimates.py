"""Heuristics over packed states: what `heuristics.relaxation` and `.landmarks` say, for numba.

In Python that numba compiles, see `compiled`. All give the numbers that the plain heuristics give,
ties included: facts of the same cost are taken in the order in which they got it.
"""

# pyright: basic

from __future__ import annotations

import math

from tamp.symbolic.search.packed.basics import FORGIVING, contains, has, heap_pop, heap_push


def trigger(ints, reals, t, x, state):
    """Find the triggered guards of a state, and what the operators cost more there."""
    for g in range(t.guards):
        if ints[x.on + g]:
            for k in range(ints[t.fine_starts + g], ints[t.fine_starts + g + 1]):
                reals[x.extras + ints[t.fines + k]] = 0.0

    for g in range(t.guards):
        ints[x.on + g] = contains(ints, t.guard_starts, t.guard_facts, g, state)
        if ints[x.on + g]:
            for k in range(ints[t.fine_starts + g], ints[t.fine_starts + g + 1]):
                reals[x.extras + ints[t.fines + k]] += reals[t.fine_prices + k]


def relax(ints, reals, t, r, x, state):
    """Set up the relaxed task of a state, whose guards are triggered already."""
    for i in range(r.operators):
        ints[x.left + i] = ints[r.waits + i]
        reals[x.costs + i] = reals[r.costs + i]

    for k in range(r.rise_count):
        reals[x.raised + ints[r.rises + k]] = 0.0
    for g in range(t.guards):
        if ints[x.on + g]:
            for k in range(ints[r.rise_starts + g], ints[r.rise_starts + g + 1]):
                reals[x.raised + ints[r.rises + k]] += reals[r.rise_prices + k]
                for n in range(
                    ints[r.groups_starts + ints[r.rises + k]],
                    ints[r.groups_starts + ints[r.rises + k] + 1],
                ):
                    reals[x.costs + ints[r.groups + n]] += reals[r.rise_prices + k]

    for key in range(r.keys):
        ints[x.active + key] = contains(ints, r.key_starts, r.key_facts, key, state)
        if ints[x.active + key]:
            for k in range(ints[r.member_starts + key], ints[r.member_starts + key + 1]):
                ints[x.left + ints[r.members + k]] += 1
    for i in range(r.operators):
        reals[x.totals + i] = reals[x.costs + i]


def reach(ints, reals, r, x, fact, cost, operator, entries, heap, top):
    """Note a cheaper way to a fact; return the sizes of the heap and the highest bucket."""
    reals[x.reached + fact] = cost
    ints[x.supporters + fact] = operator
    ints[x.entry_fact + entries] = fact
    if cost < r.buckets:
        b = int(cost)
        ints[x.entry_next + entries] = -1
        if ints[x.heads + b] < 0:
            ints[x.heads + b] = entries
        else:
            ints[x.entry_next + ints[x.tails + b]] = entries
        ints[x.tails + b] = entries
        return heap, max(top, b)
    heap_push(ints, reals, x.heap_keys, x.heap_ties, x.heap_items, heap, cost, entries, fact)
    return heap + 1, top


def fire(ints, reals, r, x, i, total, entries, heap, top):
    """Reach the effects of a relaxed operator; return how many entries, and as `reach`."""
    for k in range(ints[r.effects_starts + i], ints[r.effects_starts + i + 1]):
        effect = ints[r.effects + k]
        if total < reals[x.reached + effect]:
            heap, top = reach(ints, reals, r, x, effect, total, i, entries, heap, top)
            entries += 1
    return entries, heap, top


def begin(ints, reals, t, r, x, closed):
    """Reach what holds in a state, or can be paid for, and what needs nothing."""
    for fact in range(r.facts):
        reals[x.reached + fact] = math.inf
        ints[x.supporters + fact] = -1

    entries, heap, top = 0, 0, -1
    for key in range(r.keys):
        if ints[x.active + key] and reals[r.key_prices + key] < math.inf:
            heap, top = reach(
                ints, reals, r, x, r.base + key, reals[r.key_prices + key], -1, entries, heap, top
            )
            entries += 1
    for w in range(t.words):
        word, fact = ints[closed + w], w << 6
        while word != 0:
            if word & 1:
                heap, top = reach(ints, reals, r, x, fact, 0.0, -1, entries, heap, top)
                entries += 1
            word = (word >> 1) & 0x7FFFFFFFFFFFFFFF
            fact += 1

    for k in range(r.negative_count):
        fact = ints[r.negative_goals + k]
        if not has(ints, closed, fact):
            heap, top = reach(ints, reals, r, x, (r.base >> 1) + fact, 0.0, -1, entries, heap, top)
            entries += 1
    for k in range(r.free_count):
        if not ints[x.left + ints[r.free + k]]:
            entries, heap, top = fire(
                ints,
                reals,
                r,
                x,
                ints[r.free + k],
                reals[x.totals + ints[r.free + k]],
                entries,
                heap,
                top,
            )
    return entries, heap, top


def explore(ints, reals, t, r, x, closed):
    """Compute the facts' costs and best supporters by hadd, until all goals are known."""
    entries, heap, top = begin(ints, reals, t, r, x, closed)

    now, bucket = 0.0, 0
    while True:
        while bucket <= top and ints[x.heads + bucket] < 0:
            bucket += 1
        if bucket <= top:
            e = ints[x.heads + bucket]
            ints[x.heads + bucket] = ints[x.entry_next + e]
            fact, cost = ints[x.entry_fact + e], float(bucket)
        elif heap:
            fact, cost = ints[x.heap_items], reals[x.heap_keys]
            heap_pop(ints, reals, x.heap_keys, x.heap_ties, x.heap_items, heap)
            heap -= 1
        else:
            break
        if reals[x.reached + fact] != cost:
            continue
        if cost > now:  # all facts that cost less are done: is the goal among them?
            dearest = 0.0
            for k in range(r.goal_count):
                dearest = max(dearest, reals[x.reached + ints[r.goals + k]])
            if dearest <= now:
                break
            now = cost

        for n in range(ints[r.needs_starts + fact], ints[r.needs_starts + fact + 1]):
            i = ints[r.needs + n]
            if (
                i >= r.first_remover
                and not ints[x.active + ints[r.remover_key + i - r.first_remover]]
            ):
                continue
            ints[x.left + i] -= 1
            reals[x.totals + i] += cost
            if not ints[x.left + i]:
                entries, heap, top = fire(
                    ints, reals, r, x, i, reals[x.totals + i], entries, heap, top
                )
    for b in range(bucket, top + 1):
        ints[x.heads + b] = -1


def relaxed_plan(ints, reals, t, r, x):
    """Extract a relaxed plan into x.plan, as `heuristics.loops.kernels` does: cost, length."""
    for fact in range(r.facts):
        ints[x.seen + fact] = 0
        reals[x.bounds + fact] = math.inf
        reals[x.provided + fact] = math.inf

    size, paid = 0, 0
    for k in range(r.goal_count):
        goal = ints[r.goals + k]
        if reals[x.reached + goal] == math.inf:
            return math.inf, 0
        if not ints[x.seen + goal]:
            ints[x.seen + goal] = 1
            key = -reals[x.reached + goal]
            heap_push(ints, reals, x.heap_keys, x.heap_ties, x.heap_items, size, key, goal, goal)
            size += 1

    while size:
        fact = ints[x.heap_items]
        heap_pop(ints, reals, x.heap_keys, x.heap_ties, x.heap_items, size)
        size -= 1
        i = ints[x.supporters + fact]
        if i < 0:
            if fact >= r.base:
                ints[x.paying + paid] = fact
                paid += 1
            continue
        if (
            reals[x.provided + fact] < math.inf
            and reals[x.provided + fact] <= reals[x.bounds + fact]
        ):
            continue

        owner = ints[r.owners + i]
        if owner >= 0:
            reals[x.chosen + owner] = max(reals[x.chosen + owner], reals[x.costs + i])
            for k in range(ints[r.effects_starts + i], ints[r.effects_starts + i + 1]):
                effect = ints[r.effects + k]
                reals[x.provided + effect] = min(
                    reals[x.provided + effect], reals[x.reached + fact]
                )
        bound = reals[x.reached + fact] - reals[x.costs + i]
        for k in range(ints[r.before_starts + i], ints[r.before_starts + i + 1]):
            other = ints[r.before + k]
            if other >= r.base and not ints[x.active + other - r.base]:
                continue
            reals[x.bounds + other] = min(reals[x.bounds + other], bound)
            if not ints[x.seen + other]:
                ints[x.seen + other] = 1
                key = -reals[x.reached + other]
                heap_push(
                    ints, reals, x.heap_keys, x.heap_ties, x.heap_items, size, key, other, other
                )
                size += 1

    total = to_pay(ints, reals, r, x, paid)
    price, count = gathered(ints, reals, t, x)
    return total + price, count


def to_pay(ints, reals, r, x, paid):
    """Sum the prices of the guards paid for; some are forgiven, which the relaxed plan removes."""
    for i in range(r.first_remover, r.operators if ints[FORGIVING] else 0):
        guard, need = ints[r.effects + ints[r.effects_starts + i]], r.before_starts + i
        if ints[x.seen + guard] and reals[x.provided + ints[r.before + ints[need]]] < math.inf:
            ints[x.supporters + guard] = i
    total = 0.0
    for k in range(paid):
        if ints[x.supporters + ints[x.paying + k]] < 0:
            total += reals[x.reached + ints[x.paying + k]]
    return total


def gathered(ints, reals, t, x):
    """Gather the chosen operators into x.plan; return what they cost, and how many they are."""
    price, count = 0.0, 0
    for i in range(t.operators):
        if reals[x.chosen + i] >= 0.0:
            price += reals[x.chosen + i]
            ints[x.plan + count] = i
            reals[x.chosen + i] = -1.0
            count += 1
    return price, count


def paid(ints, reals, r, x, operator):
    """Sum the prices of an operator's guards that the relaxed plan pays."""
    total = 0.0
    for k in range(ints[r.held_starts + operator], ints[r.held_starts + operator + 1]):
        if (
            ints[x.on + ints[r.held_guards + k]]
            and ints[x.supporters + r.base + ints[r.held_keys + k]] < 0
        ):
            total += reals[r.held_prices + k]
    return reals[x.raised + operator] + total


def landmarks(ints, reals, r, x, space, closed, node, parent):
    """Sum the costs of the landmarks that are still to come, or to come again, and note them."""
    words = r.mark_words
    for w in range(words):
        ints[x.now + w] = 0
        ints[x.remaining + w] = 0
    for k in range(r.marks):
        fact = ints[r.mark_facts + k]
        if has(ints, closed, fact) != ints[r.mark_absent + k]:
            ints[x.now + (k >> 6)] |= 1 << (k & 63)

    for w in range(words):
        before = ints[space.marks + parent * words + w] if parent >= 0 else 0
        ints[space.marks + node * words + w] = before | ints[x.now + w]
    for k in range(r.marks):
        missing = not has(ints, space.marks + node * words, k)
        if missing:
            ints[x.remaining + (k >> 6)] |= 1 << (k & 63)
            for n in range(ints[r.mark_starts + k], ints[r.mark_starts + k + 1]):
                other = ints[r.mark_needs + n]
                if not has(ints, x.now, other):
                    ints[x.remaining + (other >> 6)] |= 1 << (other & 63)
        elif ints[r.mark_goal + k] and not has(ints, x.now, k):
            ints[x.remaining + (k >> 6)] |= 1 << (k & 63)

    total = 0.0
    for k in range(r.marks):
        if has(ints, x.remaining, k):
            total += reals[r.mark_weights + k]
    return total
