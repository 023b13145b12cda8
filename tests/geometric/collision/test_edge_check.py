"""The checker of edges as Python calls it: its packed tables, its verdicts, and when what is compiled is stale."""

from __future__ import annotations

import ast
import shutil
from pathlib import Path

import numpy as np
import pytest

from tamp.geometric.collision import edge_check
from tamp.geometric.collision.edge_check import check_edge, pair_of, sources_digest
from tamp.geometric.collision.kernels import FLOOR, FREE, HIT, ROOM, SELF
from tests.geometric.collision.lever import conf, outcome, tables
from tests.geometric.plain_kernels import plain

PADDING_M = 0.002


@pytest.mark.parametrize("obstacles", [[], [(1.0, 0.0, 0.5), (0.0, 1.0, 0.5)]])
def test_what_is_unpacked_is_what_was_packed(obstacles: list) -> None:
    made = tables(obstacles, pairs=True)
    packed, unpack = made.packed(), plain(edge_check).unpack
    for index, (name, table) in enumerate(made._asdict().items()):
        found = unpack(packed, index)
        rows = table if table.ndim == 2 else table[None]
        assert found.shape == rows.shape and (found == rows).all(), name


@pytest.mark.parametrize(
    ("start", "end", "expected", "pair"),
    [
        # Past a cube at (1, 0), and with the ball of the base through it.
        (conf(0.0, 0.9, 1.5), conf(1.5, 0.9, 1.5), FREE, None),
        (conf(0.0, 0.0, 3.1), conf(1.5, 0.0, 3.1), HIT, (0, 0)),
        # The lever's ball, a metre ahead, turns from +y onto it; the base stays.
        (conf(0.0, 0.0, 0.0, 1.5), conf(0.0, 0.0, 0.0, 0.0), HIT, (1, 0)),
        (conf(0.0, 0.0, 0.0, 1.5), conf(0.0, 0.0, 0.0, 0.3), FREE, None),
        (conf(0.0, 0.0, 3.0), conf(-2.1, 0.0, 3.0), HIT, (0, ROOM)),
    ],
)
def test_verdicts_name_the_part_and_what_it_meets(start, end, expected: int, pair) -> None:
    verdict = check_edge(start, end, PADDING_M, tables([(1.0, 0.0, 0.5)]).packed())
    assert outcome(verdict) == expected
    assert pair is None or pair_of(verdict) == pair


def test_a_state_is_an_edge_of_equal_ends() -> None:
    """The base's ball is 0.1 m beside the cube's face at x = 0.9 when its centre is at 0.7."""
    packed = tables([(1.0, 0.0, 0.5)]).packed()
    for x, expected in ((0.7, FREE), (0.797, FREE), (0.799, HIT), (1.0, HIT)):
        state = conf(x, 0.0, np.pi)
        assert outcome(check_edge(state, state, PADDING_M, packed)) == expected
    assert outcome(check_edge(conf(0.7, 0.0, np.pi), conf(0.7, 0.0, np.pi), 0.11, packed)) == HIT


def test_arrays_of_another_kind_are_refused() -> None:
    packed, strided = tables().packed(), np.repeat(conf(0.0, 0.0), 2)[::2]
    for wrong in ([0.0, 0.0, 0.0, 0.0], strided, conf(0.0, 0.0).astype(np.float32)):
        with pytest.raises(TypeError):
            check_edge(wrong, conf(0.0, 0.0), PADDING_M, packed)  # type: ignore[arg-type]


def test_parts_meet_each_other_only_where_the_pair_is_asked_for() -> None:
    """Part 1 is brought to part 0 by a joint that is 1 m behind it: here both stand at one place."""
    together = tables(pairs=True)
    together.part_poses[1] = together.part_poses[0]
    state = conf(0.0, 0.0)
    verdict = check_edge(state, state, PADDING_M, together.packed())
    assert outcome(verdict) == HIT and pair_of(verdict) == (0, SELF - 1)
    unasked = together._replace(pairs=np.zeros((0, 2)))
    assert outcome(check_edge(state, state, PADDING_M, unasked.packed())) == FREE


@pytest.mark.parametrize("floor", [False, True])
def test_the_floor_is_for_parts_that_do_not_stand_on_it(floor: bool) -> None:
    low = tables(floor=floor)
    low.part_poses[0, 11] = 0.1  # its ball touches z = 0
    state = conf(0.0, 0.0)
    verdict = check_edge(state, state, PADDING_M, low.packed())
    assert outcome(verdict) == (FREE if floor else HIT)
    assert floor or pair_of(verdict) == (0, FLOOR)


def test_a_changed_source_makes_the_compiled_kernel_stale(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = Path(edge_check.__file__).parent
    for name in edge_check._SOURCES:
        shutil.copy(folder / f"{name}.py", tmp_path)
    before = sources_digest()
    monkeypatch.setattr(edge_check, "__file__", str(tmp_path / "edge_check.py"))
    assert sources_digest() == before
    for name in edge_check._SOURCES:
        file = tmp_path / f"{name}.py"
        text = file.read_text(encoding="utf-8")
        file.write_text(f"{text}\n# changed\n", encoding="utf-8")
        assert sources_digest() != before, name
        file.write_text(text, encoding="utf-8")


def test_all_that_the_kernel_is_made_of_is_among_its_sources() -> None:
    folder = Path(edge_check.__file__).parent
    needed: set[str] = set()
    for name in edge_check._SOURCES:
        for node in ast.walk(ast.parse((folder / f"{name}.py").read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                package, _, module = node.module.rpartition(".")
                needed |= {module} if package == "tamp.geometric.collision" else set()
    assert needed and needed <= set(edge_check._SOURCES)
