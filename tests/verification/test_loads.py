"""What rides on a body in the hand: felt, told alike by plan and facts, carried level, where the facts have it."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from tamp.geometric.scene.pose import Array, Pose
from tamp.plan.read import Hold, Value
from tamp.verification.execution_state import ExecutionState, Held
from tamp.verification.loads import LOADED_TILT_RAD, Loads
from tamp.verification.semantics import State
from tamp.verification.violation_log import ViolationLog

UP = Pose((0.0, 0.0, 0.1)).matrix
"""The cup stands 10 cm above the tray's origin."""


class World:
    """Bodies where they are put: a tray, a cup and a spoon."""

    def __init__(self, at: dict[str, Array]) -> None:
        self._at = at
        self.scene = SimpleNamespace(bodies=dict.fromkeys(at))

    def pose(self, name: str) -> Array:
        return self._at[name]


def tray(x: float = 1.0, tilt: float = 0.0) -> Array:
    c, s = math.cos(tilt), math.sin(tilt)
    T = np.eye(4)
    T[:3, :3] = [[c, 0, s], [0, 1, 0], [-s, 0, c]]
    T[0, 3] = x
    return T


RIDING = ("riding", "cup", "cup_p", "tray", "tray_p")
VALUES = {"tray_p": Value("pose", tray()), "cup_p": Value("pose", tray() @ UP)}


def loads(
    at: dict[str, Array] | None = None,
    on: dict[str, set[str]] | None = None,
    values: dict[str, Value] = VALUES,
    arity: int = 4,
) -> tuple[Loads, ViolationLog]:
    """`on` says what each body is felt to rest on."""
    world = World(at or {"Tray": tray(), "cup": tray() @ UP, "spoon": np.eye(4)})
    felt = {"cup": {"Tray"}, **(on or {})}
    supports = SimpleNamespace(stand=lambda name, _: SimpleNamespace(on=felt.get(name, set())))
    predicate = SimpleNamespace(parameters=(None,) * arity)
    domain = SimpleNamespace(predicates={"riding": predicate})
    log = ViolationLog()
    made = Loads(
        SimpleNamespace(values=values), world, SimpleNamespace(domain=domain), supports, log  # type: ignore[arg-type]
    )  # fmt: skip
    return made, log


TOOL = np.linalg.inv(Pose((0.0, 0.0, -0.3)).matrix) @ tray()


def hold(*load: tuple[str, Array]) -> Hold:
    return Hold("tray", np.linalg.inv(TOOL) @ tray(), 0.03, load)


def state(*facts: tuple[str, ...]) -> State:
    return State.of(facts)


def kinds(log: ViolationLog) -> list[tuple[str, tuple[str, ...]]]:
    return [(one.kind, one.bodies) for one in log.violations]


def test_what_rides_by_the_facts_and_is_felt_goes_along() -> None:
    made, log = loads()
    (held,) = made.on(hold(("cup", UP)), "Tray", TOOL, state(RIDING))
    assert held.body == "cup" and np.allclose(TOOL @ held.T_tool_body, tray() @ UP)
    assert log.violations == []


def test_plan_and_facts_must_say_the_same() -> None:
    made, log = loads()
    assert made.on(hold(), "Tray", TOOL, state(RIDING))
    assert (
        "the plan says that nothing goes with Tray, by the facts cup rides"
        in log.violations[0].message
    )
    made, log = loads()
    assert made.on(hold(("cup", UP)), "Tray", TOOL, state()) == ()
    assert kinds(log) == [("grasp", ("Tray", "cup"))]


@pytest.mark.parametrize("on", [set(), {"spoon"}, {"Tray", "spoon"}])
def test_what_is_not_felt_to_rest_on_it_alone_is_left_behind(on: set[str]) -> None:
    made, log = loads(on={"cup": on})
    assert made.on(hold(("cup", UP)), "Tray", TOOL, state(RIDING)) == ()
    assert "cup does not ride on Tray" in log.violations[0].message
    assert len(log.violations) == 2  # the plan says that it goes along


def test_riders_of_other_bodies_stay() -> None:
    made, log = loads()
    other = ("riding", "spoon", "s", "cup", "cup_p")
    assert [one.body for one in made.on(hold(("cup", UP)), "Tray", TOOL, state(RIDING, other))] == [
        "cup"
    ]
    assert log.violations == []


@pytest.mark.parametrize(("off", "wrong"), [(0.0002, False), (0.02, True)])
def test_a_rider_must_be_where_the_plan_has_it(off: float, wrong: bool) -> None:
    made, log = loads()
    shifted = UP @ Pose((off, 0.0, 0.0)).matrix
    made.on(hold(("cup", shifted)), "Tray", TOOL, state(RIDING))
    assert bool(log.violations) is wrong
    if wrong:
        assert log.violations[0].depth == pytest.approx(off)
        assert (
            "cup is 20.0 mm, 0.0 deg from where the plan has it on Tray"
            in log.violations[0].message
        )


def test_a_domain_whose_riding_means_something_else_has_no_loads() -> None:
    made, log = loads(arity=3)
    assert made.on(hold(), "Tray", TOOL, state(RIDING)) == ()
    made.compare(state(RIDING), SimpleNamespace(held=(), in_hand=frozenset()))  # type: ignore[arg-type]
    assert log.violations == []


def lean(log: ViolationLog, made: Loads, *tilts: float, load: bool = True) -> list[str]:
    held = Held("Tray", np.linalg.inv(TOOL) @ tray(), (Held("cup", np.eye(4)),) if load else ())
    sweeper = SimpleNamespace(
        tool=lambda row, arm: tray(tilt=float(row[0])) @ np.linalg.inv(tray()) @ TOOL
    )
    made.check_level(held, np.array([[tilt] for tilt in tilts]), sweeper)  # type: ignore[arg-type]
    return [one.message for one in log.violations]


def test_a_loaded_body_stays_level_on_the_way() -> None:
    made, log = loads()
    made.on(hold(("cup", UP)), "Tray", TOOL, state(RIDING))
    assert lean(log, made, 0.0, LOADED_TILT_RAD - 0.01) == []
    assert lean(log, made, 0.0, 0.5, LOADED_TILT_RAD + 0.01) == [
        f"Tray leans by {math.degrees(0.5):.1f} deg with cup on it"
    ]


def test_nothing_on_it_may_be_turned_over() -> None:
    made, log = loads()
    assert lean(log, made, 2.0, load=False) == []


def compared(at: dict[str, Array], *held: Held) -> list[str]:
    made, log = loads(at)
    course = ExecutionState(np.zeros(11), dict(enumerate(held)), 0.0)
    made.compare(state(RIDING), course)
    return [one.message for one in log.violations]


def test_a_rider_is_where_the_body_below_has_got_to() -> None:
    moved = {"Tray": tray(2.0), "cup": tray(2.0) @ UP}
    assert compared(moved) == []
    assert compared({"Tray": tray(2.0), "cup": tray() @ UP}) == [
        "cup is 1000.0 mm, 0.0 deg from where it rides on Tray"
    ]


def test_what_rides_on_the_body_in_the_hand_is_in_the_hand_too() -> None:
    at = {"Tray": tray(), "cup": tray() @ UP}
    assert compared(at, Held("Tray", TOOL, (Held("cup", TOOL),))) == []
    assert compared(at, Held("Tray", TOOL)) == ["cup does not ride on Tray"]
    assert compared(at, Held("spoon", TOOL)) == []


def test_riding_is_of_bodies_and_poses() -> None:
    made, log = loads(values={**VALUES, "cup_p": Value("grasp", None)})
    made.compare(state(RIDING), SimpleNamespace(held=(), in_hand=frozenset()))  # type: ignore[arg-type]
    assert log.violations[0].message == "(riding cup cup_p tray tray_p) is not of bodies and poses"
