"""What of an SRDF is taken: the first named configuration that an arm may drive in, pairs that need no check."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import pytest

from tamp.commands.robot_folder import self_collision, srdf_proposals
from tamp.commands.robot_folder.arm import Arm, find_arm
from tamp.commands.robot_folder.description import Description, read_description
from tamp.commands.robot_folder.srdf import Disabled, GroupState, Srdf
from tamp.commands.robot_folder.srdf_proposals import SAID, disabled_that_meet, home_of
from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot.robot import LIMIT_MARGIN_RAD, Robot
from tests.commands.robot_folder.urdf import write_arm

ROBOT = ROBOTS["ur5"]()
NAMES = [joint.name for joint in ROBOT.joints]
LENGTH = 0.9
HOME = ROBOT.home
"""The shipped one: free of collision, compact, the hand high enough."""


def state(name: str, values: tuple[float, ...] | dict[str, float], line: int = 3) -> GroupState:
    named = values if isinstance(values, dict) else dict(zip(NAMES, values, strict=True))
    return GroupState(name, line, named)


def srdf(*states: GroupState, disabled: tuple[Disabled, ...] = (), **more: object) -> Srdf:
    empty = MappingProxyType({})
    made = Srdf(Path("r.srdf"), empty, (), states, disabled, empty, frozenset(), ())
    return replace(made, **more)  # type: ignore[arg-type]


def turned(index: int, by: float) -> tuple[float, ...]:
    return tuple(q + (by if i == index else 0.0) for i, q in enumerate(HOME))


def test_a_home_that_fits_is_taken_and_said() -> None:
    q, said = home_of(srdf(state("home", HOME, 7)), ROBOT, LENGTH)
    assert q == pytest.approx(HOME)
    assert said == ["home is r.srdf:7's state 'home'"]


def test_without_a_state_of_such_a_name_there_is_none() -> None:
    assert home_of(srdf(state("folded", HOME)), ROBOT, LENGTH) == (None, [])
    assert home_of(srdf(), ROBOT, LENGTH) == (None, [])
    other = state("home", {"head_pan": 0.0})
    assert home_of(srdf(other), ROBOT, LENGTH) == (None, [])


def test_the_names_are_asked_in_their_order_whatever_the_files() -> None:
    """home before ready before half_sitting, in capitals or not."""
    first, second = turned(0, 0.3), turned(0, 0.6)
    for names, index in (
        (("ready", "home"), 1),
        (("HALF_SITTING", "Ready"), 1),
        (("home", "ready"), 0),
    ):
        states = [state(name, q) for name, q in zip(names, (first, second), strict=True)]
        assert home_of(srdf(*states), ROBOT, LENGTH)[0] == pytest.approx((first, second)[index])


def test_groups_of_the_same_name_are_put_together_and_what_lacks_is_said() -> None:
    """Two groups of the body each give some of the joints; other joints are nobody's business."""
    half = dict(zip(NAMES[:3], HOME[:3], strict=True)) | {"head_pan": 1.0}
    rest = dict(zip(NAMES[3:], HOME[3:], strict=True))
    assert home_of(srdf(state("home", half), state("home", rest)), ROBOT, LENGTH)[
        0
    ] == pytest.approx(HOME)
    q, said = home_of(srdf(state("home", half, 5)), ROBOT, LENGTH)
    assert q is None
    assert said == [
        f"r.srdf:5's state 'home' is not taken for home: it leaves out {', '.join(NAMES[3:])}"
    ]


def test_values_at_the_makers_limits_are_put_on_those_of_plans() -> None:
    """Plans keep a margin; what is farther beyond is no configuration of the arm."""
    most = ROBOT.upper[5] + LIMIT_MARGIN_RAD
    at_limit = (*HOME[:5], most)
    q, _ = home_of(srdf(state("home", at_limit)), ROBOT, LENGTH)
    assert q is not None
    assert q[5] == ROBOT.upper[5]
    beyond = (*HOME[:5], most + 2 * LIMIT_MARGIN_RAD)
    q, said = home_of(srdf(state("home", beyond), state("ready", HOME)), ROBOT, LENGTH)
    assert q == pytest.approx(HOME)
    assert "is not within" in said[0] and NAMES[5] in said[0]
    assert said[1].startswith("home is")


def only_complaint(q: tuple[float, ...], length: float = LENGTH) -> str:
    found, said = home_of(srdf(state("home", q)), ROBOT, length)
    assert found is None
    (one,) = said
    return one


def test_an_arm_that_is_stretched_out_meets_itself_or_hangs_low_may_not_drive() -> None:
    """The elbow straight and the shoulder a little raised: the hand is 0.8 m in front."""
    level = (HOME[0], -0.3, 0.0, -1.2, HOME[4], HOME[5])
    assert "stretched out by" in only_complaint(level)
    low = (HOME[0], 0.0, 0.0, *HOME[3:])
    assert "m high there" in only_complaint(low)
    folded = (HOME[0], -1.5, 3.05, 0.0, 0.0, 0.0)
    assert "meet there" in only_complaint(folded)
    down = (HOME[0], 1.2, 0.3, HOME[3], HOME[4], HOME[5])
    said = only_complaint(down, length=9.0)
    assert "m high there" in said or "below the floor" in said or "meet there" in said


def test_how_far_is_stretched_goes_with_the_length() -> None:
    level = (HOME[0], -0.3, 0.0, -1.2, HOME[4], HOME[5])
    away = float(only_complaint(level, 0.1).split("stretched out by ")[1].split(" m")[0])
    share = srdf_proposals.STRETCHED
    assert home_of(srdf(state("home", level)), ROBOT, (away + 0.01) / share)[0] is not None
    assert "stretched out" in only_complaint(level, (away - 0.01) / share)


@pytest.fixture(scope="module")
def arm_of_boxes(tmp_path_factory: pytest.TempPathFactory) -> tuple[Description, Arm, Robot]:
    """Its description, and a robot of the same names; `met` says what met."""
    file = write_arm(tmp_path_factory.mktemp("arm"))
    description = read_description(file)
    arm = find_arm(description, "foot", "tool", {})
    return (
        description,
        arm,
        replace(ROBOT, fingers=(), allowed=frozenset({("elbow_link", "pan_link")})),
    )


def told(
    made: tuple[Description, Arm, Robot], met: dict[tuple[str, str], int], *disabled: Disabled,
    unchecked: dict[str, int] | None = None, enabled: frozenset[tuple[str, str]] = frozenset(),
) -> list[str]:  # fmt: skip
    description, arm, robot = made
    given = srdf(disabled=disabled, unchecked=unchecked or {}, enabled=enabled)
    return disabled_that_meet(given, description, arm, robot, met)


PAIR = ("foot", "wrist1_link")


def test_a_disabled_pair_that_met_is_told_with_its_share(
    arm_of_boxes: tuple[Description, Arm, Robot],
) -> None:
    entry = Disabled(*PAIR, "Never", 9)
    (text,) = told(arm_of_boxes, {PAIR: self_collision.STATES // 50}, entry)
    assert text == (
        "r.srdf:9 disables foot and wrist1_link (Never), which meet in 2 % of states: they are checked"
    )
    assert "(" not in told(arm_of_boxes, {PAIR: 40}, replace(entry, reason=""))[0]


def test_what_never_met_is_allowed_anyway_or_is_not_disabled_is_not_told(
    arm_of_boxes: tuple[Description, Arm, Robot],
) -> None:
    entry, allowed = Disabled(*PAIR, "Never", 9), ("elbow_link", "pan_link")
    assert told(arm_of_boxes, {PAIR: 0}, entry) == []
    assert told(arm_of_boxes, {allowed: 50}, Disabled(*allowed, "Adjacent", 9)) == []
    assert told(arm_of_boxes, {PAIR: 50, ("foot", "wrist2_link"): 50}, entry)[1:] == []


def test_links_that_are_not_checked_by_default_count_but_for_enabled_pairs(
    arm_of_boxes: tuple[Description, Arm, Robot],
) -> None:
    (text,) = told(arm_of_boxes, {PAIR: 50}, unchecked={"wrist1_link": 4})
    assert text.startswith("r.srdf:4 disables foot and wrist1_link (default)")
    assert (
        told(arm_of_boxes, {PAIR: 50}, unchecked={"wrist1_link": 4}, enabled=frozenset({PAIR}))
        == []
    )


def test_the_most_frequent_come_first_and_the_rest_is_counted(
    arm_of_boxes: tuple[Description, Arm, Robot],
) -> None:
    names = ["elbow_link", "foot", "lift_link", "wrist1_link", "wrist2_link", "wrist3_link"]
    pairs = [(a, b) for i, a in enumerate(names) for b in names[i + 1 :]]
    met = {pair: 10 * number + 10 for number, pair in enumerate(pairs)}
    found = told(arm_of_boxes, met, *(Disabled(*pair, "Never", 1) for pair in pairs))
    assert len(pairs) > SAID and len(found) == SAID + 1
    assert f"{pairs[-1][0]} and {pairs[-1][1]} " in found[0]
    assert f"{pairs[len(pairs) - SAID][0]} and {pairs[len(pairs) - SAID][1]} " in found[SAID - 1]
    assert found[-1].startswith(f"and {len(pairs) - SAID} pairs more")


def test_a_link_of_several_parts_is_disabled_only_where_all_are(tmp_path: Path) -> None:
    """A second link bolted to the wrist is one with it: the entry names only one of the two."""
    shape = '<collision><geometry><box size="0.02 0.02 0.02"/></geometry></collision>'
    extra = (
        f'<link name="lamp">{shape}</link><joint name="bolt" type="fixed">'
        '<parent link="wrist1_link"/><child link="lamp"/></joint>'
    )
    description = read_description(write_arm(tmp_path, extra=extra))
    arm = find_arm(description, "foot", "tool", {})
    group = next(one for one in arm.groups if "lamp" in one.links)
    made = description, arm, replace(ROBOT, fingers=(), allowed=frozenset())
    first, second = (
        Disabled(*sorted(("foot", name)), "Never", 2)
        for name in group.links
        if description.links[name]
    )
    met = {("foot", group.name): 50}
    assert told(made, met, first) == [] == told(made, met, second)
    assert len(told(made, met, first, second)) == 1
