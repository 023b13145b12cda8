"""Problem files that were made to hang, to fill the memory or to end the interpreter are one error within seconds."""

from __future__ import annotations

import os
import time
from contextlib import nullcontext
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.load import load_scene
from tamp.geometric.loading.overlaps import check_overlaps, find_overlaps

BLOWN_UP_S = 20.0
"""CPU seconds that no small file needs, also on a machine that does ten things at once."""

GOOD = """\
domain: cupboard
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0.0, 0.0], yaw: 90 deg}
  can: CAN
goal: (on can table)
"""
CAN = "{cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.2, 0.1]}"
BOMB = "".join(
    f"  t{i}: &t{i} {{<<: [{', '.join([f'*t{i - 1}'] * 9) if i else '{sphere: 1}'}]}}\n"
    for i in range(60)
)
CHAIN = "".join(
    f"  t{i}: &t{i} {{<<: {f'*t{i - 1}' if i else '{}'}, sphere: 1}}\n" for i in range(2000)
)
PILE = "".join(f"  b{i}: {{box: [0.05, 0.05, 0.05], on: b{i + 1}}}\n" for i in range(3000))
RING = "".join(f"  b{i}: {{box: [0.05, 0.05, 0.05], on: b{(i + 1) % 1500}}}\n" for i in range(1500))


def body(can: str) -> str:
    return GOOD.replace("CAN", can)


def bodies(more: str) -> str:
    return body(CAN).replace("  can:", f"{more}  can:")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (bodies(BOMB), "nothing says where it is"),
        (bodies(f"{BOMB}  last: {{<<: *t59, size: 1}}\n"), "unknown key 'size'|nothing says"),
        (bodies(CHAIN), "nothing says|merges more than"),
        (bodies("  <<: [" + "{}, " * 50_000 + "]\n"), "merges more than 1000 mappings"),
        (bodies("  loop: &loop {<<: *loop}\n"), "bodies.loop: '<<' merges a mapping into itself"),
        (body(CAN).replace("bodies:", "bodies: &all\n  <<: *all"), "merges a mapping into itself"),
        (body("{sphere: 0.03, on: table, yaw: '9" + " " * 200_000 + "x'}"), "is not a number"),
        (body("{sphere: " + "9" * 500_000 + ", on: table}"), "is not a finite number"),
        (body("{sphere: 0.03, on: " + "t" * 500_000 + "}"), "unknown surface or body 'ttt"),
        (body("{sphere: 0.03, on: table, " + "k" * 500_000 + ": 1}"), "kkk|not valid YAML"),
        (body("{mesh: " + "m" * 500_000 + ".obj, on: table}"), "no mesh file 'mmm"),
        (body("{mesh: pipe.obj, on: table}"), "no mesh file 'pipe.obj'"),
        (body("{mesh: pipe.urdf, on: table}"), "no mesh file 'pipe.urdf'"),
        (body("{mesh: /dev/zero, on: table}"), "no mesh file '/dev/zero'"),
        (body(CAN) + "more: " + "[" * 300_000, "nested more than 100 deep"),
        (
            body(CAN).replace("furniture: table", "furniture: shelf, compartments: [1e9, 1e9]"),
            "at most 100",
        ),
        (
            bodies(PILE + "  b3000: {box: [0.05, 0.05, 0.05], on: floor}\n"),
            "carries more than 200 bodies",
        ),
        (bodies(RING), "carries more than 200 bodies|in a circle"),
        (body("{sphere: 0.03, at: [1e300, 0, 0.03]}"), "farther than 100000 m"),
        (body("{sphere: 1e-300, at: [1, 0, 0.03]}"), "1e-300|2e-300"),
        (body(CAN).replace("x: [-2.5, 2.5]", "x: [-1e300, 2.5]"), "farther than 100000 m"),
    ],
    ids=range(21),
)
def test_one_error_within_seconds(tmp_path: Path, text: str, message: str) -> None:
    os.mkfifo(tmp_path / "pipe.obj")
    os.mkfifo(tmp_path / "pipe.urdf")
    (tmp_path / "mine.yaml").write_text(text)
    started = time.process_time()
    with pytest.raises(InputError, match=message) as caught:
        load_scene(tmp_path / "mine.yaml")
    assert time.process_time() - started < BLOWN_UP_S
    assert caught.value.line is not None and len(caught.value.message) < 1000


def test_merges_that_are_no_mistake(tmp_path: Path) -> None:
    text = bodies(
        "  proto: &p {sphere: 0.03, mass: 0.3, at: [0, 1, 0.03]}\n  two: {<<: *p, at: [0, 2, 0.03]}\n"
    )
    (tmp_path / "mine.yaml").write_text(text)
    scene = load_scene(tmp_path / "mine.yaml").scene
    assert scene.bodies["two"].mass == 0.3 and scene.bodies["two"].pose.position[1] == 2


def crowd(count: int, step: float) -> str:
    return bodies(
        "".join(
            f"  b{i}: {{box: [0.05, 0.05, 0.05], at: [{i * step:.3f}, -1.5, 0.025]}}\n"
            for i in range(count)
        )
    )


@pytest.mark.parametrize(
    ("step", "message"),
    [
        (0.0, r"'b0' and 'b1' overlap at the start, 50\.0 mm deep"),
        (0.001, r"'b0' and 'b1' overlap"),
        (0.1, None),
    ],
    ids=["in one place", "like scales", "side by side"],
)
def test_work_grows_with_the_number_of_bodies_not_with_its_square(
    tmp_path: Path, step: float, message: str | None
) -> None:
    """Ratios, since a loaded machine needs several times the CPU time for the same work."""

    def work(count: int) -> float:
        (tmp_path / "mine.yaml").write_text(crowd(count, step))
        started = time.process_time()
        loaded = load_scene(tmp_path / "mine.yaml")
        with pytest.raises(InputError, match=message) if message else nullcontext():
            check_overlaps(loaded)
        return time.process_time() - started

    work(50)
    assert work(2000) < 12 * min(work(400), work(400))


def test_overlaps_come_in_the_scenes_order(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(crowd(4, 0.03))
    pairs = [
        (overlap.first, overlap.second)
        for overlap in find_overlaps(load_scene(tmp_path / "mine.yaml").scene)
    ]
    assert pairs == [("b0", "b1"), ("b1", "b2"), ("b2", "b3")]
