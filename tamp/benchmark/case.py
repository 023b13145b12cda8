"""One run of a benchmark: what is solved, with which samplers, from which seed, in what time."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.geometric.samplers.choice import ANY_RELATION, Registry, maker, parse_choice
from tamp.geometric.samplers.python_file import PYTHON_SUFFIX, parted, python_grounding
from tamp.system.files import find_problem, shipped
from tamp.system.python_object import python_source
from tamp.system.reading import read_bytes

DEFAULT = "default"
"""The samplers that the problem has by itself."""

MOST_BYTES = 200_000_000
"""The largest file of a sampler: weights, or Python."""

IDENTITY = ("problem", "sampler", "seed", "time", "algorithm")
"""What makes two runs the same one."""


@dataclass(frozen=True)
class Case:
    """One run.

    Attributes:
        problem: A shipped problem's name, or a path.
        sampler: As the user wrote it: NAME, NAME:alone, NAME:mixed, or on=NAME,inside=NAME, or
            "default"; behind the name of a file stands which one it was: on=mine.py#3f2a9c1b.
        seed: Of all randomness; runs of one seed are compared in pairs.
        time: The budget in seconds.
        algorithm: The planner's.
        samplers: Relation to sampler, as `tamp-solve --sampler` takes it.
        sources: Python files that serve relations, and what stands in them: all runs have the same,
            wherever they run.
    """

    problem: str
    sampler: str
    seed: int
    time: float
    algorithm: str = "adaptive"
    samplers: tuple[tuple[str, str], ...] = ()
    sources: tuple[tuple[str, str], ...] = ()

    @property
    def config(self) -> dict[str, Any]:
        """Return the configuration that tells it from another run, for the record."""
        entries = {**asdict(self), "samplers": dict(self.samplers)}
        del entries["sources"]
        return entries


def key(config: Mapping[str, Any]) -> tuple[Any, ...]:
    """Return the key that makes two runs the same one."""
    return tuple(config[name] for name in IDENTITY)


def cases(
    problems: Sequence[str],
    samplers: Mapping[str, Mapping[str, str]],
    seeds: Sequence[int],
    time: float,
    algorithm: str = "adaptive",
    sources: Mapping[str, str] | None = None,
) -> list[Case]:
    """Return all runs of a benchmark, seed by seed, so that an early look is a fair one.

    Args:
        problems: As `named` returns them.
        samplers: What `relations` says about each.
        seeds: One after the other.
        time: The budget of one run in seconds.
        algorithm: The planner's.
        sources: What stands in the Python files among the samplers, by name.
    """
    return [
        Case(
            problem,
            sampler,
            seed,
            time,
            algorithm,
            tuple(sorted(chosen.items())),
            _used(chosen, sources or {}),
        )
        for seed in seeds
        for problem in dict.fromkeys(problems)
        for sampler, chosen in samplers.items()
    ]


def _used(chosen: Mapping[str, str], sources: Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    files = sorted({parted(text)[0] for text in chosen.values()} & sources.keys())
    return tuple((file, sources[file]) for file in files)


def named(problem: str) -> str:
    """Return the shipped problem's name, or the whole path of a user's own: one name from wherever
    it is asked for.

    Raises:
        InputError: There is none, with the choices.
    """
    path = find_problem(problem).resolve()
    return path.stem if path.parent == shipped("problems").resolve() else str(path)


def labelled(sampler: str, chosen: Mapping[str, str]) -> tuple[str, dict[str, str]]:
    """Return how the results name a sampler, and what stands in its Python files.

    A file is named with the beginning of its hash: when it is changed, it is another sampler.

    Args:
        sampler: As in `Case`.
        chosen: What `relations` says about it.

    Raises:
        InputError: A file cannot be read.
    """
    label, sources = sampler, dict[str, str]()
    for _, text in _pairs(sampler) if "=" in sampler else ():
        name = parted(text)[0]
        file = next(
            (
                parted(one)[0]
                for one in chosen.values()
                if Path(parted(one)[0]) == Path(name).resolve()
            ),
            None,
        )
        if file is None:
            continue
        content = read_bytes(Path(file), MOST_BYTES)
        label = label.replace(name, f"{name}#{sha256(content).hexdigest()[:8]}", 1)
        if Path(file).suffix == PYTHON_SUFFIX:
            sources[file] = python_source(Path(file))
    return label, sources


def _pairs(sampler: str) -> list[tuple[str, str]]:
    """Parse RELATION=NAME,RELATION=NAME as pairs; a file's name may have a comma."""
    parts = (pair.partition("=") for pair in re.split(r",(?=[^,=]+=)", sampler))
    pairs = [(relation, name) for relation, _, name in parts]
    for relation, count in Counter(relation for relation, _ in pairs).items():
        if count > 1:
            raise InputError(f"sampler '{sampler}': the relation '{relation}' stands twice")
    return pairs


def relations(sampler: str, registry: Registry) -> dict[str, str]:
    """Return the sampler by relation: a bare name serves every relation that has one of this name.

    Args:
        sampler: As in `Case`.
        registry: All samplers by relation and name, the hand-made ones included.

    Raises:
        InputError: Unknown relation, name or mode, or its weights are not there or damaged.
    """
    if sampler == DEFAULT:
        return {}
    if "=" in sampler:
        served: dict[str, str] = {}
        for relation, text in _pairs(sampler):
            file, mode = parted(text)
            if Path(file).suffix == PYTHON_SUFFIX:
                python_grounding(Path(file))
                served[relation] = f"{Path(file).resolve()}{mode}"
                continue
            choice = parse_choice(relation, text, registry)
            maker(relation, choice, registry)()
            served[relation] = choice.text
        return served

    name = sampler.partition(":")[0]
    able = [relation for relation in registry if name in registry[relation]]
    if not able:
        names = dict.fromkeys(
            name for other, makers in registry.items() if other != ANY_RELATION for name in makers
        )
        remedy = (
            f"Of a file say which relation it serves: on={sampler}" if Path(name).suffix else ""
        )
        raise InputError(
            f"unknown sampler '{name}'", found=name, choices=(DEFAULT, *names), remedy=remedy
        )

    made: dict[str, str] = {}
    missing: list[InputError] = []

    for relation in able:
        choice = parse_choice(relation, sampler, registry)
        try:
            registry[relation][name]()
            made[relation] = choice.text
        except InputError as error:
            missing.append(error)

    if not made:
        raise missing[0]
    return made
