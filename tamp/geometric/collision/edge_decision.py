"""Continuous collision checking of an edge, for compiled code that has its arrays ready; see
kernels.py for the proof.
"""

from __future__ import annotations

import math

import numpy as np

from tamp.geometric.collision.gjk import APART, CLOSE, INLINE, JIT
from tamp.geometric.collision.kernels import (
    FLOOR,
    FREE,
    HIT,
    INTERVALS,
    ROOM,
    SELF,
    TASKS,
    UNDECIDED,
    check,
    required_clearance,
    spheres_apart,
)
from tamp.geometric.collision.placing import place_frames, place_part
from tamp.geometric.collision.tables import HIGH, LOW, ON_FLOOR, SIZE
from tamp.system.compilation import njit


@njit(**INLINE)
def encode_result(code, part, other):
    """Pack a code and the pair that it rests on into one integer; `pair_of` reads it."""
    return code | part << 2 | (other + 4096) << 14


def pair_of(verdict: int) -> tuple[int, int]:
    """Return the robot's part and what it met: an obstacle's row, FLOOR, ROOM, or SELF - the other
    part.
    """
    return verdict >> 2 & 4095, (verdict >> 14) - 4096


@njit(**INLINE)
def _box(i, margin, parts, placed, reach, box):
    """Compute the world box around robot part i, grown by `margin`: box[0:3] low, box[3:6] high."""
    for r in range(3):
        half = (
            abs(placed[i, 3 * r]) * parts[i, SIZE]
            + abs(placed[i, 3 * r + 1]) * parts[i, SIZE + 1]
            + abs(placed[i, 3 * r + 2]) * parts[i, SIZE + 2]
            + margin
        )
        box[i, r], box[i, 3 + r] = reach[i, r] - half, reach[i, r] + half


@njit(**INLINE)
def _overlap(box, i, obstacles, j):
    return (
        obstacles[j, LOW] <= box[i, 3] and obstacles[j, HIGH] >= box[i, 0]
        and obstacles[j, LOW + 1] <= box[i, 4] and obstacles[j, HIGH + 1] >= box[i, 1]
        and obstacles[j, LOW + 2] <= box[i, 5] and obstacles[j, HIGH + 2] >= box[i, 2]
    )  # fmt: skip


@njit(**JIT)
def _candidates(half, padding, parts, pairs, obstacles, placed, reach, box, found):
    """Find all pairs whose bounding spheres or boxes, grown by what the pair needs, overlap (broad
    phase): rows (part, other) of `found`.

    All parts are placed. The last row of `box` is the box around the whole robot.
    """
    n, count = parts.shape[0], 0
    for r in range(3):
        box[n, r], box[n, 3 + r] = math.inf, -math.inf

    for i in range(n):
        _box(
            i,
            required_clearance(i, np.int64(FLOOR), half, padding, parts, reach),
            parts,
            placed,
            reach,
            box,
        )
        for r in range(3):
            box[n, r], box[n, 3 + r] = min(box[n, r], box[i, r]), max(box[n, 3 + r], box[i, 3 + r])
        if box[i, 2] < 0.0 and parts[i, ON_FLOOR] == 0.0:
            found[count, 0], found[count, 1] = i, FLOOR
            count += 1

    for p in range(pairs.shape[0]):
        i, k = int(pairs[p, 0]), int(pairs[p, 1])
        if not spheres_apart(
            i, k, required_clearance(i, SELF - k, half, padding, parts, reach), parts, reach
        ):
            found[count, 0], found[count, 1] = i, SELF - k
            count += 1

    for j in range(obstacles.shape[0]):
        if _overlap(box, n, obstacles, j):
            for i in range(n):
                if _overlap(box, i, obstacles, j):
                    found[count, 0], found[count, 1] = i, j
                    count += 1

    return count


@njit(**INLINE)
def _leaves_the_room(start, end, room):
    """Check whether the base is outside of the room at one of the ends."""
    for conf in (start, end):
        if not (room[0] <= conf[0] <= room[1] and room[2] <= conf[1] <= room[3]):
            return True
    return False


@njit(**INLINE)
def moves_along(start, end):
    """Check whether the ends of an edge differ."""
    for k in range(len(start)):  # noqa: SIM110  compiled code has no generators
        if start[k] != end[k]:
            return True
    return False  # compiled code has no generators


@njit(**INLINE)
def _changes(start, end, change):
    """Compute how far each joint goes along the edge, the base as a whole; then with their signs,
    the base along x and y. Say if any moves.
    """
    moves = False
    for k in range(len(start)):
        change[len(start) + k] = end[k] - start[k]
        change[k] = abs(end[k] - start[k])
        moves = moves or change[k] > 0.0
    change[0] = math.hypot(change[0], change[1])
    return moves


@njit(**INLINE)
def _halve(head, tail, first, last, intervals, lists):
    """Append the halves of an interval; each has the tasks first..last-1 to decide."""
    for side in (-0.5, 0.5):
        intervals[tail, 0] = intervals[head, 0] + side * intervals[head, 1]
        intervals[tail, 1] = 0.5 * intervals[head, 1]
        lists[tail, 0], lists[tail, 1] = first, last
        tail += 1


@njit(**INLINE)
def _decide_pairs(
    head, first, last, count, half, padding, frames, change, joints, parts, part_poses, placed,
    reach, ready, obstacles, obstacle_poses, vertices, leaves, found, tasks, guesses, guess, s,
    weights,
):  # fmt: skip
    """Decide the pairs first..last-1 of interval `head` at its middle, where the frames are.

    Those that remain open are appended to `tasks`. Returns FREE and the number of tasks then, or
    how the edge ends and the number so far.
    """
    fresh = head < 3
    for t in range(first, last):
        if fresh:
            i, other = found[t, 0], found[t, 1]
            guess[0] = guess[1] = guess[2] = 0.0
        else:
            i, other = tasks[t, 0], tasks[t, 1]
            guess[0], guess[1], guess[2] = guesses[t, 0], guesses[t, 1], guesses[t, 2]
            for p in (i, SELF - other):
                if p >= 0 and ready[p] != head:
                    place_part(p, frames, change, joints, parts, part_poses, placed, reach)
                    ready[p] = head

        far = required_clearance(i, other, half, padding, parts, reach)
        answer = check(
            i, other, padding, far, parts, placed, reach, obstacles, obstacle_poses,
            vertices, leaves, guess, s, weights,
        )  # fmt: skip
        if answer == APART:
            continue
        if answer == CLOSE:
            return encode_result(np.int64(HIT), i, other), count
        if far <= padding or count == TASKS:
            return encode_result(np.int64(UNDECIDED), i, other), count

        tasks[count, 0], tasks[count, 1] = i, other
        guesses[count, 0], guesses[count, 1], guesses[count, 2] = guess[0], guess[1], guess[2]
        count += 1
    return np.int64(FREE), count


@njit(**{**INLINE, "_nrt": True})
def scratch(parts, joints, pairs, obstacles, size, moves):
    """Allocate what `decide` writes on, for configurations of `size` numbers.

    A few allocations, cut into pieces: each costs as much as a pair. A state (`moves` is false)
    needs less of them.
    """
    n, moved = parts.shape[0], joints.shape[0] + 1
    numbers, rows = np.empty(3 * size + 7), np.empty((moved + 5 + 2 * n, 12))
    reach = np.empty((n, moved + 7))
    ready = np.empty(n, np.int64)
    found = np.empty((n + pairs.shape[0] + n * obstacles.shape[0], 2), np.int64)
    intervals = np.empty((INTERVALS if moves else 1, 2))
    lists = np.empty((INTERVALS if moves else 1, 2), np.int64)
    tasks = np.empty((TASKS if moves else 0, 2), np.int64)
    guesses = np.empty((TASKS if moves else 0, 3))
    return numbers, rows, reach, ready, found, intervals, lists, tasks, guesses


@njit(**JIT)
def decide(start, end, padding, known, room, geometry, work):
    """Decide an edge, interval by interval; see kernels.py.

    Args:
        start, end: Configurations; equal ones make it a state check.
        padding: Metres.
        known: Whether the start is known to be free.
        room: `Tables.room`.
        geometry: The tables after it, in their order.
        work: What `scratch` made.

    Returns:
        A verdict.
    """
    if _leaves_the_room(start, end, room):
        return encode_result(np.int64(HIT), np.int64(0), np.int64(ROOM))
    joints, vertices, leaves, parts, part_poses, pairs, obstacles, obstacle_poses = geometry
    numbers, rows, reach, ready, found, intervals, lists, tasks, guesses = work
    n, size, moved = parts.shape[0], len(start), joints.shape[0] + 1
    conf, change = numbers[:size], numbers[size : 3 * size]
    guess, weights = numbers[3 * size : 3 * size + 3], numbers[3 * size + 3 :]
    frames, s = rows[:moved], rows[moved : moved + 4]
    placed, box = rows[moved + 4 : moved + 4 + n], rows[moved + 4 + n :]
    ready[:] = 0

    # Each interval: middle, half length, and the rows of `tasks` that it has to decide. The
    # first three, the ends (of no length) and the whole, find theirs themselves.
    moves = _changes(start, end, change)
    intervals[0, 0], intervals[0, 1] = 1.0, 0.0
    if moves:
        intervals[1, 0], intervals[1, 1] = 0.0, 0.0
        intervals[2, 0], intervals[2, 1] = 0.5, 0.5

    # Typed, since a literal would have what it is given to compiled twice.
    count, head, tail = np.int64(0), np.int64(0), np.int64(3 if moves else 1)
    while head < tail:
        if head == 1 and known:
            head += 1
        middle, half = intervals[head, 0], intervals[head, 1]
        for k in range(size):
            conf[k] = start[k] + middle * (end[k] - start[k])
        place_frames(conf, joints, frames)
        if head < 3:
            for k in range(n):
                place_part(k, frames, change, joints, parts, part_poses, placed, reach)
            first = np.int64(0)
            last = _candidates(half, padding, parts, pairs, obstacles, placed, reach, box, found)
        else:
            first, last = lists[head, 0], lists[head, 1]

        before = count
        answer, count = _decide_pairs(
            head, first, last, count, half, padding, frames, change, joints, parts, part_poses,
            placed, reach, ready, obstacles, obstacle_poses, vertices, leaves, found, tasks,
            guesses, guess, s, weights,
        )  # fmt: skip
        if answer != FREE:
            return answer
        if count > before:
            if tail + 2 > INTERVALS:
                return encode_result(np.int64(UNDECIDED), tasks[before, 0], tasks[before, 1])
            _halve(head, tail, before, count, intervals, lists)
            tail += 2
        head += 1
    return np.int64(FREE)
