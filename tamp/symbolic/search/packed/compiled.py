"""The loops of the packed search compiled by numba, kept on disk; and the arrays that they take.

Importing this takes half a second; the first use compiles, which takes some ten, where that has not
been done before. What is kept is named after the sources of all loops: numba itself looks at the
one that holds the function.
"""

# pyright: basic

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import FunctionType
from typing import Any

import numpy as np

from tamp.symbolic.search.packed import basics, estimates, loops, queues, states
from tamp.symbolic.search.packed.arrays import PackedTask, Relaxed, Scratch, Space
from tamp.symbolic.search.packed.selection import digest
from tamp.system.compilation import njit

SOURCES = (basics, estimates, states, queues, loops)

DIGEST = digest()

_names: dict[str, Any] = {name: value for module in SOURCES for name, value in vars(module).items()}
_INNER = {"nogil": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def _compile(function: Callable[..., Any], *, outer: bool = False) -> Callable[..., Any]:
    """Compile a copy that sees the compiled ones by their names; outer ones are kept on disk."""
    copy = FunctionType(function.__code__, _names, function.__name__)
    if outer:
        copy.__qualname__ = f"{function.__name__}_{DIGEST}"
    made = njit(cache=True, nogil=True, no_cfunc_wrapper=True) if outer else njit(**_INNER)
    _names[function.__name__] = result = made(copy)
    return result


for _module in SOURCES:
    for _name in list(vars(_module)):
        _function = getattr(_module, _name)
        if getattr(_function, "__module__", "") == _module.__name__ and callable(_function):
            _compile(_function)

RUN = _compile(loops.run, outer=True)
PUSH_GOAL = _compile(queues.push_goal, outer=True)
REHASH = _compile(states.rehash, outer=True)
ELIMINATE = _compile(states.eliminate, outer=True)


class Arena:
    """Two growing arrays, one of whole numbers, one of reals, and what lies where in them.

    Args:
        counters: Places at the beginning of the first array that are kept free.
        lowest: Likewise of the second.
    """

    def __init__(self, counters: int, lowest: int) -> None:
        self._parts: tuple[list[Any], list[Any]] = ([], [])
        self._sizes = [0, 0]
        self.room(0, counters)
        self.room(1, lowest)

    def integers(self, values: Sequence[int]) -> int:
        """Place whole numbers; return where they begin."""
        return self._place(0, np.array(values, dtype=np.int64))

    def reals(self, values: Sequence[float]) -> int:
        """Place reals; return where they begin."""
        return self._place(1, np.array(values, dtype=np.float64))

    def room(self, kind: int, size: int, value: float = 0) -> int:
        """Make room for so many whole numbers (0) or reals (1); return where it begins."""
        return self._place(kind, np.full(size, value, dtype=KINDS[kind]))

    def _place(self, kind: int, part: Any) -> int:
        self._parts[kind].append(part)
        self._sizes[kind] += len(part)
        return self._sizes[kind] - len(part)

    def scratch(self, t: PackedTask, r: Relaxed) -> Scratch:
        """Make room for what one expansion works with."""
        events, n, buckets = r.facts + r.effects_count + 1, t.operators, max(1, r.buckets)
        whole = {
            "closed": t.words, "after": t.words, "other": t.words, "rooms": 2 * t.words,
            "on": t.guards, "active": r.keys, "supporters": r.facts, "left": r.operators,
            "heads": buckets, "tails": buckets, "entry_next": events, "entry_fact": events,
            "heap_ties": events, "heap_items": events, "seen": r.facts, "paying": r.keys,
            "plan": n, "in_plan": n, "applicable": n, "is_applicable": n, "helpful": n,
            "is_helpful": n, "ranks": n,
            "now": r.mark_words, "remaining": r.mark_words, "found": n, "found_order": n,
            "found_class": n, "class_size": n, "class_at": n,
        }  # fmt: skip
        real = {
            "extras": n, "raised": n, "reached": r.facts, "totals": r.operators,
            "costs": r.operators, "heap_keys": events, "bounds": r.facts, "provided": r.facts,
            "chosen": n, "found_cost": n, "class_dearer": n, "class_paid": n, "class_step": n,
        }  # fmt: skip
        start = {"heads": -1, "chosen": -1.0}
        return Scratch(
            **{name: self.room(0, size, start.get(name, 0)) for name, size in whole.items()},
            **{name: self.room(1, size, start.get(name, 0)) for name, size in real.items()},
        )

    def begin(self, t: PackedTask, r: Relaxed, rooms: Rooms) -> tuple[Space, Any, Any]:
        """Join all that was placed, with room for what grows behind it: the arrays."""
        space, sizes = _laid_out(t, r, rooms, self._sizes)
        ints, reals = (np.empty(size, dtype=kind) for size, kind in zip(sizes, KINDS, strict=True))
        for array, parts, end in zip((ints, reals), self._parts, self._sizes, strict=True):
            np.concatenate(parts, out=array[:end])
            parts.clear()
        ints[space.table : space.table + space.mask + 1] = -1
        ints[space.evaluated : space.evaluated + space.nodes] = 0
        return space, ints, reals

    def grow(self, t: PackedTask, r: Relaxed, was: Space, arrays: list[Any], rooms: Rooms) -> Space:
        """Move to larger arrays, one after the other, so that but one of them is there twice.

        Args:
            t: The task.
            r: Its relaxation.
            was: What lies where in the arrays.
            arrays: Whole numbers and reals; replaced by the larger ones.
            rooms: The new sizes.
        """
        ints = arrays[0]
        made = tuple(int(ints[k]) for k in (basics.NODES, basics.GROUPS, basics.MEMBERS))
        lengths = [int(length) for length in ints[basics.SIZES : basics.SIZES + 2 * t.heuristics]]
        del ints
        space, sizes = _laid_out(t, r, rooms, self._sizes)
        for kind, names in enumerate(PARTS):
            array = np.empty(sizes[kind], dtype=KINDS[kind])
            array[: self._sizes[kind]] = arrays[kind][: self._sizes[kind]]
            for name in names:
                per, lists, pool = _extent(t, r, name)
                for k in range(lists):
                    size = lengths[k] if lists > 1 else made[pool] * per
                    at = getattr(space, name) + k * space[pool] * per
                    source = getattr(was, name) + k * was[pool] * per
                    array[at : at + size] = arrays[kind][source : source + size]
            arrays[kind] = array
        ints = arrays[0]
        ints[space.evaluated + made[0] : space.evaluated + space.nodes] = 0
        ints[space.table : space.table + space.mask + 1] = -1
        REHASH(ints, t.words, space.states, space.table, space.mask, made[0])
        return space


Rooms = tuple[int, int, int]
"""Room for states, for groups, and for members: the first fields of a `Space`."""

KINDS = (np.int64, np.float64)

PARTS = (
    ("states", "marks", "parent", "operator", "evaluated", "root", "detour",
     "group_parent", "group_next",
     "group_end", "group_base", "ties", "items", "members"),
    ("cost", "spent", "values", "keys", "member_cost"),
)  # fmt: skip
"""The growing parts of each array, but for the hash table."""


def _extent(t: PackedTask, r: Relaxed, name: str) -> tuple[int, int, int]:
    """Return the numbers for each of what a part is about, how many lists, and which room it is."""
    if name in ("ties", "items", "keys"):
        return 1, 2 * t.heuristics, 1
    if name.startswith("group"):
        return 1, 1, 1
    if name.startswith("member"):
        return 1, 1, 2
    return {"states": t.words, "marks": r.mark_words, "values": t.heuristics}.get(name, 1), 1, 0


def _laid_out(
    t: PackedTask, r: Relaxed, rooms: Rooms, ends: Sequence[int]
) -> tuple[Space, list[int]]:
    """Lay the growing parts out behind the others; return their places and the arrays' sizes."""
    table = 1
    while table < 2 * rooms[0] + 2:
        table *= 2
    places, ends = {"table": ends[0]}, [ends[0] + table, ends[1]]
    for kind, names in enumerate(PARTS):
        for name in names:
            per, lists, pool = _extent(t, r, name)
            places[name] = ends[kind]
            ends[kind] += per * lists * rooms[pool]
    nodes, groups, pool = rooms
    return Space(nodes=nodes, groups=groups, pool=pool, mask=table - 1, **places), ends
