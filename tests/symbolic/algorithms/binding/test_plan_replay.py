"""A bound plan is believed only as far as the streams really certified what it rests on."""

from __future__ import annotations

from dataclasses import replace

from tests.symbolic.algorithms.binding.shelf import planned


def test_what_was_drawn_and_tested_stands() -> None:
    run, skeleton = planned("(put tea)")
    values = run.binder.bind(skeleton, 4, 100)
    assert values is not None
    assert run.replay.fault(skeleton, values) is None


def test_another_value_than_the_one_tested_does_not() -> None:
    run, skeleton = planned("(put tea)", lambda cup, pose: pose == 2)
    values = run.binder.bind(skeleton, 4, 100)
    assert values is not None
    others = [name for name, value in run.task.objects.values.items() if value == 1]
    fault = run.replay.fault(skeleton, dict.fromkeys(values, others[0]))
    assert fault is not None and not fault.expected
    assert fault.reason == f"(clear tea {others[0]}) was not certified"


def test_an_action_that_is_missing_is_missed() -> None:
    run, skeleton = planned("(taken tea)")
    values = run.binder.bind(skeleton, 4, 100)
    assert values is not None
    first = run.replay.fault(replace(skeleton, actions=skeleton.actions[1:]), values)
    assert first is not None and "precondition does not hold" in first.reason and not first.expected
    last = run.replay.fault(replace(skeleton, actions=skeleton.actions[:1]), values)
    assert last is not None and "the goal does not hold in the end" in last.reason


def test_values_that_turn_out_the_same_are_nobodys_mistake() -> None:
    """Two variables with one value, or one with the value of an object that is there: nobody could know."""
    run, skeleton = planned("(and (put tea) (put mug))")
    values = run.binder.bind(skeleton, 4, 100)
    assert values is not None
    broken = replace(skeleton, actions=skeleton.actions[:1])
    fault = run.replay.fault(broken, values)
    assert fault is not None and not fault.expected
    named = replace(broken, certified=(*broken.certified, ("cup", (next(iter(values.values())),))))
    run.streams.certain.add(("cup", next(iter(values.values()))))
    fault = run.replay.fault(named, values)
    assert fault is not None and fault.expected
