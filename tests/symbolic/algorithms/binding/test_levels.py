"""What a jump back leaves as it was is not gone through again; what it resets begins anew."""

from __future__ import annotations

from dataclasses import replace
from random import Random
from typing import Any

import pytest

from tamp.symbolic.algorithms.binding.binder import Binder
from tamp.symbolic.algorithms.binding.levels import Level, Levels
from tests.symbolic.algorithms.binding.shelf import planned


def level(value: int) -> Level:
    return Level(iter([(str(value),)]), set())


def test_only_what_depends_on_a_new_value_waits() -> None:
    levels = Levels([[2], [], [3], [], []], frozenset())
    for index in range(5):
        assert levels.next() == index
        levels.enter(index, level(index))
        levels.take(index, (str(index),))
    assert levels.next() is None

    levels.jump(4, 0)
    levels.take(0, ("another",))
    assert levels.next() == 2
    levels.enter(2, level(2))
    levels.take(2, ("2",))  # the same again: 3 stands
    assert levels.next() == 4


def test_a_jump_resets_all_after_its_target() -> None:
    levels = Levels([[] for _ in range(4)], frozenset({2}))
    for index in range(4):
        levels.enter(index, level(index))
        levels.take(index, (str(index),))
    levels.jump(3, 1)
    assert levels.valid_level(0) and levels.valid_level(1)
    assert levels.valid_level(2) is None
    assert levels.next() == 2, "what shall be fresh is entered after each jump across it"


def reference_resets(jumps: list[int], entered: int, index: int) -> bool:
    return any(target < index for target in jumps[entered:])


@pytest.mark.parametrize("seed", range(20))
def test_resets_are_those_of_the_jumps_since(seed: int) -> None:
    rng, entered = Random(seed), [0] * 12
    jumps: list[int] = []
    levels = Levels([[] for _ in entered], frozenset())
    for index in range(len(entered)):
        levels.enter(index, level(index))
    for _ in range(60):
        failed = rng.randrange(1, len(entered))
        jumps.append(rng.randrange(failed))
        levels.jump(failed, jumps[-1])
        for index in rng.sample(range(len(entered)), 3):
            levels.enter(index, level(index))
            entered[index] = len(jumps)
        for index in range(len(entered)):
            assert (levels.valid_level(index) is None) == reference_resets(
                jumps, entered[index], index
            )


def test_levels_that_a_jump_crosses_are_not_entered_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first of thirty cups fits at its last pose only, which is asked after all the others have theirs."""
    names = " ".join(f"c{i:02}" for i in range(30))
    goal = f"(and {' '.join(f'(put {name})' for name in names.split())})"
    run, skeleton = planned(goal, lambda cup, pose: cup != "c00" or pose == 4, names)
    late = next(node for node in skeleton.nodes if node.stream.is_test and node.inputs[0] == "c00")
    skeleton = replace(
        skeleton, nodes=(*(node for node in skeleton.nodes if node is not late), late)
    )

    entered: list[int] = []
    enter = Binder._enter  # pyright: ignore[reportPrivateUsage]

    def counted(self: Binder, skeleton: Any, index: int, *more: Any) -> Level:
        entered.append(index)
        return enter(self, skeleton, index, *more)

    monkeypatch.setattr(Binder, "_enter", counted)
    values = run.binder.bind(skeleton, 4, 100)
    assert values is not None and run.replay.fault(skeleton, values) is None
    assert len(entered) == len(skeleton.nodes) + 3, (
        "three jumps back, each of which asks the test anew"
    )
