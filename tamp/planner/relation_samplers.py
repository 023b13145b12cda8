"""Samplers and classifiers that serve a problem's relations: those named, the objects given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem
from tamp.geometric.samplers.choice import (
    USER_OBJECT,
    Grounding,
    Registry,
    SamplerSpec,
    factory,
    parse_choice,
)
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.geometric.samplers.sampler import Generator
from tamp.geometric.scene.classifier import Classifier, NoClassifier
from tamp.geometric.streams.user_relations import sample_relation, test_relation
from tamp.symbolic.pddl.relations import SAMPLE_SUFFIXES, TEST_SUFFIXES, relation_of
from tamp.symbolic.pddl.structs import Domain, Stream, StreamFile

BORNE = "borne"
"""(borne ?o ?p ?below ?pb): certified by a stream, it makes ?o at ?p rest on the movable ?below."""


@dataclass(frozen=True)
class Served:
    """The samplers and classifiers that serve a problem, by relation.

    Attributes:
        choices: The samplers by name.
        generators: The objects that propose.
        classifiers: Those that judge.
        undecided: Why an object does not judge yet, where it says so.
    """

    choices: Mapping[str, SamplerSpec]
    generators: Mapping[str, Generator]
    classifiers: Mapping[str, Classifier]
    undecided: Mapping[str, str]

    @classmethod
    def of(
        cls,
        loaded: LoadedProblem,
        samplers: Mapping[str, str],
        groundings: Mapping[str, Grounding],
        registry: Registry,
    ) -> Served:
        """Take what the problem names, over it `samplers` by name and `groundings` as objects.

        Raises:
            InputError: An unknown relation or sampler; one of `on` or `inside` that cannot propose.
        """
        makers_of: dict[str, dict[str, Callable[..., Grounding]]] = {}
        given = {
            relation: {USER_OBJECT: partial(_same, item)} for relation, item in groundings.items()
        }
        for source in (SAMPLERS, registry, given):
            for relation, makers in source.items():
                makers_of.setdefault(relation, {}).update(makers)

        choices = {
            relation: SamplerSpec(next(iter(makers)), alone=True)
            for relation, makers in SAMPLERS.items()
        }
        for relation, text in loaded.samplers.items():
            try:
                choices[relation] = parse_choice(relation, text, makers_of, loaded.path.parent)
            except InputError as error:
                raise error.at(loaded.path, loaded.line_of("samplers", relation)) from None

        choices |= {
            relation: parse_choice(relation, text, makers_of) for relation, text in samplers.items()
        }
        for relation, item in groundings.items():
            if (
                isinstance(item, Generator)
                and choices.get(relation, SamplerSpec("", False)).name != USER_OBJECT
            ):
                choices[relation] = SamplerSpec(USER_OBJECT, alone=False)

        made: dict[str, Grounding] = {
            name: factory(name, choice, makers_of)() for name, choice in choices.items()
        }
        for relation, item in made.items():
            if not isinstance(item, Generator) and relation in SAMPLERS:
                what = f"sampler '{choices[relation].name}' for '{relation}' has no method propose"
                raise InputError(
                    what, remedy="tamp/geometric/samplers/sampler.py says what it is asked"
                )

        judging = {**made, **groundings}
        return cls(
            choices,
            {relation: item for relation, item in made.items() if isinstance(item, Generator)},
            {relation: item for relation, item in judging.items() if isinstance(item, Classifier)},
            {
                relation: item.cannot_tell
                for relation, item in judging.items()
                if isinstance(item, NoClassifier)
            },
        )

    def functions(self, declared: StreamFile, domain: Domain) -> dict[str, Callable[..., Any]]:
        """Return the functions of the streams sample-R and test-R.

        Raises:
            InputError: There is a stream test-R, and the object for R cannot tell yet whether R
                holds.
        """
        streams = {stream.name: stream for stream in declared.streams}
        functions: dict[str, Callable[..., Any]] = {}
        for name, generator in self.generators.items():
            if name not in SAMPLERS:
                judge = None if f"test-{name}" in streams else self._judge(name, declared, domain)
                serve = partial(sample_relation, relation=name, generator=generator, judge=judge)
                for stream in {
                    f"sample-{name}{suffix}" for suffix in SAMPLE_SUFFIXES
                } & streams.keys():
                    functions[stream] = partial(serve, below=_below(streams[stream]))

        for name, classifier in self.classifiers.items():
            for suffix in TEST_SUFFIXES:
                functions[f"test-{name}{suffix}"] = partial(test_relation, classifier=classifier)

        for name, why in self.undecided.items():
            test = streams.get(f"test-{name}")
            if test is not None and test.name not in functions:
                line, column = (test.place.line, test.place.column) if test.place else (None, None)
                what = (
                    f"stream '{test.name}' needs a classifier, "
                    f"and that of '{name}' cannot tell yet: {why}"
                )
                remedy = (
                    f"Leave {test.name} out of the streams, give it more labels, "
                    "or write its classify in Python"
                )
                raise InputError(what, file=declared.file, line=line, column=column, remedy=remedy)
        return functions

    def _judge(
        self, name: str, declared: StreamFile, domain: Domain
    ) -> tuple[Classifier, tuple[int, ...]] | None:
        """Find the judge of a generator's proposals where no stream is, and its inputs."""
        relation = relation_of(declared, domain, name)
        if relation is None or name not in self.classifiers:
            return None
        inputs = relation.stream.inputs
        return self.classifiers[name], tuple(
            inputs.index(variable) for variable in relation.arguments
        )


def _below(stream: Stream) -> int | None:
    """Find which input of a stream is the movable body that its poses rest on; None for none."""
    borne = next((atom for atom in stream.certified if atom.predicate == BORNE), None)
    if borne is None or len(borne.terms) != 4 or borne.terms[2] not in stream.inputs:
        return None
    return stream.inputs.index(borne.terms[2])


def _same(item: Grounding) -> Grounding:
    return item
