"""Rejection sampling of a relation's poses: batches proposed, certified in their order, the
promising ones first.
"""

from __future__ import annotations

import math
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from numpy.random import Generator as Random

from tamp.geometric.context import Context
from tamp.geometric.samplers.guarded_call import SamplerFault, propose_safely
from tamp.geometric.samplers.mixture import Mixture, SamplerRecord, SamplerStatistics, sidelined
from tamp.geometric.samplers.sampler import Generator
from tamp.geometric.scene.pose import Pose
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.placement import Placement, placed_pose
from tamp.geometric.streams.collisions import near
from tamp.stream import Call, Rejection, RejectionKind

POSES_PER_BATCH = 16
"""Poses asked of a generator at once."""

PROBATION_PROPOSALS = 2 * POSES_PER_BATCH
"""Proposals of which none is of use, after which a generator that is new to the run gives way in
this try."""

MAX_STALE_BATCHES = 3
"""Batches without anything new, or misbehaviours of a generator that is alone, after which it is
asked no more."""

Proposal = Placement | Pose
"""What a sampler says: a placement, or T_world_body to be snapped to a region."""

Judge = Callable[[Proposal], Pose | Rejection]
"""Certifies that a proposal rests, and where, or says why not."""


def certified_poses(
    context: Context,
    relation: str,
    mixture: Mixture,
    arguments: tuple[str, ...],
    judge: Judge,
    call: Call,
    at: Mapping[str, Pose] = MappingProxyType({}),
) -> Iterator[Pose | Rejection]:
    """Draw poses of the body `arguments[0]` that the judge accepts; a try is a batch of every
    generator at most.

    Of a batch, poses that are clear of the other bodies where the plan has them come first, in the
    batch's order. One that is not comes last: its test tells the search what is in the way.

    Args:
        context: Of the problem.
        relation: Its name; the run has one ledger a relation.
        mixture: Who proposes.
        arguments: The relation's.
        judge: What a pose must pass whatever the other bodies do.
        call: Of the stream that draws.
        at: Where bodies are wanted in the scene, whatever the plan has.
    """
    ledger = SamplerStatistics.of(relation, mixture, call.memory)
    poses: dict[str, Pose] = {
        name: pose for _, name, pose in call.fluents if name != arguments[0]
    } | dict(at)
    alone = len(mixture.generators) == 1
    sources: list[_SamplerState] = []
    for index, (generator, account) in enumerate(
        zip(mixture.generators, ledger.accounts, strict=True)
    ):
        # The trusted one draws the numbers that it would draw alone; each has a scene of its own.
        rng = call.rng if index == len(mixture.generators) - 1 else call.rng.spawn(1)[0]
        sources.append(
            _SamplerState(generator, account, context.scene_at(poses, arguments[0]), rng)
        )

    drawer = _ProposalLoop(context, ledger, sources, poses, arguments, judge, call, alone)
    while any(source.account.out is None and not source.ended for source in sources):
        if not call.ahead:
            ledger.asked(arguments)
            drawer.dismiss()
        result = drawer.next()
        if result is None:
            break
        yield result

    unruly = next(
        (
            source
            for source in sources
            if source.account.out is not None or source.faults >= MAX_STALE_BATCHES
        ),
        None,
    )
    if unruly is not None:
        what = f"{unruly.account.name}: {unruly.wrong}"
        yield Rejection(what, given_up=True, kind=RejectionKind.FAULT)


@dataclass
class _SamplerState:
    """One generator in one stream call.

    Attributes:
        batch: Proposals not yet judged.
        clear: Whether one of the batch was clear of the other bodies.
        deferred: The first of the batch that was not.
        seen: All proposals, rounded.
        faults: Misbehaviours.
        wrong: The latest one.
    """

    generator: Generator
    account: SamplerRecord
    scene: Scene
    rng: Random
    ended: bool = False
    batch: deque[Proposal] = field(default_factory=deque[Proposal])
    clear: bool = False
    deferred: Pose | None = None
    seen: set[tuple[object, ...]] = field(default_factory=set[tuple[object, ...]])
    faults: int = 0
    wrong: str = ""

    def take_deferred(self) -> Pose | None:
        """Return the pose that is kept for the end of the batch, once."""
        pose, self.deferred = self.deferred, None
        return pose


@dataclass
class _ProposalLoop:
    context: Context
    ledger: SamplerStatistics
    sources: list[_SamplerState]
    poses: Mapping[str, Pose]
    arguments: tuple[str, ...]
    judge: Judge
    call: Call
    alone: bool

    def next(self) -> Pose | Rejection | None:
        """Make one try; None when no generator has anything more to give."""
        refused: Counter[Rejection] = Counter()
        for index in self.ledger.order():
            source = self.sources[index]
            new = source.account.judged + POSES_PER_BATCH < PROBATION_PROPOSALS
            batches = 2 if new and index == 0 and not self.alone else 1

            for _ in range(batches):
                pose = self._from(source, refused)
                if pose is not None:
                    self.ledger.accepted(source.account, self.arguments)
                    self.dismiss()
                    return pose

        for index in self.ledger.order():
            source = self.sources[index]
            pose = source.take_deferred()
            if pose is not None:
                self.ledger.accepted(source.account, self.arguments)
                return pose
        return refused.most_common(1)[0][0] if refused else None

    def dismiss(self) -> None:
        """Sideline the chosen generator when it has shown that it is of no use."""
        useless = self.ledger.useless()
        if useless is not None:
            self._sideline(useless)

    def _sideline(self, account: SamplerRecord) -> None:
        names = [other.name for other in self.ledger.accounts if other is not account]
        self.call.warn(sidelined(self.ledger.relation, account, names))

    def _from(self, source: _SamplerState, refused: Counter[Rejection]) -> Pose | None:
        """Return the next pose of a generator's batch that is clear; a new batch is asked for when
        the last one is used up.
        """
        if source.ended or source.account.out is not None:
            return None
        if not source.batch:
            self._ask(source, refused)

        while source.batch:
            proposal = source.batch.popleft()
            pose = self.judge(proposal)
            if isinstance(pose, Rejection):
                refused[pose] += 1
                self.ledger.judged(source.account, pose.reason)
                self.call.refused(self._posed(proposal), pose)
                continue

            hit = next((name for name in self.poses if self._near(pose, name)), None)
            if hit is None:
                self.ledger.judged(source.account, None)
                source.clear = True
                return pose

            rejection = Rejection.hits(hit)
            self.ledger.judged(source.account, rejection.reason)
            self.call.refused(pose, rejection)
            source.deferred = source.deferred or pose

        return source.take_deferred() if source.clear else None

    def _near(self, pose: Pose, other: str) -> bool:
        return near(self.context, self.arguments[0], pose, other, self.poses[other])

    def _ask(self, source: _SamplerState, refused: Counter[Rejection]) -> None:
        account = source.account
        source.clear, source.deferred = False, None

        allowed = self.ledger.allowance(account, self.call.deadline)
        started = time.perf_counter()
        try:
            if allowed <= 0.0:
                raise SamplerFault(f"it took {account.seconds:.2f} s to propose poses")
            proposals = propose_safely(
                source.generator,
                source.scene,
                self.arguments,
                POSES_PER_BATCH,
                source.rng,
                self.call.deadline,
                allowed,
            )
        except SamplerFault as error:
            self._misbehaved(source, str(error), refused)
            return
        finally:
            account.seconds += time.perf_counter() - started

        if not proposals:
            source.ended = True
            return

        fresh = [pose for pose in proposals if self._is_new(source, pose)]
        source.batch.extend(fresh)
        account.work += len(proposals) - len(fresh)

        if len(fresh) <= len(proposals) // 8:
            refused[Rejection("proposed again")] += 1
            account.stale += 1
            if not self.alone and (
                account.stale >= MAX_STALE_BATCHES or len(proposals) == POSES_PER_BATCH
            ):
                self._misbehaved(source, "it proposes one pose again and again", refused)

    def _misbehaved(self, source: _SamplerState, what: str, refused: Counter[Rejection]) -> None:
        """Ask a generator beside the trusted one no more; alone it has a few more tries."""
        refused[Rejection(f"{source.account.name}: {what}", kind=RejectionKind.FAULT)] += 1
        source.wrong = what
        if not self.alone:
            source.batch.clear()
            source.account.out = what
            self._sideline(source.account)
            return
        self.call.warn(f"sampler '{source.account.name}' for '{self.ledger.relation}': {what}")
        source.faults += 1
        source.ended = source.faults >= MAX_STALE_BATCHES

    def _posed(self, proposal: Proposal) -> Pose:
        """Return T_world_body of what was proposed."""
        if isinstance(proposal, Pose):
            return proposal
        faces, scene = self.context.stable_faces(self.arguments[0]), self.context.scene
        region = scene.region(proposal.region)
        T_world_body = self.poses.get(region.body, scene.bodies[region.body].pose)
        return placed_pose(faces, proposal, T_world_body @ region.pose)

    def _is_new(self, source: _SamplerState, proposal: Proposal) -> bool:
        """Check whether the generator has not proposed this, to a tenth of a millimetre, in this
        call before.
        """
        key = _rounded(proposal)
        if key in source.seen:
            return False
        source.seen.add(key)
        return True


def _rounded(proposal: Proposal) -> tuple[object, ...]:
    """Round a proposal to a tenth of a millimetre and a thousandth of a turn's measure."""
    if isinstance(proposal, Placement):
        place = (round(proposal.x, 4), round(proposal.y, 4))
        turn = (round(math.cos(proposal.yaw), 3), round(math.sin(proposal.yaw), 3))
        return (proposal.region, proposal.face, *place, *turn)

    sign = 1.0 if proposal.quaternion[3] >= 0.0 else -1.0
    place = (round(x, 4) for x in proposal.position)
    return (*place, *(round(sign * q, 3) for q in proposal.quaternion))
