"""The choice of generators for a relation: a name, and whether it is mixed with the hand-made one
or alone.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.samplers.mixture import Mixture
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.geometric.samplers.sampler import Classifier, Generator

Grounding = Generator | Classifier
"""What grounds a relation: its generator, its classifier, or an object that is both."""

Registry = Mapping[str, Mapping[str, Callable[..., Grounding]]]
"""Relation to sampler name to what makes it, f(); it may raise InputError. See ANY_RELATION."""

ANY_RELATION = "*"
"""The relation under which a registry has suffixes of files for names; what reads such a file is
f(relation, file)."""

USER_OBJECT = "given"
"""The name of an object that was given in the place of a name."""

SAMPLER_MODES = ("mixed", "alone")


@dataclass(frozen=True)
class SamplerSpec:
    """A sampler, by name, for a relation.

    Attributes:
        name: In the registry.
        alone: Whether no other generator takes part.
    """

    name: str
    alone: bool

    @property
    def text(self) -> str:
        """Return the text as `--sampler` takes it, without the mode that is usual."""
        if self.alone == (self.name in HAND_MADE):
            return self.name
        return f"{self.name}:{'alone' if self.alone else 'mixed'}"


HAND_MADE = frozenset(name for registry in SAMPLERS.values() for name in registry)
"""The samplers that are alone unless it is said that they are mixed."""


def parse_choice(
    relation: str, text: str, registry: Registry, folder: Path | None = None
) -> SamplerSpec:
    """Read NAME, NAME:mixed or NAME:alone; a NAME may be a file, of which the choice has the whole
    path.

    Args:
        relation: Of any name where a file serves it.
        text: What is to be read.
        registry: All samplers.
        folder: Where a relative path starts; by default where the program runs.

    Raises:
        InputError: Unknown relation, name or mode.
    """
    name, colon, mode = (
        text.rpartition(":")
        if text.endswith(tuple(f":{mode}" for mode in SAMPLER_MODES))
        else (text, "", "")
    )
    if Path(name).suffix in registry.get(ANY_RELATION, {}):
        return SamplerSpec(os.path.abspath((folder or Path()) / name), alone=mode == "alone")

    name, colon, mode = text.partition(":")
    if relation not in registry or relation == ANY_RELATION:
        choices = [other for other in registry if other != ANY_RELATION]
        remedy = (
            f"Of one's own: {relation}=FILE{next(iter(registry[ANY_RELATION]))}"
            if registry.get(ANY_RELATION)
            else "Learned ones are known with registry=grounding.registry.GROUNDINGS"
        )
        raise InputError(
            f"unknown relation '{relation}'", found=relation, choices=choices, remedy=remedy
        )

    if name not in registry[relation]:
        raise InputError(
            f"unknown sampler '{name}' for '{relation}'", found=name, choices=registry[relation]
        )

    if colon and mode not in SAMPLER_MODES:
        remedy = f"For example: {relation}={name}:alone"
        raise InputError(
            f"unknown mode '{mode}' of sampler '{name}'",
            found=mode,
            choices=SAMPLER_MODES,
            remedy=remedy,
        )

    return SamplerSpec(name, alone=mode == "alone" if colon else name in HAND_MADE)


def sampler_files(samplers: Iterable[str]) -> list[Path]:
    """List the files that samplers are made from, as far as they are named by files: weights with
    their card, Python.
    """
    names = [Path(text.removesuffix(":alone").removesuffix(":mixed")) for text in samplers]
    return [file for name in names if name.suffix for file in (name, name.with_suffix(".json"))]


def maker(relation: str, choice: SamplerSpec, registry: Registry) -> Callable[[], Grounding]:
    """Return what makes the chosen sampler; it may raise InputError."""
    if choice.name in registry.get(relation, {}):
        return registry[relation][choice.name]
    return partial(registry[ANY_RELATION][Path(choice.name).suffix], relation, Path(choice.name))


def make_mixture(relation: str, choice: SamplerSpec, generator: Generator) -> Mixture:
    """Mix the chosen generator with the relation's hand-made one, unless it is to be alone."""
    trusted = next(iter(SAMPLERS.get(relation, {})), None)
    if choice.alone or trusted is None or choice.name == trusted:
        return Mixture((Path(choice.name).name,), (generator,))
    return Mixture((Path(choice.name).name, trusted), (generator, SAMPLERS[relation][trusted]()))


def sampler_choices(pairs: tuple[str, ...]) -> dict[str, str]:
    """Parse RELATION=NAME into a map of relations to names.

    Raises:
        InputError: Something else.
    """
    chosen: dict[str, str] = {}
    for pair in pairs:
        relation, equals, name = pair.partition("=")
        if not (relation and equals and name):
            raise InputError(
                f"--sampler wants RELATION=NAME, not '{pair}'",
                remedy="For example: --sampler on=uniform",
            )
        chosen[relation] = name
    return chosen
