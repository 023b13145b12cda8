"""The heuristics' inner loops: compiled they give what plain Python gives, and one search may begin with the other."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from benchmarks.search import cupboard
from tamp.symbolic.search.heuristics import relaxation
from tamp.symbolic.search.heuristics.loops import selection as tiers
from tamp.symbolic.search.heuristics.loops.compiled import COMPILED
from tamp.symbolic.search.heuristics.loops.interface import Kernels
from tamp.symbolic.search.heuristics.loops.rows import CsrRows, csr_rows
from tamp.symbolic.search.heuristics.registry import HEURISTICS
from tamp.symbolic.search.instantiation.instantiator import instantiate
from tamp.symbolic.search.operators import InstantiatedTask
from tamp.symbolic.search.search import search
from tamp.symbolic.search.successors import Successors
from tests.symbolic.search.test_prices import random_prices
from tests.symbolic.search.test_random_tasks import random_task


def walk(instantiated: InstantiatedTask, rng: Random) -> list[float | tuple[int, ...]]:
    """What all heuristics say along a random walk, under random prices."""
    successors = Successors(
        instantiated,
        random_prices(rng, frozenset().union(*(o.static for o in instantiated.operators))),
    )
    said: list[float | tuple[int, ...]] = []
    heuristics = [HEURISTICS[name](successors) for name in ("ff", "hadd", "hmax", "lmcut")]
    state = successors.initial
    for _ in range(8):
        closed = successors.closure(state)
        for heuristic in heuristics:
            estimate = heuristic(closed)
            said += [estimate.value, estimate.plan]
        choices = [
            i for i in successors.applicable(closed) if successors.step_cost(i, closed) < math.inf
        ]
        if not choices:
            break
        state = successors.apply(rng.choice(choices), state, closed)
    return said


@pytest.mark.parametrize("seed", range(40))
def test_all_ways_say_the_same(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    instantiated = instantiate(random_task(Random(seed)))
    stories: list[list[float | tuple[int, ...]]] = []
    for turns in ([tiers.PLAIN], [COMPILED], [tiers.PLAIN, COMPILED]):
        asked = [0]

        def choose(entries: int, turns: list[Kernels] = turns, asked: list[int] = asked) -> Kernels:
            asked[0] += 1
            return turns[asked[0] // 3 % len(turns)]

        monkeypatch.setattr(relaxation, "choose", choose)
        stories.append(walk(instantiated, Random(seed)))
    assert stories[0] == stories[1] == stories[2]


def test_a_search_ends_alike_whichever_loops_it_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[tuple[object, ...]] = []
    for loops in (tiers.PLAIN, COMPILED):
        monkeypatch.setattr(relaxation, "choose", lambda entries, loops=loops: loops)
        result = search(instantiate(*cupboard(3)))
        assert result.plan is not None
        found.append(
            (
                [(o.name, o.arguments) for o in result.plan.operators],
                result.plan.cost,
                result.evaluated,
            )
        )
    assert found[0] == found[1]


@pytest.mark.parametrize("loops", [tiers.PLAIN, COMPILED], ids=["plain", "compiled"])
def test_rows_are_turned_and_appended_to(loops: Kernels) -> None:
    rows = loops.rows([[2, 0], [], [2]])
    assert loops.transposed(rows, 4).lists() == [[0], [], [0, 2], []]
    more = loops.appended(rows, loops.integers([1, 3, 1]), loops.integers([5, 6, 7]), 5)
    assert more.lists() == [[2, 0], [5, 7], [2], [6], []]
    assert isinstance(more, CsrRows)
    assert csr_rows(more.lists()).lists() == more.lists()
    assert list(
        loops.incremented(
            loops.reals([1.0, 2.0]), loops.integers([1, 1]), loops.reals([0.5, 1.0]), 1
        )
    ) == [
        1,
        3.5,
        0,
    ]


def test_plain_python_is_left_when_it_has_done_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "tamp.symbolic.search.heuristics.loops.compiled")
    monkeypatch.setattr(tiers, "THRESHOLD", replace(tiers.THRESHOLD, entries=0, enough=None))
    monkeypatch.setattr(tiers, "compiled_before", lambda: False)
    assert tiers.choose(tiers.LOAD_THRESHOLD) is tiers.PLAIN
    assert tiers.choose(1) is tiers.PLAIN  # compiling takes longer than loading
    monkeypatch.undo()
    monkeypatch.setattr(tiers, "THRESHOLD", replace(tiers.THRESHOLD, entries=0, enough=None))
    assert tiers.choose(1) is COMPILED


def test_only_what_numba_has_all_of_and_newer_than_its_source_counts_as_compiled(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    (tmp_path / "__pycache__").mkdir()
    for module, _ in tiers.CACHED:
        source = tmp_path / Path(str(module.__file__)).name
        source.write_text("")
        monkeypatch.setattr(module, "__file__", str(source))
    for module, names in tiers.CACHED:
        for name in names:
            assert not tiers.compiled_before()
            (
                tmp_path / "__pycache__" / f"{Path(str(module.__file__)).stem}.{name}-7.py311.nbi"
            ).write_text("")
    assert tiers.compiled_before()
    later = time.time() + 10.0
    os.utime(tmp_path / "rows.py", (later, later))
    assert not tiers.compiled_before()


def test_what_was_compiled_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside the sources, where numba puts it unless a variable or a read-only folder has it put it elsewhere."""
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    code = (
        "from tamp.symbolic.search.heuristics.loops import selection; "
        "selection.load(); print(selection.compiled_before())"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "True"
