"""Proposals become certified poses: in batches, clear ones first, with accounts of what each generator gave."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pytest

from tamp.geometric.context import Context
from tamp.geometric.samplers.mixture import Mixture, accounts
from tamp.geometric.scene.pose import Pose
from tamp.geometric.streams.proposal_stream import (
    MAX_STALE_BATCHES,
    POSES_PER_BATCH,
    certified_poses,
)
from tamp.stream import Call, Rejection, RejectionKind
from tamp.system.deadline import Deadline
from tests.geometric.streams.scenes import problem_with


class Listing:
    """Proposes the poses of a list, batch by batch, and then nothing new."""

    def __init__(self, *poses: Pose) -> None:
        self._poses, self.asked = list(poses), 0

    def propose(
        self, scene: Any, arguments: Sequence[str], count: int, rng: np.random.Generator
    ) -> list[Pose]:
        self.asked += 1
        made, self._poses = self._poses[:count], self._poses[count:]
        return made


@pytest.fixture(scope="module")
def context(tmp_path_factory: pytest.TempPathFactory) -> Context:
    return problem_with("box", tmp_path_factory.mktemp("scene")).context


def at(x: float) -> Pose:
    return Pose((x, 0.0, 1.0))


def draws(
    context: Context, mixture: Mixture, call: Call, judge: Any = None
) -> Iterator[Pose | Rejection]:
    def accept(proposal: Any) -> Pose | Rejection:
        return proposal

    return certified_poses(context, "by", mixture, ("box", "table"), judge or accept, call)


def call(**more: Any) -> Call:
    return Call(np.random.default_rng(0), Deadline(60.0), **more)


def test_what_the_judge_accepts_comes_in_order_and_only_once(context: Context) -> None:
    poses = [at(1.0), at(1.2), at(1.0), at(1.4)]
    made = list(draws(context, Mixture(("mine",), (Listing(*poses),)), call()))
    assert [one for one in made if isinstance(one, Pose)] == [at(1.0), at(1.2), at(1.4)]


def test_the_commonest_refusal_of_a_try_is_given_and_each_is_told(context: Context) -> None:
    def judge(proposal: Pose) -> Pose | Rejection:
        low = proposal.position[0] < 0.5
        return Rejection.hits("lamp") if low else Rejection("too high")

    told: list[tuple[Any, Any]] = []
    asked = call(refused=lambda pose, why: told.append((pose, why)))
    listing = Listing(at(0.0), at(0.1), at(2.0))
    first = next(draws(context, Mixture(("mine",), (listing,)), asked, judge))
    assert first == Rejection.hits("lamp")
    hits = Rejection.hits("lamp")
    assert told == [(at(0.0), hits), (at(0.1), hits), (at(2.0), Rejection("too high"))]


def test_poses_clear_of_the_others_come_first_and_the_others_are_told_as_data(
    context: Context,
) -> None:
    told: list[tuple[Any, Any]] = []
    crowded = call(fluents=[("at-pose", "lamp", at(1.0))], refused=lambda *what: told.append(what))
    listing = Listing(at(1.0), at(1.3), at(0.98))
    made = list(draws(context, Mixture(("mine",), (listing,)), crowded))
    assert made[:2] == [at(1.3), at(1.0)]  # what is in the way comes last, and still comes
    assert told == [(at(x), Rejection.hits("lamp")) for x in (1.0, 0.98)]


def test_a_generator_alone_that_raises_ends_with_its_fault_and_proves_nothing(
    context: Context,
) -> None:
    class Raising:
        def propose(self, *_: Any) -> list[Pose]:
            raise ValueError("no idea")

    warned: list[str] = []
    made = list(
        draws(context, Mixture(("mine",), (Raising(),)), call(warn=warned.append))  # type: ignore[arg-type]
    )
    last = made[-1]
    assert isinstance(last, Rejection) and last.kind is RejectionKind.FAULT and last.given_up
    assert "raised ValueError" in last.reason and warned
    assert len(made) <= MAX_STALE_BATCHES + 1


def test_the_run_keeps_an_account_of_each_generator(context: Context) -> None:
    mixture = Mixture(
        ("mine", "trusted"), (Listing(at(1.0)), Listing(*(at(2.0 + i) for i in range(3))))
    )
    memory: dict[str, Any] = {}
    asked = call(memory=memory)
    made = [one for one in draws(context, mixture, asked) if isinstance(one, Pose)]
    assert made[0] == at(1.0) and set(made) >= {at(2.0), at(3.0)}
    mine, trusted = accounts(memory)["by"]
    assert (mine.name, trusted.name) == ("mine", "trusted")
    assert (mine.judged, trusted.judged) == (1, 3)


def test_no_more_than_a_batch_is_asked_for_at_once(context: Context) -> None:
    counts: list[int] = []

    class Counting(Listing):
        def propose(
            self, scene: Any, arguments: Sequence[str], count: int, rng: np.random.Generator
        ) -> list[Pose]:
            counts.append(count)
            return super().propose(scene, arguments, count, rng)

    listing = Counting(*(at(1.0 + i / 10) for i in range(POSES_PER_BATCH + 3)))
    made = list(draws(context, Mixture(("mine",), (listing,)), call()))
    assert len([one for one in made if isinstance(one, Pose)]) == POSES_PER_BATCH + 3
    assert set(counts) == {POSES_PER_BATCH}
