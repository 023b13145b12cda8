"""What a benchmark is asked to run."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tamp.bench.case import cases, named, relations
from tamp.bench.fig8 import FIG8, chosen
from tamp.errors import InputError
from tamp.streams.placements import SurfacePlacements


def without_weights() -> SurfacePlacements:
    raise InputError("no such weight file")


KNOWN = {
    "on": {"surface": SurfacePlacements, "flow": SurfacePlacements, "mlp-bb": without_weights},
    "inside": {"surface": SurfacePlacements, "flow": without_weights},
}


def test_all_samplers_get_the_same_seeds_and_an_early_look_is_fair() -> None:
    found = cases(["swap", "packed", "swap"], {"default": {}, "flow": {"on": "flow"}}, range(2), 30.0)
    assert [(case.seed, case.problem, case.sampler) for case in found] == [
        (seed, problem, sampler) for seed in (0, 1) for problem in ("swap", "packed") for sampler in ("default", "flow")
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
    ],
)
def test_a_wrong_sampler_is_an_error(sampler: str, said: str) -> None:
    with pytest.raises(InputError, match=said):
        relations(sampler, KNOWN)


def test_a_problem_has_one_name_from_everywhere(root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    own = tmp_path / "swap.yaml"
    own.write_text("", encoding="utf-8")
    monkeypatch.chdir(root)
    assert named("packed") == named("problems/packed.yaml") == named(str(root / "problems" / "packed.yaml")) == "packed"
    assert named(os.path.relpath(own)) == str(own)
    with pytest.raises(InputError, match="Did you mean 'packed'"):
        named("pakced")


def test_what_is_not_shipped_is_skipped_by_name() -> None:
    able, skipped = chosen(FIG8, KNOWN)
    assert able == {"surface": {"on": "surface", "inside": "surface"}, "flow": {"on": "flow"}}
    assert len(able) + len(skipped) == 12
    assert "no such sampler" in skipped["gnn-pc"]
    assert "not shipped" in skipped["mlp-bb"]
