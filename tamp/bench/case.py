"""One run of a benchmark: what is solved, with which samplers, from which seed, in what time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from tamp.errors import InputError
from tamp.streams.choice import Registry, parse_choice

DEFAULT = "default"
"""The samplers that the problem has by itself."""


@dataclass(frozen=True)
class Case:
    """One run.

    Attributes:
        problem: A shipped problem's name, or a path.
        sampler: As the user wrote it: NAME, NAME:alone, NAME:mixed, or on=NAME,inside=NAME, or "default".
        seed: Of all randomness; runs of one seed are compared in pairs.
        time: The budget in seconds.
        algorithm: The planner's.
        samplers: Relation to sampler, as `load_problem` takes it.
    """

    problem: str
    sampler: str
    seed: int
    time: float
    algorithm: str = "adaptive"
    samplers: tuple[tuple[str, str], ...] = ()

    @property
    def config(self) -> dict[str, Any]:
        """All that tells it from another run, for the record."""
        return {**asdict(self), "samplers": dict(self.samplers)}


def key(config: Mapping[str, Any]) -> tuple[Any, ...]:
    """What makes two runs the same one."""
    return tuple(config[name] for name in ("problem", "sampler", "seed", "time", "algorithm"))


def cases(
    problems: Sequence[str],
    samplers: Sequence[str],
    seeds: Sequence[int],
    time: float,
    algorithm: str,
    known: Registry,
) -> list[Case]:
    """All runs of a benchmark, seed by seed, so that an early look is a fair one.

    Args:
        known: All samplers by relation and name.

    Raises:
        InputError: A sampler that does not exist, with the choices.
    """
    chosen = {sampler: tuple(sorted(relations(sampler, known).items())) for sampler in samplers}
    return [
        Case(problem, sampler, seed, time, algorithm, chosen[sampler])
        for seed in seeds
        for problem in dict.fromkeys(problems)
        for sampler in chosen
    ]


def relations(sampler: str, known: Registry) -> dict[str, str]:
    """The sampler by relation: a bare name serves every relation that has one of this name.

    Raises:
        InputError: Unknown relation, name or mode.
    """
    if sampler == DEFAULT:
        return {}
    chosen: dict[str, str] = {}
    if "=" in sampler:
        for pair in sampler.split(","):
            relation, _, text = pair.partition("=")
            chosen[relation] = parse_choice(relation, text, known).text
        return chosen
    name = sampler.partition(":")[0]
    able = [relation for relation in known if name in known[relation]]
    if not able:
        names = dict.fromkeys(name for makers in known.values() for name in makers)
        raise InputError(f"unknown sampler '{name}'", found=name, choices=(DEFAULT, *names))
    return {relation: parse_choice(relation, sampler, known).text for relation in able}
