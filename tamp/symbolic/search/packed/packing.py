"""From a numbered task, its relaxation and its landmarks to the arrays of the compiled search."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import cache, partial
from itertools import accumulate, chain
from typing import Any

from tamp.symbolic.search.heuristics.landmarks import Landmarks
from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.packed.arrays import PackedTask, Relaxed
from tamp.symbolic.search.successors import State, Successors, bits

WORD = 64
MOST_BUCKETS = 4096
"""Costs in whole numbers below this have a bucket of their own."""

Place = Callable[[Sequence[Any]], int]
"""Puts numbers into an array; returns where they begin."""


class CsrLists:
    """Compressed sparse rows (CSR) of several columns, as lists."""

    def __init__(self, rows: Iterable[Sequence[Sequence[Any]]], columns: int) -> None:
        lengths: list[int] = []
        self.columns: tuple[list[Any], ...] = tuple([] for _ in range(columns))
        for row in rows:
            lengths.append(len(row))
            for column, entries in zip(self.columns, zip(*row, strict=True), strict=False):
                column.extend(entries)
        self.starts = list(accumulate(lengths, initial=0))


def signed(word: int) -> int:
    """Return 64 bits as a number with a sign."""
    return word - (1 << WORD) if word >> (WORD - 1) else word


def words_of(state: State, words: int) -> list[int]:
    """Return a state's words, each as a number with a sign."""
    full = (1 << WORD) - 1
    return [signed(state >> WORD * w & full) for w in range(words)]


def pairs_of(one: State, other: State) -> list[tuple[int, int, int]]:
    """Return the words where one of two sets has bits: number, and the bits of both."""
    both, full = one | other, (1 << WORD) - 1
    found: list[tuple[int, int, int]] = []
    while both:
        w = ((both & -both).bit_length() - 1) // WORD
        shift = WORD * w
        found.append((w, signed(one >> shift & full), signed(other >> shift & full)))
        both = both >> shift + WORD << shift + WORD
    return found


def touched(state: State) -> int:
    """Return the words that a set of facts touches, as bits; words 62 apart share one."""
    found = 0
    while state:
        w = ((state & -state).bit_length() - 1) // WORD
        found |= 1 << w % 62
        state = state >> WORD * (w + 1) << WORD * (w + 1)
    return found


def effects_of(kept: State, added: State, every: State) -> list[tuple[int, int, int]]:
    """Return the words that effects change: number, bits that are kept, bits that are added."""
    deleted = every & ~kept
    return [(w, ~gone, more) for w, gone, more in pairs_of(deleted, added)]


def pack_task(s: Successors, kinds: list[int], ints: Place, reals: Place) -> PackedTask:
    """Pack a task whose guards are all at hand; `kinds`: its heuristics, see `PackedTask.kinds`.

    Args:
        s: The task.
        kinds: Its heuristics, 0 for ff and 1 for landmarks.
        ints: Places whole numbers.
        reals: Places reals.
    """
    size = len(s.facts)
    words, every = (size + WORD - 1) // WORD or 1, (1 << size) - 1
    conditions, changes = cache(pairs_of), cache(partial(effects_of, every=every))
    pre = CsrLists((conditions(b, a) for b, a in zip(s.before, s.absent, strict=True)), 3)
    eff = CsrLists((changes(k, a) for k, a in zip(s.kept, s.added, strict=True)), 3)
    effects = list(chain.from_iterable(s.conditional))
    con_pre = CsrLists((conditions(one[0], one[1]) for one in effects), 3)
    con_eff = CsrLists((changes(~one[3], one[2]) for one in effects), 3)
    whole = [every & ~k | a for k, a in zip(s.kept, s.added, strict=True)]
    for i, more in enumerate(s.conditional):
        for one in more:
            whole[i] |= one[2] | one[3]
    both = cache(touched)
    watch = CsrLists(([(i,) for i in s.watched.get(fact, ())] for fact in range(size)), 1)

    bodies: list[list[tuple[int, int, int]]] = []
    heads: list[int] = []
    strata, recursive = [0], list[int]()
    for stratum in s.strata:
        for (positive, negative), head in stratum.axioms():
            bodies.append(conditions(positive, negative))
            heads.append(head.bit_length() - 1)
        strata.append(len(heads))
        recursive.append(int(stratum.recursive))
    body = CsrLists(bodies, 3)

    guards = s.guard_sets()
    guard_facts = CsrLists(([(fact,) for fact in bits(facts)] for facts in guards), 1)
    fines = CsrLists((list(s.penalties(facts).items()) for facts in guards), 2)
    return PackedTask._make((
        words, len(s.operators), len(kinds), len(s.always), len(recursive), len(guards),
        ints(kinds), *map(ints, (pre.starts, *pre.columns)),
        *map(ints, (eff.starts, *eff.columns)),
        ints(list(accumulate(map(len, s.conditional), initial=0))),
        *map(ints, (con_pre.starts, *con_pre.columns, con_eff.starts, *con_eff.columns)),
        ints([both(b | a) for b, a in zip(s.before, s.absent, strict=True)]),
        ints(list(map(both, whole))),
        *map(ints, (watch.starts, *watch.columns, words_of(s.watch_mask, words), s.always)),
        *map(ints, (strata, recursive, body.starts, *body.columns)),
        ints([head // WORD for head in heads]), ints([signed(1 << head % WORD) for head in heads]),
        *(ints(words_of(m, words)) for m in (s.goal, s.goal_absent, s.derived_mask, s.initial)),
        reals(s.cost), reals([operator.cost for operator in s.operators]),
        ints([int(bool(operator.guards)) for operator in s.operators]),
        *map(ints, (guard_facts.starts, *guard_facts.columns, fines.starts, fines.columns[0])),
        reals(fines.columns[1]),
    ))  # fmt: skip


class Keys:
    """The conditions for whose removal relaxed operators wait: sets of facts with a price."""

    def __init__(self, s: Successors, relaxation: Relaxation) -> None:
        self.members: dict[tuple[State, float], list[int]] = {
            (1 << fact, math.inf): list(relaxation.negative[fact])
            for fact in sorted(relaxation.negative)
        }
        self.rises: list[list[tuple[int, float]]] = []
        self.held: dict[int, list[tuple[int, tuple[State, float]]]] = {}
        for number, facts in enumerate(s.guard_sets()):
            removal = min(relaxation.removal[fact] for fact in bits(facts))
            self.rises.append([])
            for operator, price in s.penalties(facts).items():
                if price <= removal and price < math.inf:
                    self.rises[-1].append((operator, price))
                    continue
                self.held.setdefault(operator, []).append((number, (facts, price)))
                for i in relaxation.of_operator[operator]:
                    self.members.setdefault((facts, price), []).append(i)
        self.number = {key: number for number, key in enumerate(self.members)}

    def held_by(self, operator: int) -> list[tuple[int, int, float]]:
        """Return the guards that hold an operator back, with their keys' numbers and prices; not
        those that no relaxed operator waits for.
        """
        held = self.held.get(operator, ())
        return [(g, self.number[key], key[1]) for g, key in held if key in self.number]


def pack_relaxation(
    s: Successors,
    relaxation: Relaxation,
    marks: Landmarks | None,
    ints: Place,
    reals: Place,
) -> Relaxed:
    """Pack the relaxed task, with all that its states' guards may add to it, and the landmarks."""
    size, keys = len(s.facts), Keys(s, relaxation)
    base, first = 2 * size, len(relaxation.before)
    before, effects = list(map(list, relaxation.before)), list(map(list, relaxation.effects))
    removers: list[int] = []
    for number, ((facts, _), members) in enumerate(keys.members.items()):
        for i in members:
            before[i].append(base + number)
        for fact in bits(facts):
            removers.append(number)
            before.append([size + fact])
            effects.append([base + number])

    needs: list[list[int]] = [[] for _ in range(base + len(keys.members))]
    for i, facts in enumerate(before):
        for fact in facts:
            if fact < base:
                needs[fact].append(i)
    for number, members in enumerate(keys.members.values()):
        needs[base + number] = list(members)

    held = CsrLists((keys.held_by(operator) for operator in range(len(s.operators))), 3)
    rises = CsrLists(keys.rises, 2)
    before_rows, effect_rows, need_rows, groups, members, facts = (
        CsrLists(([(fact,) for fact in row] for row in rows), 1)
        for rows in (
            before, effects, needs, relaxation.of_operator, keys.members.values(),
            [list(bits(mask)) for mask, _ in keys.members],
        )
    )  # fmt: skip
    waits = [*map(len, relaxation.before), *[1] * len(removers)]
    costs = [*relaxation.costs, *[0.0] * len(removers)]
    prices = [price for _, price in keys.members]
    finite = [p for p in (*costs, *prices, *rises.columns[1]) if p < math.inf]
    found = 0 if marks is None else len(marks.landmarks)
    whole = all(cost == int(cost) for cost in finite)
    return Relaxed._make((
        base + len(prices), base, len(before), first, len(effect_rows.columns[0]),
        waits.count(0), len(relaxation.goals), len(relaxation.negative_goals),
        len(rises.columns[0]), len(prices), found, (found + WORD - 1) // WORD,
        MOST_BUCKETS if whole else 0,
        *map(ints, (before_rows.starts, *before_rows.columns)),
        *map(ints, (effect_rows.starts, *effect_rows.columns)),
        *map(ints, (need_rows.starts, *need_rows.columns, waits)),
        ints([i for i, count in enumerate(waits) if not count]), reals(costs),
        ints([*relaxation.owner_list, *[-1] * len(removers)]),
        *map(ints, (groups.starts, *groups.columns, relaxation.goals, relaxation.negative_goals)),
        *map(ints, (facts.starts, *facts.columns)), reals(prices),
        *map(ints, (members.starts, *members.columns, removers, rises.starts, rises.columns[0])),
        reals(rises.columns[1]), *map(ints, (held.starts, held.columns[0], held.columns[1])),
        reals(held.columns[2]), *pack_landmarks(marks, size, ints, reals),
    ))  # fmt: skip


def pack_landmarks(
    marks: Landmarks | None, size: int, ints: Place, reals: Place
) -> tuple[int, ...]:
    """Pack the landmarks, numbered in the order of their facts; none without them."""
    facts = [] if marks is None else marks.landmarks
    number = {fact: k for k, fact in enumerate(facts)}
    goals = 0 if marks is None else marks.goals
    weights = [] if marks is None else [marks.weights[fact] for fact in facts]
    needs = {} if marks is None else marks.needs
    rows = CsrLists(([(number[n],) for n in bits(needs.get(fact, 0))] for fact in facts), 1)
    return (
        ints([fact % size for fact in facts]),
        ints([int(fact >= size) for fact in facts]),
        ints([goals >> fact & 1 for fact in facts]),
        reals(weights),
        *map(ints, (rows.starts, *rows.columns)),
    )
