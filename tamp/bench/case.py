"""One run of a benchmark: what is solved, with which samplers, from which seed, in what time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from tamp.data import find_problem, shipped
from tamp.errors import InputError
from tamp.streams.choice import ANY, Registry, maker, parse_choice

DEFAULT = "default"
"""The samplers that the problem has by itself."""

IDENTITY = ("problem", "sampler", "seed", "time", "algorithm")
"""What makes two runs the same one."""


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
    return tuple(config[name] for name in IDENTITY)


def cases(
    problems: Sequence[str],
    samplers: Mapping[str, Mapping[str, str]],
    seeds: Sequence[int],
    time: float,
    algorithm: str = "adaptive",
) -> list[Case]:
    """All runs of a benchmark, seed by seed, so that an early look is a fair one.

    Args:
        problems: As `named` returns them.
        samplers: What `relations` says about each.
        seeds: One after the other.
        time: The budget of one run in seconds.
        algorithm: The planner's.
    """
    return [
        Case(problem, sampler, seed, time, algorithm, tuple(sorted(chosen.items())))
        for seed in seeds
        for problem in dict.fromkeys(problems)
        for sampler, chosen in samplers.items()
    ]


def named(problem: str) -> str:
    """The shipped problem's name, or the whole path of a user's own: one name from wherever it is asked for.

    Raises:
        InputError: There is none, with the choices.
    """
    path = find_problem(problem).resolve()
    return path.stem if path.parent == shipped("problems").resolve() else str(path)


def relations(sampler: str, known: Registry) -> dict[str, str]:
    """The sampler by relation: a bare name serves every relation that has one of this name.

    Args:
        sampler: As in `Case`.
        known: All samplers by relation and name, the hand-made ones included.

    Raises:
        InputError: Unknown relation, name or mode, or its weights are not there or damaged.
    """
    if sampler == DEFAULT:
        return {}
    if "=" in sampler:
        pairs = [pair.partition("=") for pair in sampler.split(",")]
        chosen = {relation: parse_choice(relation, text, known) for relation, _, text in pairs}
        for relation, choice in chosen.items():
            maker(relation, choice, known)()
        return {relation: choice.text for relation, choice in chosen.items()}
    name = sampler.partition(":")[0]
    able = [relation for relation in known if name in known[relation]]
    if not able:
        names = dict.fromkeys(name for other, makers in known.items() if other != ANY for name in makers)
        raise InputError(f"unknown sampler '{name}'", found=name, choices=(DEFAULT, *names))
    made: dict[str, str] = {}
    missing: list[InputError] = []
    for relation in able:
        choice = parse_choice(relation, sampler, known)
        try:
            known[relation][name]()
            made[relation] = choice.text
        except InputError as error:
            missing.append(error)
    if not made:
        raise missing[0]
    return made
