"""States over words: what `successors` does, and the ranking of preferred operators, for numba.

In Python that numba compiles, see `compiled`.
"""

# pyright: basic

from __future__ import annotations

import math

from tamp.symbolic.search.packed.basics import has, holds
from tamp.symbolic.search.packed.estimates import trigger


def close_state(ints, t, state):
    """Add the derived facts to a state, by stratum."""
    for s in range(t.strata):
        changed = True
        while changed:
            changed = False
            for a in range(ints[t.strata_starts + s], ints[t.strata_starts + s + 1]):
                if not ints[state + ints[t.ax_word + a]] & ints[t.ax_bit + a] and holds(
                    ints, t.ax_pre_starts, t.ax_pre_words, t.ax_pre_need, t.ax_pre_absent, a, state
                ):
                    ints[state + ints[t.ax_word + a]] |= ints[t.ax_bit + a]
                    changed = True
            if not ints[t.recursive + s]:
                break


def apply(ints, t, i, base, closed, after):
    """Apply an operator to the state at `base`; adding wins over deleting."""
    for w in range(t.words):
        ints[after + w] = ints[base + w]

    first, last = ints[t.con_starts + i], ints[t.con_starts + i + 1]
    for k in range(ints[t.eff_starts + i], ints[t.eff_starts + i + 1]):
        ints[after + ints[t.eff_words + k]] = (
            ints[after + ints[t.eff_words + k]] & ints[t.eff_keep + k] | ints[t.eff_add + k]
        )
    if first == last:
        return
    for c in range(first, last):
        if holds(
            ints, t.con_pre_starts, t.con_pre_words, t.con_pre_need, t.con_pre_absent, c, closed
        ):
            for k in range(ints[t.con_eff_starts + c], ints[t.con_eff_starts + c + 1]):
                ints[after + ints[t.con_eff_words + k]] &= ints[t.con_eff_keep + k]
    for c in range(first, last):
        if holds(
            ints, t.con_pre_starts, t.con_pre_words, t.con_pre_need, t.con_pre_absent, c, closed
        ):
            for k in range(ints[t.con_eff_starts + c], ints[t.con_eff_starts + c + 1]):
                ints[after + ints[t.con_eff_words + k]] |= ints[t.con_eff_add + k]
    for k in range(ints[t.eff_starts + i], ints[t.eff_starts + i + 1]):
        ints[after + ints[t.eff_words + k]] |= ints[t.eff_add + k]


def place_of(ints, words, state, states, table, mask):
    """Find a state's place in the hash table: its own, or the empty one where it would go."""
    h = 0
    for w in range(words):
        h = (h ^ ints[state + w]) * 0x2545F4914F6CDD1D
        h ^= (h >> 29) & 0x7FFFFFFFF

    place = h & mask
    while True:
        node = ints[table + place]
        if node < 0:
            return place
        same = True
        for w in range(words):
            if ints[states + node * words + w] != ints[state + w]:
                same = False
                break
        if same:
            return place
        place = (place + 1) & mask


def rehash(ints, words, states, table, mask, nodes):
    """Fill an empty hash table with the closed states."""
    for node in range(nodes):
        place = place_of(ints, words, states + node * words, states, table, mask)
        ints[table + place] = node


def applicable(ints, t, x, closed):
    """List the operators whose conditions hold into x.applicable; return how many."""
    count = 0
    for k in range(t.always_count):
        i = ints[t.always + k]
        if holds(ints, t.pre_starts, t.pre_words, t.pre_need, t.pre_absent, i, closed):
            ints[x.applicable + count] = i
            count += 1

    for w in range(t.words):
        word, fact = ints[closed + w] & ints[t.watch_mask + w], w << 6
        while word != 0:
            if word & 1:
                for k in range(ints[t.watch_starts + fact], ints[t.watch_starts + fact + 1]):
                    i = ints[t.watch + k]
                    if holds(ints, t.pre_starts, t.pre_words, t.pre_need, t.pre_absent, i, closed):
                        ints[x.applicable + count] = i
                        count += 1
            word = (word >> 1) & 0x7FFFFFFFFFFFFFFF
            fact += 1
    return count


def preferred(ints, t, x, space, node, closed, length):
    """Rank the applicable operators of the relaxed plan (`lazy.preferred`); return how many."""
    count = 0
    for a in range(length):
        i = ints[x.plan + a]
        if not ints[x.is_applicable + i]:
            continue
        apply(ints, t, i, space.states + node * t.words, closed, x.after)
        for w in range(t.words):
            ints[x.after + w] |= ints[closed + w] & ints[t.derived + w]

        lost, gained = 0, 0
        for b in range(length):
            j = ints[x.plan + b]
            if j == i or not ints[t.eff_touched + i] & ints[t.pre_touched + j]:
                continue  # what the one changes is nothing that the other asks for
            possible = holds(ints, t.pre_starts, t.pre_words, t.pre_need, t.pre_absent, j, x.after)
            if ints[x.is_applicable + j]:
                lost += not possible
            else:
                gained += possible

        rank = lost * (length + 1) + length - gained
        k = count
        while k > 0 and ints[x.ranks + k - 1] > rank:
            ints[x.ranks + k] = ints[x.ranks + k - 1]
            ints[x.helpful + k] = ints[x.helpful + k - 1]
            k -= 1
        ints[x.ranks + k] = rank
        ints[x.helpful + k] = i
        count += 1
    for k in range(count):
        ints[x.is_helpful + ints[x.helpful + k]] = 1
    return count


def achievers(ints, t, r, x, space, node, helpful, length):
    """Add to the preferred operators those that reach a landmark for the first time; return all."""
    for w in range(t.words):
        ints[x.other + w] = 0
    for k in range(r.marks):
        fact = ints[r.mark_facts + k]
        if not ints[r.mark_absent + k] and not has(ints, space.marks + node * r.mark_words, k):
            ints[x.other + (fact >> 6)] |= 1 << (fact & 63)

    for a in range(length):
        i = ints[x.applicable + a]
        for k in range(ints[t.eff_starts + i], ints[t.eff_starts + i + 1]):
            new = ints[t.eff_add + k] & ints[x.other + ints[t.eff_words + k]]
            if new != 0 and not ints[x.is_helpful + i]:
                ints[x.is_helpful + i] = 1
                ints[x.helpful + helpful] = i
                helpful += 1
    return helpful


def shuffle(ints, random, first, length):
    """Shuffle so many numbers by a xorshift generator (Marsaglia 2003); return its new state."""
    for k in range(length - 1, 0, -1):
        random ^= random << 13
        random ^= (random >> 7) & 0x1FFFFFFFFFFFFFF
        random ^= random << 17
        other = ((random >> 3) & 0xFFFFFFFFFFFFFFF) % (k + 1)
        kept = ints[first + k]
        ints[first + k] = ints[first + other]
        ints[first + other] = kept
    return random


def covers(ints, t, closed):
    """Check that the goal holds in a state with its derived facts."""
    for w in range(t.words):
        if (
            ints[closed + w] & ints[t.goal_need + w] != ints[t.goal_need + w]
            or ints[closed + w] & ints[t.goal_absent + w] != 0
        ):
            return False
    return True


def take(ints, reals, t, x, rooms, base, i):
    """Apply an operator to the state in `rooms` at `base` where it can be; return what it costs.

    Minus one where it cannot be applied.
    """
    for w in range(t.words):
        ints[x.closed + w] = ints[rooms + base + w]
    if ints[t.guarded + i]:
        trigger(ints, reals, t, x, x.closed)
    close_state(ints, t, x.closed)
    if not holds(ints, t.pre_starts, t.pre_words, t.pre_need, t.pre_absent, i, x.closed):
        return -1.0
    apply(ints, t, i, rooms + base, x.closed, x.after)
    for w in range(t.words):
        ints[rooms + base + w] = ints[x.after + w]
    return reals[t.costs + i] + reals[x.extras + i] if ints[t.guarded + i] else reals[t.costs + i]


def follow(ints, reals, t, x, rooms, plan, first, last, out):
    """Apply a plan's operators to the first state in `rooms`, without those that do not apply.

    Returns:
        Their cost, infinite without the goal; and the end of the list of those applied, which is
        written into the plan from `out` on, unless that is negative.
    """
    cost = 0.0
    for w in range(t.words):
        ints[rooms + t.words + w] = ints[rooms + w]
    for k in range(first, last):
        step = take(ints, reals, t, x, rooms, t.words, ints[plan + k])
        if step >= 0.0:
            cost += step
            if out >= 0:
                ints[plan + out] = ints[plan + k]
                out += 1
    for w in range(t.words):
        ints[x.closed + w] = ints[rooms + t.words + w]
    close_state(ints, t, x.closed)
    return (cost if covers(ints, t, x.closed) else math.inf), out


def eliminate(ints, reals, t, x, rooms, plan, kept, length):
    """Do what `plan_shortening.eliminate_actions` does; return how many are kept, and their cost.

    Args:
        t: The task.
        x: Scratch.
        rooms: Room for two states; the first is the initial one.
        plan: The operators; used up.
        kept: Room for those that remain.
        length: Of the plan.
    """
    first, last, count, total = 0, length, 0, 0.0
    left = follow(ints, reals, t, x, rooms, plan, first, last, -1)[0]
    while first < last:
        reduced = follow(ints, reals, t, x, rooms, plan, first + 1, last, -1)[0]
        if reduced < math.inf and reduced <= left + 1e-9:
            left, last = follow(ints, reals, t, x, rooms, plan, first + 1, last, first)
            continue
        ints[kept + count] = ints[plan + first]
        count += 1
        step = take(ints, reals, t, x, rooms, 0, ints[plan + first])
        total, left = total + step, left - step
        first += 1
    return count, total
