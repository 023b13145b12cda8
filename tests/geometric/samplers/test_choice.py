"""What `--sampler` says becomes a choice, and a mistake in it an error with the choices."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.samplers.choice import (
    ANY_RELATION,
    SamplerSpec,
    factory,
    make_mixture,
    parse_choice,
    sampler_choices,
    sampler_files,
)
from tamp.geometric.samplers.placements import SurfacePlacements, UniformPlacements
from tamp.geometric.samplers.registry import SAMPLERS


def learned(relation: str = "", file: Path | None = None) -> UniformPlacements:
    made = UniformPlacements()
    made.made_of = (relation, file)  # type: ignore[attr-defined]
    return made


KNOWN = {**SAMPLERS, "on": {**SAMPLERS["on"], "learned": learned}, ANY_RELATION: {".npz": learned}}


@pytest.mark.parametrize(
    ("text", "choice"),
    [
        ("surface", SamplerSpec("surface", alone=True)),  # hand-made ones are alone by themselves
        ("surface:mixed", SamplerSpec("surface", alone=False)),
        ("learned", SamplerSpec("learned", alone=False)),
        ("learned:alone", SamplerSpec("learned", alone=True)),
        ("learned:mixed", SamplerSpec("learned", alone=False)),
    ],
)
def test_a_name_with_or_without_a_mode(text: str, choice: SamplerSpec) -> None:
    found = parse_choice("on", text, KNOWN)
    assert found == choice
    assert parse_choice("on", found.text, KNOWN) == choice  # what is written down is read back
    usual = text.partition(":")[0]
    assert found.text == (usual if parse_choice("on", usual, KNOWN) == choice else text)


@pytest.mark.parametrize(
    ("relation", "text", "words"),
    [
        ("un", "surface", "unknown relation 'un'.*Choices: on, inside.*Of one's own: un=FILE.npz"),
        (ANY_RELATION, "surface", r"unknown relation '\*'"),
        ("on", "surfase", "unknown sampler 'surfase' for 'on'.*Did you mean 'surface'?"),
        (
            "on",
            "learned:alon",
            "unknown mode 'alon' of sampler 'learned'.*Did you mean 'alone'?.*on=learned:alone",
        ),
        ("on", "learned:", "unknown mode '' of sampler 'learned'"),
        ("inside", "learned", "unknown sampler 'learned' for 'inside'"),
    ],
)
def test_what_nobody_knows_is_refused_with_the_choices(
    relation: str, text: str, words: str
) -> None:
    with pytest.raises(InputError, match=words):
        parse_choice(relation, text, KNOWN)


def test_a_file_serves_any_relation_by_its_whole_path(tmp_path: Path) -> None:
    found = parse_choice("upright", "w:1.npz:alone", KNOWN, tmp_path)
    assert found == SamplerSpec(
        str(tmp_path / "w:1.npz"), alone=True
    )  # a colon in a name is part of it
    assert parse_choice("on", "w.npz", KNOWN) == SamplerSpec(os.path.abspath("w.npz"), alone=False)
    assert parse_choice("on", "/a/../b.npz", KNOWN).name == "/b.npz"


def test_who_makes_it() -> None:
    assert isinstance(factory("on", SamplerSpec("surface", True), KNOWN)(), SurfacePlacements)
    made = factory("upright", SamplerSpec("/w.npz", False), KNOWN)()
    assert made.made_of == ("upright", Path("/w.npz"))  # type: ignore[union-attr]


def test_a_mixture_has_the_hand_made_one_beside_it_unless_alone() -> None:
    given = UniformPlacements()
    assert list(make_mixture("on", SamplerSpec("learned", False), given).names) == [
        "learned",
        "surface",
    ]
    assert list(make_mixture("on", SamplerSpec("learned", True), given).names) == ["learned"]
    assert list(make_mixture("on", SamplerSpec("surface", False), given).names) == ["surface"]
    assert list(make_mixture("upright", SamplerSpec("/x/w.npz", False), given).names) == ["w.npz"]


def test_files_among_samplers_come_with_their_cards() -> None:
    found = sampler_files(["surface", "learned:alone", "/w.npz:mixed", "mine.py"])
    assert found == [Path("/w.npz"), Path("/w.json"), Path("mine.py"), Path("mine.json")]


def test_pairs_of_the_command_line() -> None:
    assert sampler_choices(("on=uniform", "inside=a=b")) == {"on": "uniform", "inside": "a=b"}
    assert sampler_choices(("on=a", "on=b")) == {"on": "b"}
    for wrong in ("on", "=uniform", "on=", "="):
        with pytest.raises(
            InputError, match=f"--sampler wants RELATION=NAME, not '{wrong}'. For example"
        ):
            sampler_choices((wrong,))
