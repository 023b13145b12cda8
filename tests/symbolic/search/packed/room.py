"""Small tasks written by hand, packed: the arrays that the loops of the packed search work on."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.heuristics.landmarks import Landmarks
from tamp.symbolic.search.heuristics.relaxation import Relaxation
from tamp.symbolic.search.operators import (
    Axiom,
    ConditionalEffect,
    Goal,
    Guard,
    InstantiatedTask,
    Operator,
)
from tamp.symbolic.search.packed import basics
from tamp.symbolic.search.packed.arrays import PackedTask, Relaxed, Scratch, Space
from tamp.symbolic.search.packed.compiled import Arena
from tamp.symbolic.search.packed.packing import pack_relaxation, pack_task, words_of
from tamp.symbolic.search.packed.search import KINDS
from tamp.symbolic.search.successors import State, Successors


def facts(text: str) -> frozenset[Fact]:
    """Facts without arguments: "a b"."""
    return frozenset((name,) for name in text.split())


def operator(
    name: str,
    before: str = "",
    after: str = "",
    *,
    absent: str = "",
    deleted: str = "",
    cost: float = 1.0,
    guards: Sequence[Guard] = (),
    when: Sequence[tuple[str, str, str, str]] = (),
    static: str = "",
) -> Operator:
    """An operator; `when` are conditional effects: needed, absent, added, deleted."""
    conditional = tuple(ConditionalEffect(*map(facts, one)) for one in when)
    return Operator(
        name, (), facts(before), facts(absent), facts(after), facts(deleted), cost, facts(static),
        guards, conditional,
    )  # fmt: skip


def axiom(head: str, needed: str = "", absent: str = "", stratum: int = 0) -> Axiom:
    return Axiom((head,), facts(needed), facts(absent), stratum=stratum)


def task(
    operators: Sequence[Operator],
    goal: str = "g",
    initial: str = "",
    axioms: Sequence[Axiom] = (),
    goal_absent: str = "",
) -> InstantiatedTask:
    reachable = facts(initial).union(
        *(one.added for one in operators), *(c.added for one in operators for c in one.conditional),
        (one.head for one in axioms),
    )  # fmt: skip
    wanted = Goal(facts(goal), facts(goal_absent))
    return InstantiatedTask(
        facts(initial), wanted, tuple(operators), tuple(axioms), reachable, dict[str, Any]()
    )


class Packed(NamedTuple):
    """A packed task: `ints` and `reals` are the two arrays, the others say what lies where."""

    s: Successors
    relaxation: Relaxation
    ints: Any
    reals: Any
    t: PackedTask
    r: Relaxed
    x: Scratch
    space: Space
    arena: Arena

    def write(self, at: int, state: State | Iterable[Fact]) -> State:
        """Write a state into the array; return its bits."""
        bits = state if isinstance(state, int) else self.s.mask(state)
        self.ints[at : at + self.t.words] = words_of(bits, self.t.words)
        return bits

    def read(self, at: int) -> State:
        words = self.ints[at : at + self.t.words].tolist()
        return sum((word & (1 << 64) - 1) << 64 * w for w, word in enumerate(words))

    def named(self, state: State) -> str:
        """A state's facts, sorted: "a b"."""
        return " ".join(fact[0] for i, fact in enumerate(self.s.facts) if state >> i & 1)


def packed(
    task: InstantiatedTask,
    price: Mapping[Fact, float] | None = None,
    names: Sequence[str] = ("ff",),
    rooms: tuple[int, int, int] = (40, 200, 200),
) -> Packed:
    s, kinds = Successors(task, price or {}), len(names)
    assert s.lists_guards
    arena = Arena(basics.SIZES + 4 * kinds, kinds)
    t = pack_task(s, [KINDS[name] for name in names], arena.integers, arena.reals)
    relaxation = Relaxation(s, steps=True)
    marks = Landmarks(s) if "landmarks" in names else None
    r = pack_relaxation(s, relaxation, marks, arena.integers, arena.reals)
    x = arena.scratch(t, r)
    space, ints, reals = arena.begin(t, r, rooms)
    ints[: basics.SIZES + 4 * kinds] = 0
    reals[:kinds] = 0.0
    return Packed(s, relaxation, ints, reals, t, r, x, space, arena)
