"""What a benchmark is asked to run."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from tamp.benchmark.case import cases, labelled, named, relations
from tamp.errors import InputError
from tests.benchmark.samplers import KNOWN, MINE


def test_all_samplers_get_the_same_seeds_and_an_early_look_is_fair() -> None:
    found = cases(
        ["swap", "packed", "swap"], {"default": {}, "flow": {"on": "flow"}}, range(2), 30.0
    )
    assert [(case.seed, case.problem, case.sampler) for case in found] == [
        (seed, problem, sampler)
        for seed in (0, 1)
        for problem in ("swap", "packed")
        for sampler in ("default", "flow")
    ]
    assert found[1].config["samplers"] == {"on": "flow"}


def test_a_bare_name_serves_the_relations_that_have_its_weights() -> None:
    assert relations("default", KNOWN) == {}
    assert relations("surface", KNOWN) == {"on": "surface", "inside": "surface"}
    assert relations("flow:alone", KNOWN) == {"on": "flow:alone"}
    assert relations("on=flow,inside=surface", KNOWN) == {"on": "flow", "inside": "surface"}


@pytest.mark.parametrize(
    ("sampler", "said"),
    [
        ("flwo", "Did you mean 'flow'"),
        ("flow:solo", "unknown mode 'solo'"),
        ("mlp-bb", "no such weight file"),
        ("inside=flow", "no such weight file"),
        ("under=flow", "unknown relation 'under'"),
        ("on=nobody", "unknown sampler 'nobody' for 'on'"),
        ("on=none.py", r"none\.py: no such file"),
        ("mine.py", "Of a file say which relation it serves: on=mine.py"),
        ("on=flow,on=surface", "the relation 'on' stands twice"),
    ],
)
def test_a_wrong_sampler_is_an_error(sampler: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        relations(sampler, KNOWN)


def test_a_problem_has_one_name_from_everywhere(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = tmp_path / "swap.yaml"
    own.write_text("", encoding="utf-8")
    monkeypatch.chdir(root)
    assert (
        named("packed")
        == named("problems/packed.yaml")
        == named(str(root / "problems" / "packed.yaml"))
        == "packed"
    )
    assert named(os.path.relpath(own)) == str(own)
    with pytest.raises(InputError, match="Did you mean 'packed'"):
        named("pakced")


def test_a_python_file_is_named_with_its_hash_and_sent_along(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "mine,own.py"
    file.write_text(MINE)
    served = relations("on=mine,own.py:alone,inside=surface", KNOWN)
    assert served == {"on": f"{file}:alone", "inside": "surface"}
    label, sources = labelled("on=mine,own.py:alone,inside=surface", served)
    assert re.fullmatch(r"on=mine,own\.py#[0-9a-f]{8}:alone,inside=surface", label)
    assert sources == {str(file): MINE}
    (case,) = cases(["swap"], {label: served}, [0], 30.0, sources=sources)
    assert case.sources == ((str(file), MINE),)
    assert "sources" not in case.config
    file.write_text(MINE + "# another one")
    assert labelled("on=mine,own.py", served)[0] != label
    assert labelled("default", {}) == ("default", {})
    assert labelled("on=flow", {"on": "flow"}) == ("on=flow", {})


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("grounding = 3", "has neither propose nor classify"),
        ("grounding = ", r"mine\.py:1: it cannot be run: SyntaxError"),
        ("1 / 0", "it cannot be run: ZeroDivisionError"),
        ("# -*- coding: nonsense -*-", "this is no Python file"),
        ("other = 3", "it defines no 'grounding'"),
    ],
)
def test_a_python_file_that_does_not_serve(text: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "mine.py").write_text(text)
    with pytest.raises(InputError, match=said):
        relations(f"on={tmp_path / 'mine.py'}", KNOWN)
