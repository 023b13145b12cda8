"""Closed-form inverse kinematics: the sweep over the last joint, within whose values a wrist may be reached."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from tamp.geometric.loading.robots import ROBOTS
from tamp.geometric.robot import closed_form
from tamp.geometric.robot.chain import Chain
from tamp.geometric.robot.closed_form import ClosedForm
from tests.geometric.robot.test_numerical import tool


@pytest.fixture(scope="module")
def chain() -> Chain:
    return Chain.of(ROBOTS["panda_mobile"]())


@pytest.fixture(scope="module")
def solver(chain: Chain) -> ClosedForm:
    return ClosedForm(chain)


def random_joints(chain: Chain, count: int) -> np.ndarray:
    return np.random.default_rng(4).uniform(chain.lower, chain.upper, (count, 7))


def wrapped(angles: np.ndarray) -> np.ndarray:
    return (angles + math.pi) % (2 * math.pi) - math.pi


def test_the_joint_angles_that_gave_the_pose_are_found_again(chain: Chain) -> None:
    """Where the last joint's value is one of the sweep's, all six others are among the solutions."""
    solver = ClosedForm(chain, coarse=5)
    low, high = chain.lower[6], chain.upper[6]
    for q in random_joints(chain, 30):
        q[6] = low + (high - low) * 0.625  # the fifth of van der Corput's sequence
        found = solver.solve(tool(chain, q))
        assert np.abs(wrapped(found - q)).max(axis=1).min() < 1e-6


def test_solutions_meet_the_pose_within_the_limits_and_differ(
    chain: Chain, solver: ClosedForm
) -> None:
    for q in random_joints(chain, 30):
        target = tool(chain, q)
        found = solver.solve(target)
        assert np.all((found >= chain.lower) & (found <= chain.upper))
        for one in found:
            assert tool(chain, one) == pytest.approx(target, abs=2e-6)
        assert len(np.unique(found.round(5), axis=0)) == len(found)


def test_a_search_that_found_nothing_goes_on_with_finer_values(chain: Chain) -> None:
    """A pose at the edge of reach, for which one value of the last joint is not enough, but 192 are."""
    rough, fine = ClosedForm(chain, coarse=1, fine=1), ClosedForm(chain, coarse=1, fine=192)
    poses = [tool(chain, q) for q in random_joints(chain, 60)]
    alone = [len(rough.solve(T)) for T in poses]
    both = [len(fine.solve(T)) for T in poses]
    assert 0 in alone and np.count_nonzero(both) > np.count_nonzero(alone)
    assert all(b == a for a, b in zip(alone, both, strict=True) if a)


def test_enough_is_enough(chain: Chain, solver: ClosedForm) -> None:
    target = tool(chain, chain.home)
    every = solver.solve(target)
    for enough in (1, 3, 10):
        few = solver.solve(target, enough)
        assert enough <= len(few) < len(every)
        assert np.array_equal(few, every[: len(few)])


def test_random_values_of_the_last_joint_stay_in_its_limits_and_are_others(
    chain: Chain, solver: ClosedForm
) -> None:
    target = tool(chain, chain.home)
    plain = set(solver.solve(target)[:, 6].round(9))
    for seed in range(5):
        found = solver.solve(target, rng=np.random.default_rng(seed))[:, 6]
        assert np.all((found >= chain.lower[6]) & (found <= chain.upper[6]))
        assert plain.isdisjoint(found.round(9))


def test_no_value_is_left_out_for_which_there_is_a_solution(
    chain: Chain, solver: ClosedForm, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The bound on the wrist saves work only: without it the same solutions are found."""
    poses = [tool(chain, q) for q in random_joints(chain, 25)]
    bounded = [solver.solve(T) for T in poses]
    asked = [len(solver._within_reach(T, solver._sevenths, range(24))) for T in poses]
    monkeypatch.setattr(ClosedForm, "_within_reach", lambda self, T, sevenths, stage: list(stage))
    for before, T in zip(bounded, poses, strict=True):
        assert np.array_equal(before, solver.solve(T))
    assert min(asked) < 24  # it saves some


def test_the_wrist_of_a_value_is_where_forward_kinematics_have_it(chain: Chain) -> None:
    """Also where the last joint stands off its wrist in all directions."""
    bent = dataclasses.replace(chain, origins=chain.origins.copy())
    bent.origins[6, :3, 3] += [0.0, 0.03, -0.02]
    solver = ClosedForm(bent)
    before = dataclasses.replace(
        bent, origins=bent.origins[:6], slides=bent.slides[:6], T_flange_tool=np.eye(4)
    )
    for q in random_joints(chain, 20):
        wrist = tool(before, q[:6])[:3, 3]
        distance = float(np.linalg.norm(wrist - bent.origins[0, :3, 3]))
        for near, far, found in (
            (distance - 1e-6, distance + 1e-6, [0]),
            (distance + 1e-6, 9.0, []),
            (0.0, distance - 1e-6, []),
        ):
            solver._reach = (near, far)
            assert solver._within_reach(tool(bent, q), q[6:], range(1)) == found


def test_random_values_are_the_usual_ones_shifted_and_wrapped(
    chain: Chain, solver: ClosedForm, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Seen as angles of one turn through the limits, all gaps between them stay."""
    seen: list[np.ndarray] = []
    monkeypatch.setattr(
        ClosedForm, "_within_reach", lambda self, T, sevenths, stage: seen.append(sevenths) or []
    )
    solver.solve(np.eye(4))
    solver.solve(np.eye(4), rng=np.random.default_rng(1))
    low, wide = chain.lower[6], chain.upper[6] - chain.lower[6]
    assert np.all((seen[2] >= low) & (seen[2] <= low + wide))
    shifts = (seen[2] - seen[0]) % wide
    assert shifts == pytest.approx(np.full(len(shifts), shifts[0]))


def test_the_wrist_is_between_the_least_and_the_largest_distance(chain: Chain) -> None:
    """Over random elbows; the largest is reached to 1 mm where the arm is stretched."""
    near, far = closed_form._reach(chain.origins)
    distances: list[float] = []
    for elbow in np.random.default_rng(0).uniform(-math.pi, math.pi, 4000):
        T, places = np.eye(4), []
        for origin, turn in zip(chain.origins, (0.4, -0.3, 1.0, elbow, 0.2, 0.1, 0.0), strict=True):
            turned = np.eye(4)
            turned[:2, :2] = [[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]
            T = T @ origin @ turned
            places.append(T[:3, 3])
        distances.append(float(np.linalg.norm(places[5] - places[0])))
    assert near <= min(distances) and max(distances) <= far
    assert far - max(distances) < 1e-3 and min(distances) - near < 1e-3


def test_the_sequence_of_van_der_corput() -> None:
    expected = [1 / 2, 1 / 4, 3 / 4, 1 / 8, 5 / 8, 3 / 8, 7 / 8, 1 / 16]
    assert [closed_form._van_der_corput(i) for i in range(1, 9)] == expected
